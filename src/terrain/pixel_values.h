#pragma once

#include "src/geometry/lattice.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::terrain {

/// Units of height for a unit of x and of y.
using Gradient = Point<2>;

/// The plane through a triangle's corners. Whatever it returns depends on the corners alone, and at
/// centres on edges and corners on these alone: it is the same from all triangles that meet there.
class TrianglePlane {
 public:
  /// Corners in canonical order, not on one line. `scale`: output units in a unit of x and of y.
  TrianglePlane(const Triangle& canonical, const Point<2>& scale);

  /// The height at a centre inside, never beyond those of the corners.
  [[nodiscard]] double inside(double x, double y) const {
    const double height =
        corners_[0][2] + gradient_[1] * (y - corners_[0][1]) + gradient_[0] * (x - corners_[0][0]);
    return height < lowest_ ? lowest_ : height > highest_ ? highest_ : height;
  }

  /// The height at a centre in this relation to the triangle.
  [[nodiscard]] double at(TriangleRelation relation, double x, double y) const;

  /// In output units.
  [[nodiscard]] Gradient gradient() const {
    return {gradient_[0] / scale_[0], gradient_[1] / scale_[1]};
  }

 private:
  const Triangle& corners_;
  Point<2> scale_;
  Gradient gradient_;  ///< in the triangle's coordinates
  double lowest_;
  double highest_;
};

/// Where the light of a hillshade comes from, in degrees.
struct Light {
  double azimuth = 315;  ///< clockwise from north
  double altitude = 45;  ///< above the horizon
};

// What follows is never -0.

/// Steepness in degrees, from 0 (level) to 90.
double slope_of(const Gradient& gradient);

/// The direction that the surface falls to, in degrees clockwise from north, from 0 to below 360
/// also as a float; not a number where it is level.
double aspect_of(const Gradient& gradient);

/// The unit vector towards a light: east, north, up.
Point<3> direction_of(const Light& light);

/// Brightness from 0 (no light) to 255 (facing the light): the cosine of the angle between the
/// light and the surface's normal (Horn, "Hill shading and the reflectance map", 1981).
double hillshade_of(const Gradient& gradient, const Point<3>& light_direction);

}  // namespace spillway::terrain
