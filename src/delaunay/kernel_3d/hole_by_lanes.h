#pragma once
// The hole that a new point makes: a part of insertion_by_lanes.h.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/ties_by_lanes.h"

namespace spillway::delaunay::kernel_3d {

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
  SPILLWAY_INLINE explicit PointCopy(const double* point) { std::copy_n(point, 4, coordinates); }
};

/// Lists the facets of a cell of the hole that are its boundary, those whose neighbours are not
/// `inside`.
template <int kLanes>
SPILLWAY_INLINE void list_boundary(Handle cell, const Words& neighbours, std::uint32_t inside,
                                   HoleLists& hole) {
  append<kLanes>(neighbours, inside ^ 15, hole.outer, hole.facet_count);
  hole.facet_count =
      append<kLanes>(CellArray::facets(cell), inside ^ 15, hole.facets, hole.facet_count);
}

/// Marks the cells of the star that are known to be in conflict with the next point, and tests
/// their neighbours beyond the star.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kHasOrderKeys>::look_beyond_star(const double* next,
                                                                std::size_t known) {
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

/// Examines the known cells of the newest star, where all is certain: which of their neighbours in
/// the star are in conflict is known, too, and those beyond it have been tested.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE void Insertion<kHasOrderKeys>::leave_star(std::size_t known, HoleLists& hole) {
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

/// Finds all cells in conflict with the query; the first ones are known, listed and marked. Marks
/// them.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE auto Insertion<kHasOrderKeys>::find_hole(VertexRef query, std::size_t known)
    -> HoleLists {
  const PointCopy q(points_.at(query));
  const CellArray cells = cells_;
  HoleLists hole = hole_lists(known, 0);
  std::size_t examined = 0;
  if (star_is_certain_) {
    leave_star<kLanes>(known, hole);
    examined = known;
  }
  // How many cells may be examined before there may be no room for what is beside them.
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

}  // namespace spillway::delaunay::kernel_3d
