#pragma once

#include <algorithm>
#include <array>

#include "src/geometry/torus.h"
#include "src/geometry/torus_simplex.h"

namespace spillway::geometry {

/// A periodic box, and how far around it copies of points are triangulated with it. All in the
/// coordinates that predicates run on.
class PeriodicDomain {
 public:
  /// With room for the rounding of centres (SimplexPlace).
  static constexpr double kHalf = 0.5 + 0x1p-20;

  /// A margin above `most` periods is cut to that, along each axis. It may be up to 1.
  PeriodicDomain(const Torus& torus, double margin, double most = kHalf)
      : torus_(torus), margin_(margin), most_(most) {}

  [[nodiscard]] const Torus& torus() const { return torus_; }
  /// As it was given.
  [[nodiscard]] double margin() const { return margin_; }
  /// Along an axis that is periodic.
  [[nodiscard]] double margin(int axis) const {
    return std::min(margin_, most_ * torus_.period(axis));
  }
  /// Whether a point of the box has copies within the margin.
  template <typename AnyPoint>
  [[nodiscard]] bool has_copies(const AnyPoint& point) const {
    for (int k = 0; k < torus_.dimension(); ++k) {
      if (!torus_.periodic(k)) continue;
      const double from_low = point[k] - torus_.low(k);
      const double from_high = torus_.high(k) - point[k];
      if (std::min(from_low, from_high) <= margin(k)) return true;
    }
    return false;
  }
  /// The coordinates along an axis of the copies of a point of the box within the margin, its own
  /// first.
  struct CopiesAlong {
    std::array<double, 3> coordinates;
    int count = 1;
  };
  [[nodiscard]] CopiesAlong copies_along(int axis, double coordinate) const {
    CopiesAlong copies{{coordinate}};
    if (axis >= torus_.dimension() || !torus_.periodic(axis)) return copies;
    const double margin = this->margin(axis);
    for (const int periods : {1, -1}) {
      const double copy = torus_.moved(axis, coordinate, periods);
      if (copy < torus_.low(axis) - margin || copy > torus_.high(axis) + margin) continue;
      copies.coordinates[copies.count++] = copy;
    }
    return copies;
  }
  /// Whether the copies have all points that can lie in a simplex' circumsphere.
  template <int D>
  [[nodiscard]] bool has_sphere(const SimplexPlace<D>& place) const {
    if (widest()) return true;
    for (int k = 0; k < D; ++k) {
      if (!torus_.periodic(k)) continue;
      const bool inside = place.centre[k] - place.radius > torus_.low(k) - margin(k) &&
                          place.centre[k] + place.radius < torus_.high(k) + margin(k);
      if (!inside) return false;
    }
    return true;
  }
  /// Whether no wider margin is of any use: a sphere without points inside has no point on it that
  /// is more than half a period from its centre along a periodic axis, as the copies of it one
  /// period away would be nearer or as near.
  [[nodiscard]] bool widest() const {
    for (int k = 0; k < torus_.dimension(); ++k) {
      if (torus_.periodic(k) && margin_ < kHalf * torus_.period(k)) return false;
    }
    return true;
  }

 private:
  Torus torus_;
  double margin_;
  double most_;
};

}  // namespace spillway::geometry
