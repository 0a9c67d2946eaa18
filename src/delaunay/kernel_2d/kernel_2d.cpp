#include "src/delaunay/kernel_2d/kernel_2d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "src/delaunay/kernel_2d/insertion.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/delaunay/vectors.h"
#include "src/delaunay/working_memory.h"
#include "src/error.h"

namespace spillway {
namespace kernel_2d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 24, .first = 40};

/// Whether a finite triangle's true circumcircle is certainly inside the box and touches no side:
/// see docs/algorithm.md ("Circles inside a box").
bool certainly_inside(const Triangle& triangle, const Box<2>& box) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 2; ++k) {
    gap = std::min({gap, triangle.centre[k] - box.lo[k], box.hi[k] - triangle.centre[k]});
  }
  return gap > 0 && gap * gap > triangle.outer + (triangle.outer - triangle.inner);
}

/// Turns the kernel's triangles into simplices, numbered alike; number() turns vertices into final
/// ones. The simplices may lie where the triangles are: those are larger, so the list never comes
/// to lie over one that is still to be read. Fills BaseCase::inside if it has been given room.
template <typename Number>
void list_simplices(const TriangleArray& triangles, const Number& number, const Box<2>& region,
                    BaseCase<2>& result) {
  const auto count = static_cast<std::uint32_t>(result.simplices.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    Triangle triangle;
    std::memcpy(&triangle, &triangles.at_first(TriangleArray::handle(i, 0)), sizeof triangle);
    Words vertices, neighbours;
    load(triangle.vertices, vertices);
    load(triangle.neighbours, neighbours);
    const Words infinite = (Words)(vertices == kInfinite);  // all bits, and so kInfiniteVertex
    number(vertices);
    vertices |= infinite;
    neighbours >>= TriangleArray::kNumberShift;
    result.simplices[i] = {{vertices[0], vertices[1], vertices[2]},
                           {neighbours[0], neighbours[1], neighbours[2]}};
    const bool finite = mask_of(infinite) == 0;
    if (!finite) result.hull.push_back(i);
    if (i < result.inside.size()) {
      result.inside[i] = static_cast<std::uint8_t>(finite && certainly_inside(triangle, region));
    }
  }
}

template <bool kLattice>
BaseCase<2> triangulate(const BaseCaseInput<2>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, Block& memory) {
  const TriangleArray triangles(memory.data());
  Insertion<kLattice> insertion(
      points, triangles, {basis[0] + kFirstPoint, basis[1] + kFirstPoint, basis[2] + kFirstPoint},
      vector_width());
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  BaseCase<2> result;
  result.dimension = 2;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.triangle_count();
  result.simplices = make_list<2>(input, memory, count);
  if (input.region) result.inside.resize(count);
  if (insertion.repetitions().empty()) {
    list_simplices(
        triangles, [shift](Words& v) { v += shift; }, points.region, result);
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<2>(input, insertion.repetitions());
    list_simplices(
        triangles,
        [&](Words& v) {
          for (int i = 0; i < 4; ++i) v[i] = kept[v[i]] + shift;
        },
        points.region, result);
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
    throw Error(
        fmt::format("a base case of {} points has more triangles than can be numbered; "
                    "choose base cases of at most {} points",
                    input.points.size(), TriangleArray::kMaxTriangles / 2 - 1));
  }
  BorrowedBlock point_memory(BlockUse::kPoints, input.points.size_bytes());
  const WorkingPoints points = make_working_points(input.points, *point_memory, input.region);
  const std::size_t triangle_bytes = triangle_count * sizeof(Triangle);
  BorrowedBlock triangles(BlockUse::kSimplices, triangle_bytes);
  triangles->reserve(triangle_bytes);
  return points.lattice ? triangulate<true>(input, basis, points, *triangles)
                        : triangulate<false>(input, basis, points, *triangles);
}

}  // namespace spillway
