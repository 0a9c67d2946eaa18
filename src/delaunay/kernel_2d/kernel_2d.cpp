#include "src/delaunay/kernel_2d/kernel_2d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_2d/insertion.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/delaunay/kernel_common/lane_width.h"
#include "src/delaunay/kernel_common/simplex_listing.h"
#include "src/error.h"

namespace spillway::detail {
namespace kernel_2d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 24, .first = 40};

/// Whether a finite triangle's true circumcircle is certainly inside the box and touches no side:
/// see docs/algorithm-kernel-2d.md ("Circles inside a box").
bool certainly_inside(const Triangle& triangle, const Box<2>& box) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 2; ++k) {
    gap = std::min({gap, triangle.centre[k] - box.lo[k], box.hi[k] - triangle.centre[k]});
  }
  return gap > 0 && gap * gap > triangle.outer + (triangle.outer - triangle.inner);
}

static_assert(sizeof(Triangle) >= 2 * sizeof(Simplex<2>), "simplices are listed over triangles");

/// Turns a range of the kernel's triangles into simplices, or into their corners; number() turns
/// vertices into final ones. What is made may lie where the triangles are: see
/// kernel::list_simplices.
template <typename Number, typename Made>
void list_range(const TriangleArray& triangles, std::uint32_t begin, std::uint32_t end,
                const Number& number, const std::optional<Box<2>>& clear_box, Made* made,
                ListingNotes<2>& notes) {
  constexpr bool kCornersOnly = !std::is_same_v<Made, Simplex<2>>;
  for (std::uint32_t i = begin; i < end; ++i) {
    Triangle triangle;
    std::memcpy(&triangle, &triangles.at_first(TriangleArray::handle(i, 0)), sizeof triangle);
    Words vertices, neighbours;
    load(triangle.vertices, vertices);
    load(triangle.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    vertices |= infinite;
    neighbours >>= TriangleArray::kNumberShift;
    const Simplex<2> simplex{{vertices[0], vertices[1], vertices[2]},
                             {neighbours[0], neighbours[1], neighbours[2]}};
    if constexpr (kCornersOnly) {
      made[i] = simplex.vertices;
    } else {
      made[i] = simplex;
    }
    const bool finite = mask_of(infinite) == 0;
    if (!finite) notes.hull.push_back(i);
    if (!clear_box || (finite && certainly_inside(triangle, *clear_box))) continue;
    notes.not_inside.push_back(i);
    if constexpr (kCornersOnly) {
      if (notes.lists_open) notes.open_simplices.push_back(simplex);
    }
  }
}

template <bool kLattice>
BaseCase<2> triangulate(const BaseCaseInput<2>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Slab& memory) {
  const TriangleArray triangles(memory.data());
  Insertion<kLattice> insertion(
      points, triangles, {basis[0] + kFirstPoint, basis[1] + kFirstPoint, basis[2] + kFirstPoint},
      lane_width());
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  BaseCase<2> result;
  result.dimension = 2;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.triangle_count();
  const auto list_as = [&](const auto& number, auto* made) {
    list_simplices<2>(result, count, points.clear_box.has_value(),
                      [&](std::uint32_t begin, std::uint32_t end, ListingNotes<2>& notes) {
                        list_range(triangles, begin, end, number, points.clear_box, made, notes);
                      });
  };
  const auto list = [&](const auto& number) {
    if (input.corners_only) {
      result.corners = make_corners<2>(memory, count);
      list_as(number, result.corners.data());
    } else {
      result.simplices = make_list<2>(input, memory, count);
      list_as(number, result.simplices.data());
    }
  };
  if (insertion.repetitions().empty()) {
    list([shift](Words& v) { v += shift; });
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<2>(input, insertion.repetitions());
    list([&](Words& v) {
      for (int i = 0; i < 4; ++i) v[i] = kept[v[i]] + shift;
    });
    result.duplicates = kernel::list_duplicates(insertion.repetitions(), kept, input.first_vertex);
  }
  return result;
}

}  // namespace
}  // namespace kernel_2d

BaseCase<2> kernel_2d_base_case(const BaseCaseInput<2>& input, std::span<const VertexId> basis) {
  using namespace kernel_2d;
  const std::size_t triangle_count = 2 * input.points.size() + 2;
  if (triangle_count > TriangleArray::kMaxTriangles) {
    throw Error(fmt::format("a base case of {} points has more triangles than can be numbered; "
                            "choose base cases of at most {} points",
                            input.points.size(), TriangleArray::kMaxTriangles / 2 - 1),
                ErrorCode::kTooLarge);
  }
  BorrowedSlab point_memory(SlabUse::kPoints, input.points.size_bytes());
  const WorkingPoints points = make_working_points(input.points, *point_memory, input.clear_box);
  const std::size_t triangle_bytes = triangle_count * sizeof(Triangle);
  BorrowedSlab triangles(SlabUse::kSimplices, triangle_bytes);
  triangles->reserve(triangle_bytes);
  return points.lattice ? triangulate<true>(input, basis, points, *triangles)
                        : triangulate<false>(input, basis, points, *triangles);
}

}  // namespace spillway::detail
