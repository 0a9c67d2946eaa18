#pragma once

#include <algorithm>
#include <cstdint>

#include "src/geometry/torus.h"

namespace spillway::stream {

/// A periodic box, and how far around it copies of points are triangulated with it. All in the
/// coordinates that predicates run on.
class PeriodicDomain {
 public:
  /// A margin above half a period is cut to that, along each axis.
  PeriodicDomain(const Torus& torus, double margin) : torus_(torus), margin_(margin) {}

  [[nodiscard]] const Torus& torus() const { return torus_; }
  /// As it was given.
  [[nodiscard]] double margin() const { return margin_; }
  /// Along an axis that is periodic.
  [[nodiscard]] double margin(int axis) const {
    return std::min(margin_, kHalf * torus_.period(axis));
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
  /// With room for the rounding of centres (SimplexPlace).
  static constexpr double kHalf = 0.5 + 0x1p-20;

  Torus torus_;
  double margin_;
};

}  // namespace spillway::stream
