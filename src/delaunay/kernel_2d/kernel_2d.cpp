#include "src/delaunay/kernel_2d/kernel_2d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "src/delaunay/kernel_2d/insertion.h"
#include "src/delaunay/kernel_2d/working_memory.h"
#include "src/delaunay/kernel_2d/working_points.h"
#include "src/error.h"

namespace spillway {
namespace kernel_2d {
namespace {

/// After a round there are so many times the points that there were before; the first round has at
/// most kFirstRound.
constexpr std::size_t kRoundFactor = 8;
constexpr std::size_t kFirstRound = 40;

/// Calls visit(i) for all i < count in rounds, each in ascending order and spread evenly over
/// the numbers.
template <typename Visit>
void for_each_in_rounds(std::size_t count, const Visit& visit) {
  std::size_t stride = 1;
  while (count / stride > kFirstRound) stride *= kRoundFactor;
  for (std::size_t i = 0; i < count; i += stride) visit(i);
  for (; stride > 1; stride /= kRoundFactor) {
    const std::size_t step = stride / kRoundFactor;
    for (std::size_t block = 0; block < count; block += stride) {
      const std::size_t end = std::min(count, block + stride);
      for (std::size_t i = block + step; i < end; i += step) visit(i);
    }
  }
}

template <bool kLattice>
void insert_all(Insertion<kLattice>& insertion, std::size_t count,
                std::span<const VertexId> basis) {
  // One behind the rounds, so that an insertion knows which point comes next.
  VertexId pending = kInfinite;
  for_each_in_rounds(count, [&](std::size_t i) {
    if (std::find(basis.begin(), basis.end(), i) != basis.end()) return;
    const auto next = static_cast<VertexId>(i + kFirstPoint);
    if (pending != kInfinite) insertion.insert(pending, next);
    pending = next;
  });
  if (pending != kInfinite) insertion.insert(pending, pending);
}

/// For each vertex, the point that stands for it: of equal ones that of the lowest input index.
std::vector<VertexId> choose_kept(const BaseCaseInput<2>& input,
                                  std::span<const Repetition> repetitions) {
  std::vector<VertexId> kept(input.points.size() + kFirstPoint);
  std::iota(kept.begin(), kept.end(), VertexId{0});
  const auto index = [&](VertexId v) { return input.input_index[v - kFirstPoint]; };
  for (const Repetition& r : repetitions) {
    VertexId& best = kept[r.vertex];
    if (index(r.point) < index(best)) best = r.point;
  }
  return kept;
}

std::vector<Duplicate> list_duplicates(std::span<const Repetition> repetitions,
                                       std::span<const VertexId> kept, VertexId first_vertex) {
  const VertexId shift = first_vertex - kFirstPoint;
  std::vector<Duplicate> duplicates;
  for (const Repetition& r : repetitions) {
    // The point that was inserted is dropped where it was not the one to keep, in its stead.
    const VertexId dropped = kept[r.vertex] == r.point ? r.vertex : r.point;
    duplicates.push_back({dropped + shift, kept[r.vertex] + shift});
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

/// Turns the kernel's triangles into simplices, numbered alike.
template <typename Number>
void list_simplices(const TriangleArray& triangles, std::uint32_t count, const Number& number,
                    BaseCase<2>& result) {
  result.simplices.reserve(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Handle h = TriangleArray::handle(t, 0);
    Simplex<2> simplex;
    bool infinite = false;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const VertexId v = triangles.vertex(h + i);
      infinite |= v == kInfinite;
      simplex.vertices[i] = v == kInfinite ? kInfiniteVertex : number(v);
      simplex.neighbours[i] = TriangleArray::triangle_of(triangles.mirror(h + i));
    }
    result.simplices.push_back(simplex);
    if (infinite) result.hull.push_back(t);
  }
}

template <bool kLattice>
BaseCase<2> triangulate(const BaseCaseInput<2>& input, std::span<const VertexId> basis,
                        const WorkingPoints& points, const TriangleArray& triangles) {
  Insertion<kLattice> insertion(
      points, triangles, {basis[0] + kFirstPoint, basis[1] + kFirstPoint, basis[2] + kFirstPoint});
  insert_all(insertion, input.points.size(), basis);
  BaseCase<2> result;
  result.dimension = 2;
  const VertexId shift = input.first_vertex - kFirstPoint;
  const std::uint32_t count = insertion.triangle_count();
  if (insertion.repetitions().empty()) {
    list_simplices(
        triangles, count, [shift](VertexId v) { return v + shift; }, result);
  } else {
    const std::vector<VertexId> kept = choose_kept(input, insertion.repetitions());
    list_simplices(
        triangles, count, [&](VertexId v) { return kept[v] + shift; }, result);
    result.duplicates = list_duplicates(insertion.repetitions(), kept, input.first_vertex);
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
      (*memory).triangles.reserve(triangle_count * TriangleArray::kTriangleBytes));
  return points.lattice ? triangulate<true>(input, basis, points, triangles)
                        : triangulate<false>(input, basis, points, triangles);
}

void release_kernel_2d_memory() { kernel_2d::BorrowedMemory::release_kept_memory(); }

}  // namespace spillway
