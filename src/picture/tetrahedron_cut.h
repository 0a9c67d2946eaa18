#pragma once

#include <spillway/choices.h>

#include <array>

#include "src/geometry/point.h"

namespace spillway::picture {

/// Where a plane cuts a tetrahedron: a convex polygon, corners in turn, by the two other
/// coordinates in their order.
struct PlaneCut {
  std::array<Point<2>, 4> corners{};
  int count = 0;  ///< 3 or 4; 0: they do not meet
};

/// A corner on the plane counts as above it, so that a face on the plane is cut from one of its two
/// tetrahedra. A cut's corner depends on nothing but the edge it lies on.
PlaneCut cut(const std::array<Point<3>, 4>& tetrahedron, const Slice& plane);

}  // namespace spillway::picture
