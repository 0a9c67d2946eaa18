#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "src/geometry/point.h"

namespace spillway::library {

/// What queries read of a triangulation: plain arrays, as spillway::Delaunay shows them.
template <int D, class Index>
struct MeshView {
  std::span<const Point<D>> points;
  std::span<const Index> vertices;      ///< D+1 a cell
  std::span<const Index> neighbours;    ///< D+1 a cell
  std::span<const Index> vertex_cells;  ///< one a point

  [[nodiscard]] Index vertex(Index cell, int i) const {
    return vertices[static_cast<std::size_t>(cell) * (D + 1) + i];
  }
  [[nodiscard]] Index neighbour(Index cell, int i) const {
    return neighbours[static_cast<std::size_t>(cell) * (D + 1) + i];
  }
  [[nodiscard]] std::array<Point<D>, D + 1> corners(Index cell) const {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = points[vertex(cell, i)];
    return corners;
  }
  /// Opposite which of its vertices a cell has this neighbour.
  [[nodiscard]] int place_of_neighbour(Index cell, Index of) const {
    int i = 0;
    while (neighbour(cell, i) != of) ++i;
    return i;
  }
};

}  // namespace spillway::library
