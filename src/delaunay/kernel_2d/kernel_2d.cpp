#include "src/delaunay/kernel_2d/kernel_2d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_2d/insertion.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/delaunay/working_memory.h"
#include "src/error.h"

namespace spillway {
namespace kernel_2d {
namespace {

constexpr kernel::Rounds kRounds{.factor = 8, .first = 40};

/// Turns the kernel's triangles into simplices, numbered alike.
template <typename Number>
void list_simplices(const TriangleArray& triangles, std::uint32_t count, const Number& number,
                    BaseCase<2>& result) {
  result.simplices.reserve(count);
  ask_for_huge_pages(result.simplices.data(), count * sizeof(Simplex<2>));
  // Some at a time, so that the inner loop need not ask whether the vector must grow.
  std::array<Simplex<2>, 64> some;
  for (std::uint32_t begin = 0; begin < count; begin += some.size()) {
    const auto size = std::min<std::uint32_t>(some.size(), count - begin);
    for (std::uint32_t i = 0; i < size; ++i) {
      const Handle h = TriangleArray::handle(begin + i, 0);
      bool infinite = false;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const VertexId v = triangles.vertex(h + k);
        infinite |= v == kInfinite;
        some[i].vertices[k] = v == kInfinite ? kInfiniteVertex : number(v);
        some[i].neighbours[k] = TriangleArray::triangle_of(triangles.mirror(h + k));
      }
      if (infinite) result.hull.push_back(begin + i);
    }
    result.simplices.insert(result.simplices.end(), some.begin(), some.begin() + size);
  }
}

template <bool kLattice>
BaseCase<2> triangulate(const BaseCaseInput<2>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, const TriangleArray& triangles) {
  Insertion<kLattice> insertion(
      points, triangles, {basis[0] + kFirstPoint, basis[1] + kFirstPoint, basis[2] + kFirstPoint});
  kernel::insert_in_rounds(insertion, input.points.size(), basis, kRounds);
  BaseCase<2> result;
  result.dimension = 2;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.triangle_count();
  if (insertion.repetitions().empty()) {
    list_simplices(
        triangles, count, [shift](VertexId v) { return v + shift; }, result);
  } else {
    const std::vector<VertexId> kept = kernel::choose_kept<2>(input, insertion.repetitions());
    list_simplices(
        triangles, count, [&](VertexId v) { return kept[v] + shift; }, result);
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
  BorrowedMemory memory;
  const WorkingPoints points = make_working_points(input.points, (*memory).points);
  const TriangleArray triangles(
      (*memory).simplices.reserve(triangle_count * TriangleArray::kTriangleBytes));
  return points.lattice ? triangulate<true>(input, basis, points, triangles)
                        : triangulate<false>(input, basis, points, triangles);
}

}  // namespace spillway
