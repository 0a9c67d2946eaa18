#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/working_points.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/lane_width.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/delaunay/kernel_common/simplex_listing.h"
#include "src/error.h"

namespace spillway::detail {
namespace kernel_3d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 16, .first = 40};
constexpr std::size_t kMostPoints = (std::size_t{1} << 28) - 2;
/// Cells a point that there is room for at first; scattered points have 6.8.
constexpr std::size_t kUsualCells = 7;

using Pair = Reals<2>;

/// A bit for each of two spheres: whether the true circumsphere of a finite cell is certainly
/// inside the box and touches no side. See docs/algorithm-kernel-3d.md ("Spheres inside a box").
std::uint32_t certainly_inside(const Records<2>& spheres, const Box<3>& box) {
  const auto lesser = [](const Pair& a, const Pair& b) { return a < b ? a : b; };
  const auto gap_along = [&](const Pair& centre, int k) {
    return lesser(centre - box.lo[k], box.hi[k] - centre);
  };
  const Pair gap =
      lesser(lesser(gap_along(spheres.x, 0), gap_along(spheres.y, 1)), gap_along(spheres.z, 2));
  const Pair tolerance = (Pair)((Integers<2>)spheres.w << kMantissaBits);
  return mask_of((Pair)((gap > 0) & (gap * gap > spheres.w + 2 * tolerance)));
}

static_assert(sizeof(Cell) >= 2 * sizeof(Simplex<3>), "simplices are listed over cells");

/// Turns a range of the kernel's cells into simplices; number() turns four vertices into final
/// ones. The simplices may lie where the cells are: see kernel::list_simplices.
template <typename Number>
void list_range(const CellArray& cells, std::uint32_t begin, std::uint32_t end,
                const Number& number, const std::optional<Box<3>>& clear_box, Simplex<3>* simplices,
                ListingNotes& notes) {
  const auto list = [&](std::uint32_t c, std::uint32_t inside) {
    const Cell& cell = cells.at_cell(CellArray::cell(c));
    Words vertices, neighbours;
    load(cell.vertices, vertices);
    load(cell.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    store(vertices | infinite, simplices[c].vertices.data());
    store(neighbours >> CellArray::kNumberShift, simplices[c].neighbours.data());
    const bool finite = mask_of(infinite) == 0;
    if (!finite) notes.hull.push_back(c);
    if (clear_box && !(finite && inside != 0)) notes.not_inside.push_back(c);
  };
  for (std::uint32_t c = begin; c < end; c += 2) {
    const std::uint32_t last = std::min(c + 1, end - 1);
    std::uint32_t inside = 0;
    if (clear_box) {
      inside = certainly_inside(gather<2>([&](std::uint32_t i) -> const double* {
                                  return cells.at_cell(CellArray::cell(i == 0 ? c : last)).centre;
                                }),
                                *clear_box);
    }
    list(c, inside & 1);
    if (last != c) list(last, inside >> 1);
  }
}

template <bool kHasOrderKeys>
BaseCase<3> triangulate(const BaseCaseInput<3>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Slab& memory) {
  Insertion<kHasOrderKeys> insertion(points, memory,
                                     {basis[0] + kFirstPoint, basis[1] + kFirstPoint,
                                      basis[2] + kFirstPoint, basis[3] + kFirstPoint},
                                     lane_width());
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  insertion.close_gaps();
  BaseCase<3> result;
  result.dimension = 3;
  const VertexId shift = input.first_vertex - kFirstPoint;
  result.simplices = make_list<3>(input, memory, insertion.cell_count());
  const auto list = [&](const auto& number) {
    list_simplices<3>(result, points.clear_box.has_value(),
                      [&](std::uint32_t begin, std::uint32_t end, ListingNotes& notes) {
                        list_range(insertion.cells(), begin, end, number, points.clear_box,
                                   result.simplices.data(), notes);
                      });
  };
  if (insertion.repetitions().empty()) {
    list([shift](Words& v) { v = v / 4 + shift; });
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<3>(input, insertion.repetitions());
    list([&](Words& v) {
      for (int i = 0; i < 4; ++i) v[i] = kept[v[i] / 4] + shift;
    });
    result.duplicates = kernel::list_duplicates(insertion.repetitions(), kept, input.first_vertex);
  }
  return result;
}

}  // namespace
}  // namespace kernel_3d

BaseCase<3> kernel_3d_base_case(const BaseCaseInput<3>& input, std::span<const VertexId> basis) {
  using namespace kernel_3d;
  if (input.points.size() > kMostPoints) {
    throw Error(fmt::format("a base case of {} points is more than can be numbered; choose base "
                            "cases of at most {} "
                            "points",
                            input.points.size(), kMostPoints),
                ErrorCode::kTooLarge);
  }
  BorrowedSlab point_memory(SlabUse::kPoints, input.points.size_bytes());
  const WorkingPoints points = make_working_points(input.points, *point_memory, input.clear_box);
  const std::size_t cell_bytes = kUsualCells * input.points.size() * sizeof(Cell);
  BorrowedSlab cells(SlabUse::kSimplices, cell_bytes);
  cells->reserve(cell_bytes);
  return points.has_order_keys ? triangulate<true>(input, basis, points, *cells)
                               : triangulate<false>(input, basis, points, *cells);
}

}  // namespace spillway::detail
