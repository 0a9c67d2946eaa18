#pragma once
// The inner loop of insertion, for vectors of any width. A source that includes this compiles it
// for one instruction set.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "src/delaunay/kernel_3d/exact_predicates.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"

namespace spillway::kernel_3d {

inline constexpr Handle kNone = ~Handle{0};

/// Words whose highest bits are the bits of a number.
struct HighBits {
  alignas(16) std::array<std::array<std::uint32_t, 4>, 16> words{};

  constexpr HighBits() {
    for (std::uint32_t bits = 0; bits < 16; ++bits) {
      for (std::uint32_t k = 0; k < 4; ++k) words[bits][k] = bits >> k << 31;
    }
  }
};
inline constexpr HighBits kHighBits;

/// The point's record where no store to the cells can change it, as far as the compiler knows.
struct alignas(32) PointCopy {
  double coordinates[4];
  explicit PointCopy(const double* point) { std::copy_n(point, 4, coordinates); }
};

/// On a lattice, for a query that is on a cell's sphere: the tie rule. The largest vertex, which
/// mostly decides, has been noted.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE bool Insertion<kRanked>::noted_tie_conflicts(const Cell& cell,
                                                             VertexRef query) const {
  if (!points_.tiny) return tie_conflicts(points_, {vertices_of(cell), query});
  const double* q = points_.at(query);
  std::uint32_t largest = largest_slot(cell.squared_radius);
  for (;;) {
    Words v;
    load_from_slot<kLanes>(cell, largest, v);
    v &= ~kMark;
    const double coefficient = volume(q, points_.at(v[1]), points_.at(v[2]), points_.at(v[3]));
    const double rank = points_.at(v[0])[3];
    // What the coefficient says holds only if the vertex is larger than the query. That is hard to
    // foresee, so it is no condition.
    const double decisive = std::min(rank - q[3], coefficient);
    if (decisive != 0) return decisive > 0;
    double next = q[3];
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      const double other = points_.at(cell.vertices[slot] & ~kMark)[3];
      if (other < rank && other > next) {
        next = other;
        largest = slot;
      }
    }
    if (next == q[3]) return false;
  }
}

/// Of the doubtful neighbours of a cell, those in conflict.
template <bool kRanked>
template <int kLanes>
[[gnu::noinline]] std::uint32_t Insertion<kRanked>::decide(const Cell& cell, std::uint32_t doubtful,
                                                           VertexRef query) const {
  std::uint32_t result = 0;
  for (; doubtful != 0; doubtful &= doubtful - 1) {
    const int k = std::countr_zero(doubtful);
    const Handle there = CellArray::cell_of(cell.neighbours[k]);
    const Cell& other = cells_.at_cell(there);
    const bool inside =
        tie_is_noted(other) ? noted_tie_conflicts<kLanes>(other, query) : conflicts(there, query);
    result |= static_cast<std::uint32_t>(inside) << k;
  }
  return result;
}

/// Lists the facets of a cell of the hole that are its boundary, those whose neighbours are not
/// `inside`.
template <int kLanes>
SPILLWAY_INLINE void list_boundary(Handle cell, const Words& neighbours, std::uint32_t inside,
                                   HoleLists& hole) {
  append<kLanes>(neighbours, inside ^ 15, hole.outer, hole.facet_count);
  hole.facet_count =
      append<kLanes>(CellArray::facets(cell), inside ^ 15, hole.facets, hole.facet_count);
}

