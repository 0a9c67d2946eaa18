#pragma once

#include <array>

#include "src/geometry/point.h"

namespace spillway::geometry {

/// The centre of the circumsphere of a simplex that is not flat, of any orientation. Along each
/// axis it is within 2^-40 of the radius and half a unit in the last place of the true one:
/// certified by certified_ball(), or else computed by exact_circumcentre().
template <int D>
Point<D> circumcentre(const std::array<Point<D>, D + 1>& simplex);

/// The same, rounded to the nearest double from the exact quotient; infinite where that is beyond
/// the largest one. Throws Failure if a coordinate is not finite.
template <int D>
Point<D> exact_circumcentre(const std::array<Point<D>, D + 1>& simplex);

/// The centre of the circle through the corners of a triangle in space, likewise; infinite if they
/// lie on one line.
Point<3> exact_circle_centre(const std::array<Point<3>, 3>& triangle);

}  // namespace spillway::geometry
