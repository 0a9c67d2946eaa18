#include "src/delaunay/kernel_3d/kernel_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_3d/cell_memory.h"
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

/// The sides of a box in all lanes.
struct WideBox {
  std::array<Pair, 3> lo{};
  std::array<Pair, 3> hi{};

  explicit WideBox(const Box<3>& box) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = Pair{box.lo[k], box.lo[k]};
      hi[k] = Pair{box.hi[k], box.hi[k]};
    }
  }
};

/// A bit for each of two spheres: whether the true circumsphere of a finite cell is certainly
/// inside the box and touches no side. See docs/algorithm-kernel-3d.md ("Spheres inside a box").
std::uint32_t certainly_inside(const Records<2>& spheres, const WideBox& box) {
  const auto lesser = [](const Pair& a, const Pair& b) { return a < b ? a : b; };
  const auto gap_along = [&](const Pair& centre, int k) {
    return lesser(centre - box.lo[k], box.hi[k] - centre);
  };
  const Pair gap =
      lesser(lesser(gap_along(spheres.x, 0), gap_along(spheres.y, 1)), gap_along(spheres.z, 2));
  const Pair tolerance = (Pair)((Integers<2>)spheres.w << kMantissaBits);
  // Two masks: the compiler would join the comparisons lane by lane.
  return mask_of((Pair)(gap > 0)) & mask_of((Pair)(gap * gap > spheres.w + 2 * tolerance));
}

void store_simplex(const Words& vertices, const Words& neighbours, Simplex<3>& simplex) {
  store(vertices, simplex.vertices.data());
  store(neighbours, simplex.neighbours.data());
}

/// Cells are fetched this many ahead.
constexpr std::uint32_t kAhead = 16;

static_assert(sizeof(Cell) >= 2 * sizeof(Simplex<3>), "simplices are listed over cells");

/// Turns a range of the kernel's cells into simplices, or into their corners; number() turns four
/// vertices into final ones. What is made may lie where the cells are: see kernel::list_simplices.
template <typename Number, typename Made>
void list_range(const CellArray& cells, std::uint32_t begin, std::uint32_t end,
                const Number& number, const std::optional<Box<3>>& clear_box, Made* made,
                ListingNotes<3>& notes) {
  constexpr bool kCornersOnly = !std::is_same_v<Made, Simplex<3>>;
  const bool asked = clear_box.has_value();
  const WideBox box(clear_box.value_or(Box<3>{}));
  const auto list = [&](std::uint32_t c, std::uint32_t inside) {
    const Cell& cell = cells.at_cell(CellArray::cell(c));
    Words vertices, neighbours;
    load(cell.vertices, vertices);
    load(cell.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    vertices |= infinite;
    neighbours >>= CellArray::kNumberShift;
    if constexpr (kCornersOnly) {
      store(vertices, made[c].data());
    } else {
      store_simplex(vertices, neighbours, made[c]);
    }
    const bool finite = mask_of(infinite) == 0;
    if (!finite) notes.hull.push_back(c);
    if (!asked || (finite && inside != 0)) return;
    notes.not_inside.push_back(c);
    if (kCornersOnly && notes.lists_open) {
      store_simplex(vertices, neighbours, notes.open_simplices.emplace_back());
    }
  };
  for (std::uint32_t c = begin; c < end; c += 2) {
    const std::uint32_t last = std::min(c + 1, end - 1);
    for (const std::uint32_t ahead : {c, last}) {
      __builtin_prefetch(&cells.at_cell(CellArray::cell(ahead + kAhead)));
    }
    std::uint32_t inside = 0;
    if (asked) {
      inside = certainly_inside(gather<2>([&](std::uint32_t i) -> const double* {
                                  return cells.at_cell(CellArray::cell(i == 0 ? c : last)).centre;
                                }),
                                box);
    }
    list(c, inside & 1);
    if (last != c) list(last, inside >> 1);
  }
}

template <bool kHasOrderKeys>
BaseCase<3> triangulate(const BaseCaseInput<3>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Slab& memory) {
  const std::size_t usual = kUsualCells * input.points.size();
  Insertion<kHasOrderKeys> insertion(points, CellMemory(memory, usual + usual / 8, input.memory),
                                     {basis[0] + kFirstPoint, basis[1] + kFirstPoint,
                                      basis[2] + kFirstPoint, basis[3] + kFirstPoint},
                                     lane_width());
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  insertion.close_gaps();
  BaseCase<3> result;
  result.dimension = 3;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::size_t count = insertion.cell_count();
  if (input.memory != nullptr && !input.in_place && count > usual) {
    // The list, and what a merge makes of it.
    const std::uint64_t bytes = 2 * (count - usual) * sizeof(Simplex<3>);
    input.memory->grow(bytes, insertion.forecast());
  }
  const auto list_as = [&](const auto& number, auto* made) {
    list_simplices<3>(result, count, points.clear_box.has_value(),
                      [&](std::uint32_t begin, std::uint32_t end, ListingNotes<3>& notes) {
                        list_range(insertion.cells(), begin, end, number, points.clear_box, made,
                                   notes);
                      });
  };
  const auto list = [&](const auto& number) {
    if (input.corners_only) {
      result.corners = make_corners<3>(memory, count);
      list_as(number, result.corners.data());
      if (count > usual) result.corners.release_rest();  // for what is made of them
    } else {
      result.simplices = make_list<3>(input, memory, count);
      list_as(number, result.simplices.data());
    }
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
