#pragma once

#include "src/geometry/box.h"
#include "src/geometry/constructions/circumsphere.h"
#include "src/geometry/constructions/half_space.h"
#include "src/geometry/point.h"

namespace spillway::geometry {

/// Where some points lie that are nearly on a line or in a plane: within `radius` of `centre`, and
/// within `thickness` of the hyperplane through it with that normal. Much less than a box around
/// them, unless their plane is across an axis.
template <int D>
struct Plate {
  Point<D> centre{};
  Point<D> normal{};  ///< of length 1, but for rounding
  double radius = 0;
  double thickness = 0;

  /// Makes it large enough for a point; for another plate.
  void expand(const Point<D>& point) { expand(Plate{point, normal, 0, 0}); }
  void expand(const Plate& other);
};

/// False only if the closed ball certainly has no point in common with the plate.
template <int D>
bool may_meet(const CertifiedBall<D>& ball, const Plate<D>& plate);

/// The same of a closed half-space.
template <int D>
bool may_meet(const HalfSpace<D>& half_space, const Plate<D>& plate);

}  // namespace spillway::geometry
