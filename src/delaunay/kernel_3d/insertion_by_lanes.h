#pragma once
// The inner loop of insertion, for any number of lanes. All of it is inlined into the function
// that uses it, and takes that function's instruction set.

#include <cstddef>
#include <cstdint>
#include <utility>

#include "src/delaunay/kernel_3d/hole_by_lanes.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/star_spheres.h"

namespace spillway::delaunay::kernel_3d {

inline constexpr Handle kNone = ~Handle{0};

/// Chooses cells for the star: those of the hole, then free ones, then new ones.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kHasOrderKeys>::take_cells(const HoleLists& hole) {
  std::swap(conflicts_, star_);
  Handle* const star = star_.data();
  std::size_t count = hole.cell_count;
  if (count > hole.facet_count || free_count_ > 0) [[unlikely]] {
    if (free_count_ + count > free_.size()) free_.resize(2 * (free_count_ + count));
    while (count > hole.facet_count) free_[free_count_++] = star[--count];
    while (count < hole.facet_count && free_count_ > 0) star[count++] = free_[--free_count_];
  }
  const std::size_t added = hole.facet_count - count;
  if (cell_count_ + added > capacity_) [[unlikely]]
    grow_cells(cell_count_ + added);
  constexpr Handle kCell = CellArray::cell(1);
  Words next = CellArray::cell(cell_count_) + Words{0, kCell, 2 * kCell, 3 * kCell};
  for (std::size_t i = count; i < hole.facet_count; i += kAhead) {
    for (std::size_t k = 0; k < kAhead; k += 4, next += 4 * kCell) store(next, star + i + k);
  }
  cell_count_ += static_cast<std::uint32_t>(added);
}

/// Makes the spheres of the star and finds those of its cells that are certainly in conflict with
/// the next point.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kHasOrderKeys>::make_star_spheres(VertexRef query, VertexRef next,
                                                                 std::size_t count, bool on_hull) {
  constexpr std::size_t kRepeated = 2 * std::size_t{kLanes} - 1;
  static_assert(kRepeated <= kAhead);
  for (std::size_t i = count; i < count + kRepeated; ++i) star_[i] = star_[count - 1];
  const StarView star{.coordinates = points_.coordinates,
                      .largest = points_.largest,
                      .cells = cells_,
                      .handles = star_.data(),
                      .query = points_.at(query),
                      .next = points_.at(next)};
  std::size_t known = 0;
  Integers<kLanes> certain = ~Integers<kLanes>{};
  std::uint32_t in_conflict = 0;
  Handle* const conflicts = conflicts_.data();
  Corners<kLanes> corners;
  gather_corners<kLanes>(star, 0, corners);
  for (std::size_t i = 0; i < count; i += kLanes) {
    in_conflict = make_spheres<kLanes, kHasOrderKeys>(star, i, corners, certain);
    if constexpr (kLanes == 2) {
      conflicts[known] = star.handles[i];
      known += in_conflict & 1;
      conflicts[known] = star.handles[i + 1];
      known += in_conflict >> 1;
    } else {
      Words handles;
      load(star.handles + i, handles);
      known = append<kLanes>(handles, in_conflict, conflicts, known);
    }
  }
  known -= (in_conflict >> (kLanes - 1)) * (-count % kLanes);  // those that repeat the last one
  star_is_certain_ = false;
  if (on_hull) [[unlikely]] {
    known = make_half_spaces(next, count, known);
  } else if (known <= kMostKnown) {
    star_is_certain_ = mask_of((Reals<kLanes>)certain) == (1U << kLanes) - 1;
  }
  known_conflicts_ = known;
  if (known == 0) {
    star_is_certain_ = false;
    choose_hint(star.next, count);
  } else {
    look_beyond_star<kLanes>(star.next, known);
  }
}

template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kHasOrderKeys>::insert_by(VertexRef query, VertexRef next) {
  std::size_t known = known_conflicts_;
  if (known == 0) {
    const Handle found = locate(query);
    if (found == kNone) return;
    cells_.at_cell(found).vertices[3] |= kMark;
    conflicts_[0] = found;
    known = 1;
  }
  const HoleLists hole = find_hole<kLanes>(query, known);
  take_cells<kLanes>(hole);
  const bool on_hull = star_maker_.make<kLanes>({.cells = cells_,
                                                 .apex = query,
                                                 .facets = hole.facets,
                                                 .outer = hole.outer,
                                                 .handles = star_.data(),
                                                 .count = hole.facet_count});
  make_star_spheres<kLanes>(query, next, hole.facet_count, on_hull);
}

}  // namespace spillway::delaunay::kernel_3d
