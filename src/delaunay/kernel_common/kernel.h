#pragma once
// What a kernel is given, and what it makes of it.

#include <spillway/choices.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/delaunay/common/working_memory.h"
#include "src/geometry/box.h"

namespace spillway::runtime {
class WorkLease;
}

namespace spillway::delaunay {

/// The points of one base case, neighbours near each other in the list (a Hilbert curve's order, as
/// divide() leaves them; any order is correct, but slower): point i is vertex first_vertex + i, and
/// of equal points the one of the lowest input index is kept.
template <int D>
struct BaseCaseInput {
  std::span<const Point<D>> points;
  std::span<const VertexId> input_index;
  VertexId first_vertex = 0;
  std::optional<Box<D>> safe_box{};  ///< asks for BaseCase::not_inside; its sides may be infinite
  /// Leaves the simplices in the kernel's working memory, of which they use at most half:
  /// nothing is copied, and at the peak less memory is used. For results that are soon recycled,
  /// or few.
  bool in_place = false;
  /// Asks for BaseCase::corners instead of its simplices, in place where the kernel can, and for
  /// open_simplices if there is a safe box: half as much to write and to read.
  bool corners_only = false;
  Kernel kernel = Kernel::kSpillway;
  /// If set, grows by what the kernel's own records and the list of simplices take beyond what is
  /// usual for so many points; grow() may throw.
  WorkLease* memory = nullptr;
};

/// Where more than one simplex of so many is open they are not listed: that would take more memory
/// than it saves time.
inline constexpr std::size_t kFewestForOneOpen = 8;

/// The triangulation of one base case: a single simplex list, its neighbours all inside it.
template <int D>
struct BaseCase {
  SlabArray<Simplex<D>> simplices;  ///< finite and infinite; none if dimension < D
  /// Instead of these, if they were all that was asked for: the vertices of each.
  SlabArray<std::array<VertexId, D + 1>> corners;
  std::vector<std::uint32_t> hull;           ///< indices of the infinite simplices
  std::vector<DroppedDuplicate> duplicates;  ///< sorted
  int dimension = -1;                        ///< of the points' affine hull
  /// If there are simplices and there was a safe box to ask about: the indices, ascending, of all
  /// simplices but those that are finite and whose closed circumsphere certainly lies inside the
  /// box and touches no side.
  std::optional<std::vector<std::uint32_t>> not_inside;
  /// These, if there are `corners` and they are few: see kFewestForOneOpen.
  std::vector<Simplex<D>> open_simplices;
};

/// For kernels: a list of simplices to be filled, at the beginning of a slab that the kernel is
/// done with if they are to be made in place, or else in memory of its own.
template <int D>
SlabArray<Simplex<D>> make_list(const BaseCaseInput<D>& input, Slab& memory, std::size_t count) {
  const std::size_t bytes = count * sizeof(Simplex<D>);
  if (!input.in_place) return {kept_or_new_slab(SlabUse::kSimplices, bytes), count};
  memory.reserve(bytes);
  return {std::move(memory), count};
}

/// For kernels: the same of BaseCase::corners, in place.
template <int D>
SlabArray<std::array<VertexId, D + 1>> make_corners(Slab& memory, std::size_t count) {
  memory.reserve(count * sizeof(std::array<VertexId, D + 1>));
  return {std::move(memory), count};
}

/// Keeps the memory of a base case, which has been used, for those to come.
template <int D>
void recycle(BaseCase<D> used) {
  keep_slab(SlabUse::kSimplices, used.simplices.take_slab());
  keep_slab(SlabUse::kSimplices, used.corners.take_slab());
}

/// Keeps the memory of a list of simplices, which has been used, for base cases to come.
template <int D>
void recycle(SlabArray<Simplex<D>> used) {
  keep_slab(SlabUse::kSimplices, used.take_slab());
}

}  // namespace spillway::delaunay
