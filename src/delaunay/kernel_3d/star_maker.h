#pragma once
// Fills the hole that a new point makes with the cells at it, its star, and joins them.

#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_common/lanes.h"

namespace spillway::delaunay::kernel_3d {

/// A hole, and where its star is to be made. What the removed cells hold is still there.
struct HoleView {
  CellArray cells;
  VertexRef apex;
  const Handle* facets;   ///< of the removed cells
  const Handle* outer;    ///< the same facets in the cells around
  const Handle* handles;  ///< the new cell of each facet
  std::size_t count;
};

/// Makes stars. At each edge of a hole two facets meet, which run along it in opposite directions;
/// so the neighbour across an edge is found by its two ends.
class StarMaker {
 public:
  explicit StarMaker(std::size_t vertex_count)
      : number_of_(vertex_count),
        corner_across_(kTableSide * kTableSide),
        vertices_(kSmallStar),
        around_(kSmallStar) {}

  /// Sets vertices and neighbours of the new cells, the apex first in each, and joins them to what
  /// is around. Tells whether the infinite vertex is among their vertices.
  template <int kLanes>
  SPILLWAY_INLINE bool make(const HoleView& hole) {
    if (hole.count <= kSmallStar) return make_small<kLanes>(hole);
    return make_large(hole);
  }

 private:
  /// Facets up to which the numbers of corners fit a byte, three for each facet.
  static constexpr std::size_t kSmallStar = 85;
  static constexpr std::size_t kTableSide = 256;
  /// A number that no corner of small stars has.
  static constexpr std::uint8_t kNoCorner = 255;

  template <int kLanes>
  bool make_small(const HoleView& hole);
  bool make_large(const HoleView& hole);
  void join_by_table(const HoleView& hole);
  void join_by_hashing(const HoleView& hole);

  /// The edges opposite to a facet's vertices, as places in a table with a row and a column for
  /// each number of a vertex.
  struct Edges {
    std::uint32_t first, second, third;
  };
  /// The numbers of a facet's vertices, the first one again at the end: two bytes that follow each
  /// other are an edge's place.
  SPILLWAY_INLINE static std::uint32_t around(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return a | b << 8 | c << 16 | a << 24;
  }
  SPILLWAY_INLINE static Edges back_along(std::uint32_t around) {
    return {around >> 8 & 0xFFFF, around >> 16, around & 0xFFFF};
  }
  SPILLWAY_INLINE static Edges along(std::uint32_t around) {
    const std::uint32_t reversed = __builtin_bswap32(around);
    return {reversed >> 8 & 0xFFFF, reversed & 0xFFFF, reversed >> 16};
  }

  /// An edge of a large star's hole, and the first corner that was found opposite to it.
  struct Edge {
    std::uint64_t ends;  ///< the smaller one last; 0 where there is no edge
    Handle corner;
  };

  std::vector<std::uint8_t> number_of_;  ///< for each vertex of a star
  /// In small stars for each edge the number of the corner that is opposite to it, and that
  /// corner's handle.
  std::vector<std::uint8_t> corner_across_;
  std::array<Handle, 3 * kSmallStar + 1> corner_handles_;
  std::vector<Handle> corner_handle_across_;  ///< the same in large ones, at once
  std::vector<Edge> hashed_edges_;            ///< in those that are larger yet
  std::vector<Words> vertices_;               ///< of the new cells: in small stars their numbers
  std::vector<std::uint32_t> around_;         ///< the facets
};

/// Here a vertex's number is that of a corner where it occurs, 3 * facet + 0, 1 or 2: no matter
/// which, so whoever writes last is right.
template <int kLanes>
SPILLWAY_INLINE bool StarMaker::make_small(const HoleView& hole) {
  // Bytes may be part of anything for the compiler: what it is to keep in registers is copied.
  const auto [cells, apex, facets, outer, handles, count] = hole;
  std::uint8_t* const number_of = number_of_.data();
  std::uint8_t* const corner_across = corner_across_.data();
  Handle* const corner_handles = corner_handles_.data();
  std::uint32_t* const all_around = around_.data();
  Words* const numbers = vertices_.data();
  number_of[kInfinite / 4] = kNoCorner;
  for (std::size_t i = 0; i < count; ++i) {
    const Cell& removed = cells.at(facets[i]);
    Words vertices;
    load_from_slot<kLanes>(removed, CellArray::slot(facets[i]), vertices);
    vertices = ((vertices & Words{0, ~kMark, ~kMark, ~kMark}) | Words{apex, 0, 0, 0}) >> 2;
    numbers[i] = vertices;
    // The facets at the three; what is stored last is not used.
    store(handles[i] + Words{5, 6, 7, 0}, corner_handles + 3 * i);
    for (std::uint32_t k = 0; k < 3; ++k) {
      number_of[vertices[k + 1]] = static_cast<std::uint8_t>(3 * i + k);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t round =
        around(number_of[numbers[i][1]], number_of[numbers[i][2]], number_of[numbers[i][3]]);
    all_around[i] = round;
    const Edges edges = along(round);
    const auto corner = static_cast<std::uint8_t>(3 * i);
    corner_across[edges.first] = corner;
    corner_across[edges.second] = corner + 1;
    corner_across[edges.third] = corner + 2;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Edges edges = back_along(all_around[i]);
    Cell& cell = cells.at_cell(handles[i]);
    store(numbers[i] << 2, cell.vertices);
    // At once: here it is stores that the processor is short of.
    const Words neighbours{outer[i], corner_handles[corner_across[edges.first]],
                           corner_handles[corner_across[edges.second]],
                           corner_handles[corner_across[edges.third]]};
    store(neighbours, cell.neighbours);
    cells.neighbour(outer[i]) = CellArray::facet(handles[i], 0);
  }
  return number_of[kInfinite / 4] != kNoCorner;
}

}  // namespace spillway::delaunay::kernel_3d
