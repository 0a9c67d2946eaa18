#pragma once

#include "src/geometry/exact_sum.h"
#include "src/terrain/triangle_location.h"

namespace spillway::terrain {

/// What lies between two surfaces, in cubes and squares of the coordinates' units.
struct VolumeSums {
  ExactSum cut;   ///< where the first lies above the second
  ExactSum fill;  ///< where it lies below
  ExactSum cut_area;
  ExactSum fill_area;
  ExactSum area;  ///< of the common domain, level parts included

  void add(const VolumeSums& other);
};

// Corners come in canonical order, so that the results do not depend on theirs.

/// The area of a triangle in x and y.
double plane_area(const Triangle& triangle);

/// Adds what lies between two triangles, over what they have in common in x and y: between two
/// triangulations lies the sum over all pairs. Off by roundings of the triangles' size, not of
/// their distance from the origin.
void add_between(const Triangle& first, const Triangle& second, VolumeSums& sums);

/// Adds what lies between a triangle and a level.
void add_above(const Triangle& triangle, double level, VolumeSums& sums);

}  // namespace spillway::terrain
