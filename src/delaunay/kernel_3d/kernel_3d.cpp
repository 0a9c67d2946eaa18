#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "src/delaunay/insertion_rounds.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/working_points.h"
#include "src/delaunay/lanes.h"
#include "src/delaunay/vectors.h"
#include "src/delaunay/working_memory.h"
#include "src/error.h"

namespace spillway {
namespace kernel_3d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 16, .first = 40};
constexpr std::size_t kMostPoints = (std::size_t{1} << 28) - 2;
/// Room for so many cells a point is made at first; scattered points have 6.8.
constexpr std::size_t kUsualCells = 7;
/// Of larger arrays of cells as much is given back while they become simplices as keeps both
/// together, and the points, within so many bytes a point; some are for huge pages that are used in
/// part. More would cost the next base case more time. Where many follow nothing is given back: to
/// clear new pages for them takes a tenth of their time.
constexpr std::size_t kLargeArray = std::size_t{1} << 23;
constexpr std::size_t kMostBytes = 490;
constexpr std::size_t kBytesOfPages = std::size_t{3} << 20;
constexpr std::size_t kBytesOfPoint = 34;

/// Whether a finite cell's true circumsphere is certainly inside the box and touches no side: see
/// docs/algorithm.md ("Spheres inside a box").
bool certainly_inside(const Cell& cell, const Box<3>& box) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    gap = std::min({gap, cell.centre[k] - box.lo[k], box.hi[k] - cell.centre[k]});
  }
  return gap > 0 && gap * gap > cell.squared_radius + 2 * tolerance_of(cell.squared_radius);
}

/// Turns the kernel's cells into simplices, numbered alike; number() turns four vertices into final
/// ones. Fills BaseCase::inside if it has been given room.
template <typename Number>
void list_simplices(const CellArray& cells, std::uint32_t count, const Number& number,
                    const BaseCaseInput<3>& input, const Box<3>& region, Block& memory,
                    BaseCase<3>& result) {
  constexpr std::uint32_t kGrain = 1 << 15;  // cells of a huge page
  const std::size_t bytes = count * sizeof(Cell);
  const std::size_t needed =
      bytes + count * sizeof(Simplex<3>) + kBytesOfPoint * input.points.size();
  const std::size_t allowed = std::max(kMostBytes * input.points.size(), kBytesOfPages);
  const std::size_t most =
      bytes < kLargeArray || input.more_follow ? needed : allowed - kBytesOfPages;
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
      const bool finite = mask_of(infinite) == 0;
      if (!finite) result.hull.push_back(c);
      if (c < result.inside.size()) {
        result.inside[c] = static_cast<std::uint8_t>(finite && certainly_inside(cell, region));
      }
    }
    const std::size_t forgotten = begin * sizeof(Cell);
    if (needed > most + forgotten) memory.forget(forgotten, end * sizeof(Cell));
  }
}

template <bool kRanked>
BaseCase<3> triangulate(const BaseCaseInput<3>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Block& memory) {
  Insertion<kRanked> insertion(points, memory,
                               {basis[0] + kFirstPoint, basis[1] + kFirstPoint,
                                basis[2] + kFirstPoint, basis[3] + kFirstPoint},
                               vector_width());
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  insertion.close_gaps();
  BaseCase<3> result;
  result.dimension = 3;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.cell_count();
  if (input.region) result.inside.resize(count);
  if (input.more_follow) result.simplices = recycled_simplices<3>();
  if (insertion.repetitions().empty()) {
    list_simplices(
        insertion.cells(), count, [shift](Words& v) { v = v / 4 + shift; }, input, points.region,
        memory, result);
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<3>(input, insertion.repetitions());
    list_simplices(
        insertion.cells(), count,
        [&](Words& v) {
          for (int i = 0; i < 4; ++i) v[i] = kept[v[i] / 4] + shift;
        },
        input, points.region, memory, result);
    result.duplicates = kernel::list_duplicates(insertion.repetitions(), kept, input.first_vertex);
  }
  return result;
}

}  // namespace
}  // namespace kernel_3d

BaseCase<3> kernel_3d_base_case(const BaseCaseInput<3>& input, std::span<const VertexId> basis) {
  using namespace kernel_3d;
  if (input.points.size() > kMostPoints) {
    throw Error(fmt::format(
        "a base case of {} points is more than can be numbered; choose base cases of at most {} "
        "points",
        input.points.size(), kMostPoints));
  }
  BorrowedMemory memory;
  const WorkingPoints points = make_working_points(input.points, (*memory).points, input.region);
  Block& cells = (*memory).simplices;
  cells.reserve(kUsualCells * input.points.size() * sizeof(Cell));
  return points.ranked ? triangulate<true>(input, basis, points, cells)
                       : triangulate<false>(input, basis, points, cells);
}

}  // namespace spillway
