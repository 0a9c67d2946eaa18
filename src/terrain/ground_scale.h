#pragma once

#include "src/geometry/framed_point.h"

namespace spillway::terrain {

/// How gradients become those of the ground, where x, y and z are not measured alike.
struct GroundScale {
  double height = 1;  ///< what heights are multiplied by
  /// Of longitude and latitude: degrees in a unit of x and y; 0: these are lengths.
  double degrees = 0;
  double semi_major = 0;  ///< of the ellipsoid, in the unit that `height` brings heights to
  double flattening = 0;  ///< of the ellipsoid

  [[nodiscard]] bool changes_nothing() const { return height == 1 && degrees == 0; }
};

/// Lengths of a unit of x and of y at this y, by the radii of curvature of the ellipsoid (Snyder,
/// "Map Projections - A Working Manual", 1987, p. 24 and 25); 1 if these are lengths.
Point<2> lengths_at(const GroundScale& scale, double y);

}  // namespace spillway::terrain
