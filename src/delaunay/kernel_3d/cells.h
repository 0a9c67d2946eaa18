#pragma once
// The cells of a triangulation in space, each in a cache line of its own.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_3d {

/// A cell, or one of its facets, by a word of the array of cells: a cell's first one, 16 * cell,
/// and for the facet opposite to the vertex in a slot (0 to 3) that of its neighbour there, 16 *
/// cell + 4 + slot.
using Handle = std::uint32_t;

/// A vertex as cells name it: four times its number, the place of its coordinates in the array of
/// doubles.
using VertexRef = std::uint32_t;

/// Four vertices, positively oriented, with the circumsphere: for a query q and s = |q - centre|^2
/// - squared_radius, the cell is in conflict if s < -tolerance, and not in conflict if s >
/// tolerance; else the upper stages decide. An infinite cell has the nearest there is to its
/// half-space, a huge ball.
struct alignas(64) Cell {
  VertexRef vertices[4];  ///< the last one with kMark while the cell is in conflict, or free
  Handle neighbours[4];   ///< the facets opposite to them, by their handles in the neighbours
  double centre[3];
  /// Its last bits carry the tolerance, a power of two, and on lattices notes (spheres.h). NaN
  /// where s proves nothing.
  double squared_radius;
};
static_assert(sizeof(Cell) == 64);

inline constexpr VertexRef kInfinite = 0;
inline constexpr std::uint32_t kMark = std::uint32_t{1} << 31;

inline std::array<VertexRef, 4> vertices_of(const Cell& cell) {
  return {cell.vertices[0], cell.vertices[1], cell.vertices[2], cell.vertices[3] & ~kMark};
}

/// The slot of the infinite vertex, or 4.
inline std::size_t infinite_slot(const std::array<VertexRef, 4>& vertices) {
  return std::find(vertices.begin(), vertices.end(), kInfinite) - vertices.begin();
}

/// For each slot an even permutation of a cell's vertices that begins with it.
alignas(16) inline constexpr std::array<std::array<std::uint32_t, 4>, 4> kPlaces{
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 1, 0, 2}}};

/// The cell's vertices in that order, with kMark where it is.
template <int kLanes>
SPILLWAY_INLINE void load_from_slot(const Cell& cell, std::uint32_t slot, Words& vertices) {
  const std::array<std::uint32_t, 4>& places = kPlaces[slot];
  if constexpr (kShufflesWords<kLanes>) {
    load(cell.vertices, vertices);
    shuffle(vertices, places.data());
  } else {
    vertices = Words{cell.vertices[places[0]], cell.vertices[places[1]], cell.vertices[places[2]],
                     cell.vertices[places[3]]};
  }
}

/// Cells by handle.
class CellArray {
 public:
  /// Handles have 32 bits.
  using Record = Cell;
  static constexpr std::size_t kMostRecords = std::size_t{1} << 28;
  static constexpr int kNumberShift = 4;  ///< of a handle, to the cell's number

  CellArray() = default;
  explicit CellArray(void* memory) : bytes_(static_cast<std::byte*>(memory)) {}

  static constexpr Handle cell(std::uint32_t number) { return number << kNumberShift; }
  static constexpr Handle facet(Handle cell, std::uint32_t slot) { return cell + 4 + slot; }
  static constexpr Handle cell_of(Handle facet) { return facet & ~Handle{15}; }
  static constexpr std::uint32_t slot(Handle facet) { return facet & 3; }
  SPILLWAY_INLINE static Words cells_of(const Words& facets) { return facets & ~Handle{15}; }
  /// The facets of a cell.
  SPILLWAY_INLINE static Words facets(Handle cell) { return cell + Words{4, 5, 6, 7}; }

  [[nodiscard]] Cell& at_cell(Handle cell) const {
    return *reinterpret_cast<Cell*>(bytes_ + std::size_t{cell} * 4);
  }
  /// The cell of this number.
  [[nodiscard]] Cell& record(std::uint32_t number) const { return at_cell(cell(number)); }
  /// The cell of a facet.
  [[nodiscard]] Cell& at(Handle facet) const { return at_cell(cell_of(facet)); }
  /// The neighbour at a facet.
  [[nodiscard]] Handle& neighbour(Handle facet) const {
    return *reinterpret_cast<Handle*>(bytes_ + std::size_t{facet} * 4);
  }
  void join(Handle g, Handle h) const {
    neighbour(g) = h;
    neighbour(h) = g;
  }

 private:
  std::byte* bytes_ = nullptr;
};

}  // namespace spillway::delaunay::kernel_3d
