#pragma once
// The cells of a triangulation in space, each in a cache line of its own.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "src/geometry/point.h"

namespace spillway::kernel_3d {

/// A vertex's place in a cell, and the facet opposite to it: 8 * cell + slot (0 to 3).
using Handle = std::uint32_t;

/// A vertex as cells name it: four times its number, the place of its coordinates in the array of
/// doubles.
using VertexRef = std::uint32_t;

/// Four vertices, positively oriented, with the circumsphere: for a query q and s = |q - centre|^2
/// - squared_radius, the cell is in conflict if s < -tolerance, and not in conflict if s >
/// tolerance; else the upper rungs decide. An infinite cell has the nearest there is to its
/// half-space, a huge ball.
struct alignas(64) Cell {
  VertexRef vertices[4];  ///< the last one with kMark while the cell is in conflict, or free
  Handle neighbours[4];   ///< the same facets in the neighbours
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

/// Cells by handle.
class CellArray {
 public:
  /// Handles have 32 bits, of which the third is not used.
  static constexpr std::size_t kMaxCells = std::size_t{1} << 29;

  CellArray() = default;
  explicit CellArray(void* memory) : bytes_(static_cast<std::byte*>(memory)) {}

  static constexpr Handle handle(std::uint32_t cell, std::uint32_t slot) { return 8 * cell + slot; }
  static constexpr int kNumberShift = 3;  ///< of a handle, to the cell's number
  static constexpr Handle first_handle(Handle h) { return h & ~Handle{7}; }
  static constexpr std::uint32_t slot(Handle h) { return h & 3; }

  /// The cell of a handle that is its first.
  [[nodiscard]] Cell& at_first(Handle h) const {
    return *reinterpret_cast<Cell*>(bytes_ + std::size_t{h} * 8);
  }
  [[nodiscard]] Cell& at(Handle h) const { return at_first(first_handle(h)); }
  [[nodiscard]] Handle mirror(Handle h) const { return at(h).neighbours[slot(h)]; }
  void join(Handle g, Handle h) const {
    at(g).neighbours[slot(g)] = h;
    at(h).neighbours[slot(h)] = g;
  }

 private:
  std::byte* bytes_ = nullptr;
};

}  // namespace spillway::kernel_3d
