#pragma once
// The inner loop of insertion, for vectors of any width. A source that includes this compiles it
// for one instruction set.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

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

/// Copies a short list, four at a time: both have room for that at their ends.
SPILLWAY_INLINE void copy_words(const std::uint32_t* from, std::size_t count, std::uint32_t* to) {
  for (std::size_t i = 0; i < count; i += 4) {
    Words words;
    load(from + i, words);
    store(words, to + i);
  }
}

/// Finds all cells in conflict with the query; the first ones are known, and listed. Marks them.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE auto Insertion<kRanked>::find_hole(VertexRef query, std::size_t known) -> Hole {
  const double* q = points_.at(query);
  const CellArray cells = cells_;
  Handle* conflicts = conflicts_.data();
  Handle* boundary = boundary_.data();
  Hole hole{known, 0};
  for (std::size_t i = 0; i < known; ++i) cells.at_first(conflicts[i]).vertices[3] |= kMark;
  for (std::size_t i = 0; i < hole.cells; ++i) {
    const std::size_t most = std::max(hole.cells, hole.facets) + kAhead;
    if (most > conflicts_.size()) [[unlikely]] {
      resize_lists(2 * most);
      conflicts = conflicts_.data();
      boundary = boundary_.data();
    }
    const Handle first = conflicts[i];
    const Cell& cell = cells.at_first(first);
    const std::uint32_t answer = test_neighbours<kLanes>(cells, cell, q);
    VertexRef* const last[4]{
        &cells.at(cell.neighbours[0]).vertices[3], &cells.at(cell.neighbours[1]).vertices[3],
        &cells.at(cell.neighbours[2]).vertices[3], &cells.at(cell.neighbours[3]).vertices[3]};
    Words marks{*last[0], *last[1], *last[2], *last[3]};
    const std::uint32_t marked = mask_of(marks);
    std::uint32_t inside = (answer & 15) | marked;
    const std::uint32_t doubtful = answer >> 4 & ~marked;
    if (doubtful != 0) [[unlikely]] {
      inside = (inside & ~doubtful) | decide(cell, doubtful, query);
    }
    Words new_marks;
    load(kHighBits.words[inside].data(), new_marks);
    marks |= new_marks;
    for (int k = 0; k < 4; ++k) *last[k] = marks[k];
    Words neighbours;
    load(cell.neighbours, neighbours);
    hole.cells = append<kLanes>(neighbours & ~7U, inside & ~marked, conflicts, hole.cells);
    const Words facets = first + Words{0, 1, 2, 3};
    hole.facets = append<kLanes>(facets, inside ^ 15, boundary, hole.facets);
  }
  return hole;
}

/// Chooses cells for a star: free ones, then new ones.
template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::take_cells(std::size_t count) {
  const std::size_t used = std::min(count, free_count_);
  const std::size_t added = count - used;
  if (cell_count_ + added > capacity_) [[unlikely]]
    grow_cells(cell_count_ + added);
  Handle* const star = star_.data();
  free_count_ -= used;
  copy_words(free_.data() + free_count_, used, star);
  constexpr Handle kCell = CellArray::handle(1, 0);
  Words next = CellArray::handle(cell_count_, 0) + Words{0, kCell, 2 * kCell, 3 * kCell};
  for (std::size_t i = used; i < count; i += 4, next += 4 * kCell) store(next, star + i);
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
  Handle* const conflicts = conflicts_.data();
  for (std::size_t i = 0; i < count; i += kLanes) {
    std::uint32_t in_conflict = make_spheres<kLanes, kRanked>(star, i);
    if (i + kLanes > count) in_conflict &= (1U << (count - i)) - 1;
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
  if (on_hull) [[unlikely]]
    known = make_half_spaces(next, count, known);
  for (std::size_t i = 0; i < known; ++i) {
    const Cell& outer = cells_.at(cells_.at_first(conflicts[i]).neighbours[0]);
    for (const Handle neighbour : outer.neighbours) __builtin_prefetch(&cells_.at(neighbour));
  }
  known_conflicts_ = known;
  if (known == 0) choose_hint(star.next, count);
}

template <bool kRanked>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kRanked>::insert_by(VertexRef query, VertexRef next) {
  std::size_t known = known_conflicts_;
  if (known == 0) {
    const Handle found = locate(query);
    if (found == kNone) return;
    conflicts_[0] = found;
    known = 1;
  }
  const Hole hole = find_hole<kLanes>(query, known);
  take_cells<kLanes>(hole.facets);
  const bool on_hull = star_maker_.make<kLanes>({.cells = cells_,
                                                 .apex = query,
                                                 .facets = boundary_.data(),
                                                 .handles = star_.data(),
                                                 .count = hole.facets});
  if (free_count_ + hole.cells + kAhead > free_.size()) [[unlikely]]
    grow_free_list(hole.cells);
  copy_words(conflicts_.data(), hole.cells, free_.data() + free_count_);
  free_count_ += hole.cells;
  make_star_spheres<kLanes>(query, next, hole.facets, on_hull);
}

}  // namespace spillway::kernel_3d
