#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
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
/// ones. The simplices may lie where the cells are: those are larger, so the list never comes to
/// lie over one that is still to be read. Fills BaseCase::inside if it has been given room.
template <typename Number>
void list_simplices(const CellArray& cells, const Number& number, const Box<3>& region,
                    BaseCase<3>& result) {
  const auto count = static_cast<std::uint32_t>(result.simplices.size());
  for (std::uint32_t c = 0; c < count; ++c) {
    Cell cell;
    std::memcpy(&cell, &cells.at_cell(CellArray::cell(c)), sizeof cell);
    Words vertices, neighbours;
    load(cell.vertices, vertices);
    load(cell.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    Simplex<3>& simplex = result.simplices[c];
    store(vertices | infinite, simplex.vertices.data());
    store(neighbours >> CellArray::kNumberShift, simplex.neighbours.data());
    const bool finite = mask_of(infinite) == 0;
    if (!finite) result.hull.push_back(c);
    if (c < result.inside.size()) {
      result.inside[c] = static_cast<std::uint8_t>(finite && certainly_inside(cell, region));
    }
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
  result.simplices = make_list<3>(input, memory, insertion.cell_count());
  if (input.region) result.inside.resize(insertion.cell_count());
  if (insertion.repetitions().empty()) {
    list_simplices(
        insertion.cells(), [shift](Words& v) { v = v / 4 + shift; }, points.region, result);
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<3>(input, insertion.repetitions());
    list_simplices(
        insertion.cells(),
        [&](Words& v) {
          for (int i = 0; i < 4; ++i) v[i] = kept[v[i] / 4] + shift;
        },
        points.region, result);
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
  BorrowedBlock point_memory(BlockUse::kPoints, input.points.size_bytes());
  const WorkingPoints points = make_working_points(input.points, *point_memory, input.region);
  const std::size_t cell_bytes = kUsualCells * input.points.size() * sizeof(Cell);
  BorrowedBlock cells(BlockUse::kSimplices, cell_bytes);
  cells->reserve(cell_bytes);
  return points.ranked ? triangulate<true>(input, basis, points, *cells)
                       : triangulate<false>(input, basis, points, *cells);
}

}  // namespace spillway
