#pragma once
// The coordinates that the own kernels compute with: exact images of the given ones, of a size that
// keeps their arithmetic from overflowing, and integers wherever that is possible.

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Multiplies coordinates by a power of two. Points of a lattice (any set of points that all are
/// integers below 2^53 times one power of two: LiDAR's integers as well as quarters of a metre)
/// become integers of less than 2^53, counted from the corner of their box, without a common
/// divisor that is a power of two. Others are brought to a box whose longest side is in [1, 2),
/// exactly but for results below the normal range, which are rounded by at most 2^-1075.
template <int D>
class CoordinateScaling {
 public:
  /// For these points, which are not all equal.
  explicit CoordinateScaling(std::span<const Point<D>> points);

  [[nodiscard]] bool lattice() const { return lattice_; }
  /// The sides of the scaled points' box, rounded.
  [[nodiscard]] const Point<D>& extent() const { return extent_; }

  /// A box inside the image of a box, which may have infinite sides: nearly all of it.
  [[nodiscard]] Box<D> inner_box(const Box<D>& box) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box<D> inner{(*this)(box.lo), (*this)(box.hi)};
    for (int k = 0; k < D; ++k) {
      inner.lo[k] = std::nextafter(inner.lo[k], kInfinity);
      inner.hi[k] = std::nextafter(inner.hi[k], -kInfinity);
    }
    return inner;
  }

  Point<D> operator()(const Point<D>& p) const {
    Point<D> result;
    for (int k = 0; k < D; ++k) result[k] = (p[k] * first_ - corner_[k]) * second_;
    return result;
  }

 private:
  bool lattice_ = false;
  /// Two factors, because the powers reach from 2^-1024 to 2^1074. On a lattice the points times
  /// the first are integers, otherwise the corner is 0.
  double first_ = 1, second_ = 1;
  Point<D> corner_{};
  Point<D> extent_{};
};

}  // namespace spillway::delaunay
