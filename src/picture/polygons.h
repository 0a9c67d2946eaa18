#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "src/geometry/point.h"
#include "src/picture/picture.h"

namespace spillway::picture {

/// A convex polygon of three or four corners in space, as it is seen.
struct SeenPolygon {
  /// Pixels to the right and downwards from the picture's upper left corner, and nearness.
  std::array<Point<3>, 4> corners{};
  int count = 3;
  Colour colour{};
  float edge_opacity = 0;  ///< of dark lines along its edges, from 0 to 1
};

/// The length of a polygon's side if it were a square, in pixels.
double side_of(const SeenPolygon& polygon);

/// Draws polygons, nearer ones before farther ones; each pixel is the mean of nine samples.
/// Polygons that share an edge leave no gap along it. What they do not cover is transparent. The
/// order of the polygons does not matter.
Picture draw_polygons(std::span<const SeenPolygon> polygons, std::uint32_t columns,
                      std::uint32_t rows);

}  // namespace spillway::picture
