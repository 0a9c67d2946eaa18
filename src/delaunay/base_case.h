#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/delaunay/triangulation.h"
#include "src/geometry/box.h"

namespace spillway {

/// The points of one base case, neighbours near each other in the list (a Hilbert curve's order, as
/// divide() leaves them; any order is correct, but slower): point i is vertex first_vertex + i, and
/// of equal points the one of the lowest input index is kept.
template <int D>
struct BaseCaseInput {
  std::span<const Point<D>> points;
  std::span<const VertexId> input_index;
  VertexId first_vertex = 0;
  std::optional<Box<D>> region{};  ///< asks for BaseCase::inside; its sides may be infinite
  /// Others of this size follow: all working memory is kept for them, even where it is much, and
  /// what recycle() got is used.
  bool more_follow = false;
};

/// The triangulation of one base case: a single block, its neighbours all inside it.
template <int D>
struct BaseCase {
  std::vector<Simplex<D>> simplices;  ///< finite and infinite; none if dimension < D
  std::vector<std::uint32_t> hull;    ///< indices of the infinite simplices
  std::vector<Duplicate> duplicates;  ///< sorted
  int dimension = -1;                 ///< of the points' affine hull
  /// By simplex, if there was a region to ask about and the kernel can tell without much work: 1 if
  /// it is finite and its closed circumsphere certainly lies inside the region and touches no side.
  std::vector<std::uint8_t> inside;
};

/// What triangulates base cases.
enum class BaseCaseKernel : std::uint8_t {
  kOwn,   ///< kernel_2d and kernel_3d
  kCgal,  ///< CGAL's incremental triangulation: same result, several times the time
};

/// Chooses the kernel for the whole process; kOwn if never called. To be called before work starts.
void set_base_case_kernel(BaseCaseKernel kernel);

/// Triangulates any finite points sequentially: none, one, all equal, collinear, coplanar or in
/// general position.
template <int D>
BaseCase<D> triangulate_base_case(const BaseCaseInput<D>& input);

/// A kernel: triangulates points that span D dimensions. `basis` has the places of D+1 affinely
/// independent ones.
template <int D>
BaseCase<D> cgal_base_case(const BaseCaseInput<D>& input, std::span<const VertexId> basis);

/// Keeps the memory of a base case that has been used for those that follow.
template <int D>
void recycle(BaseCase<D>&& used);

/// For kernels: an empty list, with the memory of one that was recycled if there is any.
template <int D>
std::vector<Simplex<D>> recycled_simplices();

/// Gives the system the memory that base cases keep for those that follow.
void release_base_case_memory();

}  // namespace spillway
