#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "src/delaunay/insertion_rounds.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/lanes.h"
#include "src/delaunay/kernel_3d/working_points.h"
#include "src/delaunay/working_memory.h"
#include "src/error.h"

namespace spillway {
namespace kernel_3d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 16, .first = 40};
constexpr std::size_t kMostPoints = (std::size_t{1} << 28) - 2;
/// Room for so many cells a point is made at first; scattered points have 6.8.
constexpr std::size_t kUsualCells = 7;
/// Of larger arrays of cells this part is given back while they become simplices, so that both
/// together take less than 500 bytes a point. More would cost the next base case more time.
constexpr std::size_t kLargeArray = std::size_t{1} << 25;
constexpr double kPartGivenBack = 0.5;

std::atomic<int> most_lanes = 4;

/// Turns the kernel's cells into simplices, numbered alike; number() turns four vertices into final
/// ones.
template <typename Number>
void list_simplices(const CellArray& cells, std::uint32_t count, const Number& number,
                    Block& memory, BaseCase<3>& result) {
  constexpr std::uint32_t kGrain = 1 << 15;  // cells of a huge page
  const std::size_t bytes = count * sizeof(Cell);
  const std::size_t given_back =
      bytes < kLargeArray ? 0
                          : static_cast<std::size_t>(static_cast<double>(bytes) * kPartGivenBack);
  result.simplices.reserve(count);
  ask_for_huge_pages(result.simplices.data(), count * sizeof(Simplex<3>));
  for (std::uint32_t begin = 0; begin < count; begin += kGrain) {
    const std::uint32_t end = std::min(count, begin + kGrain);
    for (std::uint32_t c = begin; c < end; ++c) {
      const Cell& cell = cells.at_first(CellArray::handle(c, 0));
      Words vertices, neighbours;
      load(cell.vertices, vertices);
      load(cell.neighbours, neighbours);
      const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
      number(vertices);
      Simplex<3>& simplex = result.simplices.emplace_back();
      store(vertices | infinite, simplex.vertices.data());
      store(neighbours >> CellArray::kNumberShift, simplex.neighbours.data());
      if (mask_of(infinite) != 0) result.hull.push_back(c);
    }
    if (end * sizeof(Cell) <= given_back) memory.forget(begin * sizeof(Cell), end * sizeof(Cell));
  }
}

template <bool kRanked>
BaseCase<3> triangulate(const BaseCaseInput<3>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Block& memory) {
  Insertion<kRanked> insertion(points, memory,
                               {basis[0] + kFirstPoint, basis[1] + kFirstPoint,
                                basis[2] + kFirstPoint, basis[3] + kFirstPoint},
                               std::min(most_lanes.load(), widest_vectors()));
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  insertion.close_gaps();
  BaseCase<3> result;
  result.dimension = 3;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.cell_count();
  if (insertion.repetitions().empty()) {
    list_simplices(
        insertion.cells(), count, [shift](Words& v) { v = v / 4 + shift; }, memory, result);
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<3>(input, insertion.repetitions());
    list_simplices(
        insertion.cells(), count,
        [&](Words& v) {
          for (int i = 0; i < 4; ++i) v[i] = kept[v[i] / 4] + shift;
        },
        memory, result);
    result.duplicates = kernel::list_duplicates(insertion.repetitions(), kept, input.first_vertex);
  }
  return result;
}

}  // namespace
}  // namespace kernel_3d

int widest_vectors() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2")) {
    return 4;
  }
#endif
  return 2;
}

void limit_vectors(int doubles) { kernel_3d::most_lanes = doubles; }

BaseCase<3> kernel_3d_base_case(const BaseCaseInput<3>& input, std::span<const VertexId> basis) {
  using namespace kernel_3d;
  if (input.points.size() > kMostPoints) {
    throw Error(fmt::format(
        "a base case of {} points is more than can be numbered; choose base cases of at most {} "
        "points",
        input.points.size(), kMostPoints));
  }
  BorrowedMemory memory;
  const WorkingPoints points = make_working_points(input.points, (*memory).points);
  Block& cells = (*memory).simplices;
  cells.reserve(kUsualCells * input.points.size() * sizeof(Cell));
  return points.ranked ? triangulate<true>(input, basis, points, cells)
                       : triangulate<false>(input, basis, points, cells);
}

}  // namespace spillway
