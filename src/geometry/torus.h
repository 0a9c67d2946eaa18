#pragma once
// Boxes that repeat along some axes: which copy of a point lies where.

#include <spillway/periodic.h>

#include <array>
#include <cstdint>

#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::geometry {

/// By axis, so many periods; 0 along open axes.
template <int D>
using Periods = std::array<std::int8_t, D>;

/// What became of a point that was brought into the box.
struct Wrapping {
  bool moved = false;    ///< it was outside
  bool rounded = false;  ///< its coordinates were no multiples of the step
};

/// A periodic box in the coordinates that predicates run on. Coordinates of points in it are
/// multiples of a step, a power of 2, along each periodic axis, which is so large that their sums
/// with a period are exact: copies of points are exact, and so are predicates of them.
class Torus {
 public:
  /// For coordinates without a lattice: the sides are rounded to the step. Throws
  /// Failure(kInvalidArgument) for a side that is not finite or not above 0, for a box too far from
  /// 0 for its size, and for one without a periodic axis.
  Torus(const PeriodicBox& box, int dimension);
  /// For integers of that lattice. Throws also for sides that are not on it.
  Torus(const PeriodicBox& box, int dimension, const IntegerLattice& lattice);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] bool periodic(int axis) const { return axes_[axis].periodic; }
  /// Whether all axes are.
  [[nodiscard]] bool closed() const;
  [[nodiscard]] double low(int axis) const { return axes_[axis].low; }
  /// Exact.
  [[nodiscard]] double high(int axis) const { return axes_[axis].low + axes_[axis].period; }
  [[nodiscard]] double period(int axis) const { return axes_[axis].period; }
  /// Of the periodic axes.
  [[nodiscard]] double shortest_period() const;

  /// The box as it is after rounding, in the same coordinates.
  [[nodiscard]] PeriodicBox box() const;

  /// Brings a point into the box: low <= coordinate < high along periodic axes.
  template <typename AnyPoint>
  Wrapping wrap(AnyPoint& point) const {
    Wrapping result;
    for (int k = 0; k < dimension_; ++k) {
      if (axes_[k].periodic) wrap(axes_[k], point[k], result);
    }
    return result;
  }

  /// Which copy of a point of the box this is, of those next to the box.
  template <int D, typename AnyPoint = Point<D>>
  [[nodiscard]] Periods<D> periods_of(const AnyPoint& copy) const {
    Periods<D> periods{};
    for (int k = 0; k < D; ++k) periods[k] = periods_along(k, copy[k]);
    return periods;
  }
  [[nodiscard]] std::int8_t periods_along(int axis, double coordinate) const {
    const Axis& a = axes_[axis];
    if (!a.periodic) return 0;
    const int above = coordinate >= a.low + a.period ? 1 : 0;
    const int below = coordinate < a.low ? 1 : 0;
    return static_cast<std::int8_t>(above - below);
  }

  /// The coordinate of a copy, exact.
  [[nodiscard]] double moved(int axis, double coordinate, int periods) const {
    return coordinate + periods * axes_[axis].period;
  }
  template <int D>
  [[nodiscard]] Point<D> moved(Point<D> point, const Periods<D>& periods) const {
    for (int k = 0; k < D; ++k) point[k] = moved(k, point[k], periods[k]);
    return point;
  }

 private:
  struct Axis {
    bool periodic = false;
    double low = 0;
    double period = 0;
    double step = 0;
  };

  explicit Torus(int dimension) : dimension_(dimension) {}
  static void wrap(const Axis& axis, double& coordinate, Wrapping& result);
  void check(const PeriodicBox& box) const;

  int dimension_;
  std::array<Axis, 3> axes_{};
};

}  // namespace spillway::geometry