/// Finds all cells in conflict with the query; the first ones are known, listed and marked. Marks
/// them.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE auto Insertion<kRanked>::find_hole(VertexRef query, std::size_t known)
    -> HoleLists {
  const PointCopy q(points_.at(query));
  const CellArray cells = cells_;
  HoleLists hole = hole_lists(known, 0);
  std::size_t examined = 0;
  if (star_is_certain_) {
    leave_star<kLanes>(known, hole);
    examined = known;
  }
  // So many cells may be examined before there may be no room for what is beside them.
  const auto room = [&] { return (conflicts_.size() - known - kAhead) / 4; };
  std::size_t most = room();
  for (; examined < hole.cell_count; ++examined) {
    if (examined == most) [[unlikely]] {
      resize_lists(2 * conflicts_.size());
      hole = hole_lists(hole.cell_count, hole.facet_count);
      most = room();
    }
    const Handle here = hole.cells[examined];
    const Cell& cell = cells.at_cell(here);
    const FourAnswers answer = test_four<kLanes>(
        [&](int k) -> const Cell& { return cells.at(cell.neighbours[k]); }, q.coordinates);
    VertexRef* const last[4]{
        &cells.at(cell.neighbours[0]).vertices[3], &cells.at(cell.neighbours[1]).vertices[3],
        &cells.at(cell.neighbours[2]).vertices[3], &cells.at(cell.neighbours[3]).vertices[3]};
    Words marks{*last[0], *last[1], *last[2], *last[3]};
    const std::uint32_t marked = mask_of(marks);
    std::uint32_t inside = answer.inside | marked;
    const std::uint32_t doubtful = answer.doubtful & ~marked;
    if (doubtful != 0) [[unlikely]] {
      inside = (inside & ~doubtful) | decide<kLanes>(cell, doubtful, query);
    }
    Words new_marks;
    load(kHighBits.words[inside].data(), new_marks);
    marks |= new_marks;
    for (int k = 0; k < 4; ++k) *last[k] = marks[k];
    Words neighbours;
    load(cell.neighbours, neighbours);
    hole.cell_count = append<kLanes>(CellArray::cells_of(neighbours), inside & ~marked, hole.cells,
                                     hole.cell_count);
    list_boundary<kLanes>(here, neighbours, inside, hole);
  }
  return hole;
}

/// Examines the known cells of the newest star, where all is certain: which of their neighbours in
/// the star are in conflict is known, too, and those beyond it have been tested.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::leave_star(std::size_t known, HoleLists& hole) {
  const CellArray cells = cells_;
  const std::uint64_t outer_in_conflict = outer_in_conflict_;
  for (std::size_t i = 0; i < known; ++i) {
    const Handle here = hole.cells[i];
    const Cell& cell = cells.at_cell(here);
    Words neighbours;
    load(cell.neighbours, neighbours);
    const Handle outer = CellArray::cell_of(cell.neighbours[0]);
    VertexRef& last = cells.at_cell(outer).vertices[3];
    const auto found = static_cast<std::uint32_t>(outer_in_conflict >> i & 1) & ~(last >> 31);
    last |= found << 31;
    hole.cells[hole.cell_count] = outer;
    hole.cell_count += found;
    const Words marks{last, cells.at(cell.neighbours[1]).vertices[3],
                      cells.at(cell.neighbours[2]).vertices[3],
                      cells.at(cell.neighbours[3]).vertices[3]};
    list_boundary<kLanes>(here, neighbours, mask_of(marks), hole);
  }
}

/// Chooses cells for the star: those of the hole, then free ones, then new ones.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::take_cells(const HoleLists& hole) {
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
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::make_star_spheres(VertexRef query, VertexRef next,
                                                           std::size_t count, bool on_hull) {
  for (std::size_t i = count; i < count + kLanes - 1; ++i) star_[i] = star_[count - 1];
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
  for (std::size_t i = 0; i < count; i += kLanes) {
    in_conflict = make_spheres<kLanes, kRanked>(star, i, certain);
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

/// Marks the cells of the star that are known to be in conflict with the next point, and tests
/// their neighbours beyond the star.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::look_beyond_star(const double* next, std::size_t known) {
  const PointCopy q(next);
  const CellArray cells = cells_;
  Handle* const conflicts = conflicts_.data();
  for (std::size_t i = known; i < known + 3; ++i) conflicts[i] = conflicts[known - 1];
  std::uint64_t outer_in_conflict = 0;
  std::uint32_t doubtful = 0;
  for (std::size_t i = 0; i < known; i += 4) {
    std::array<Handle, 4> outer;
    for (std::size_t k = 0; k < 4; ++k) {
      Cell& cell = cells.at_cell(conflicts[i + k]);
      cell.vertices[3] |= kMark;
      outer[k] = CellArray::cell_of(cell.neighbours[0]);
      for (const Handle neighbour : cells.at_cell(outer[k]).neighbours) {
        __builtin_prefetch(&cells.at(neighbour));
      }
    }
    const FourAnswers answer = test_four<kLanes>(
        [&](int k) -> const Cell& { return cells.at_cell(outer[k]); }, q.coordinates);
    outer_in_conflict |= std::uint64_t{answer.inside} << i % 64;
    doubtful |= answer.doubtful;
  }
  outer_in_conflict_ = outer_in_conflict;
  star_is_certain_ &= doubtful == 0;
}

template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::insert_by(VertexRef query, VertexRef next) {
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

}  // namespace spillway::kernel_3d
