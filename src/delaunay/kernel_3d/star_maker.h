#pragma once
// Fills the hole that a new point makes with the cells at it, its star, and joins them.

#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/lanes.h"

namespace spillway::kernel_3d {

/// A hole, and where its star is to be made. What the removed cells hold is still there.
struct HoleView {
  CellArray cells;
  VertexRef apex;
  const Handle* facets;   ///< of the removed cells
  const Handle* handles;  ///< the new cell of each facet
  std::size_t count;
};

/// Makes stars. At each edge of a hole two facets meet, which run along it in opposite directions;
/// so the neighbour across an edge is found by its two ends.
class StarMaker {
 public:
  explicit StarMaker(std::size_t vertex_count)
      : number_of_(vertex_count), corner_across_(kTableSize) {}

  /// Sets vertices and neighbours of the new cells, the apex first in each, and joins them to what
  /// is around. Tells whether the infinite vertex is among their vertices.
  template <int kLanes>
  SPILLWAY_INLINE bool make(const HoleView& hole) {
    if (hole.count <= kUsualStar) return make_small<kLanes, kTableSide / 2>(hole);
    if (hole.count <= kSmallStar) return make_small<kLanes, kTableSide>(hole);
    return make_large(hole);
  }

 private:
  /// Facets up to which corners have numbers that fit half a table, or a table.
  static constexpr std::size_t kUsualStar = 42;
  static constexpr std::size_t kSmallStar = 63;
  static constexpr std::uint32_t kTableSide = 256;
  static constexpr std::size_t kTableSize = std::size_t{kTableSide} * kTableSide;
  /// The number of a vertex that no small star has.
  static constexpr std::uint8_t kNoCorner = 255;

  template <int kLanes, std::uint32_t kSide>
  bool make_small(const HoleView& hole);
  bool make_large(const HoleView& hole);
  void join_by_table(const HoleView& hole);
  static void join_by_sorting(const HoleView& hole);

  /// For each vertex a number within the star.
  std::vector<std::uint8_t> number_of_;
  /// The table of small stars: 4 * facet + slot of the corner across an edge, by the numbers of the
  /// edge's ends.
  std::vector<std::uint8_t> corner_across_;
  std::vector<Handle> handle_across_;  ///< the same of large ones: the corner's handle
  std::array<Handle, 4 * kSmallStar> corner_handles_;
  std::array<std::uint32_t, kSmallStar> corners_;
};

/// Here a vertex's number is that of a corner where it occurs, 3 * facet + 0, 1 or 2: no matter
/// which, so whoever writes last is right.
template <int kLanes, std::uint32_t kSide>
SPILLWAY_INLINE bool StarMaker::make_small(const HoleView& hole) {
  // Bytes may be part of anything for the compiler: what it is to keep in registers is copied.
  const auto [cells, apex, facets, handles, count] = hole;
  std::uint8_t* const number_of = number_of_.data();
  std::uint8_t* const corner_across = corner_across_.data();
  Handle* const corner_handles = corner_handles_.data();
  std::uint32_t* const corners = corners_.data();
  number_of[kInfinite / 4] = kNoCorner;
  for (std::size_t i = 0; i < count; ++i) {
    const Cell& removed = cells.at(facets[i]);
    const auto& places = kPlaces[CellArray::slot(facets[i])];
    Words vertices;
    if constexpr (kShufflesWords<kLanes>) {
      load(removed.vertices, vertices);
      shuffle(vertices, places.data());
      vertices = (vertices & Words{0, ~kMark, ~kMark, ~kMark}) | Words{apex, 0, 0, 0};
    } else {
      vertices = Words{apex, removed.vertices[places[1]] & ~kMark,
                       removed.vertices[places[2]] & ~kMark, removed.vertices[places[3]] & ~kMark};
    }
    const Handle h = handles[i];
    store(vertices, cells.at_first(h).vertices);
    store(h + Words{0, 1, 2, 3}, corner_handles + 4 * i);
    for (std::uint32_t k = 0; k < 3; ++k) {
      number_of[vertices[k + 1] / 4] = static_cast<std::uint8_t>(3 * i + k);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const VertexRef* const vertices = cells.at_first(handles[i]).vertices;
    const std::uint32_t a = number_of[vertices[1] / 4];
    const std::uint32_t b = number_of[vertices[2] / 4];
    const std::uint32_t c = number_of[vertices[3] / 4];
    const auto corner = static_cast<std::uint8_t>(4 * i);
    corner_across[b * kSide + c] = corner + 1;
    corner_across[c * kSide + a] = corner + 2;
    corner_across[a * kSide + b] = corner + 3;
    corners[i] = a | b << 8 | c << 16;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Handle outer = cells.mirror(facets[i]);
    const std::uint32_t a = corners[i] & 255;
    const std::uint32_t b = corners[i] >> 8 & 255;
    const std::uint32_t c = corners[i] >> 16;
    const Handle h = handles[i];
    // At once: here it is stores that the processor is short of.
    const Words neighbours{outer, corner_handles[corner_across[c * kSide + b]],
                           corner_handles[corner_across[a * kSide + c]],
                           corner_handles[corner_across[b * kSide + a]]};
    store(neighbours, cells.at_first(h).neighbours);
    cells.at(outer).neighbours[CellArray::slot(outer)] = h;
  }
  return number_of[kInfinite / 4] != kNoCorner;
}

}  // namespace spillway::kernel_3d
