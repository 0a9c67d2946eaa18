#pragma once

#include <array>
#include <optional>

#include "src/geometry/framed_point.h"

namespace spillway::geometry {

/// The affine map from integer coordinates to output coordinates: world = integer * scale + offset,
/// evaluated in double in exactly this way (one multiplication, one addition, each rounded to
/// nearest). Axes are x, y, z. Integers are held as doubles and are exact below 2^53.
struct IntegerLattice {
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> offset{0, 0, 0};

  bool operator==(const IntegerLattice&) const = default;

  [[nodiscard]] double to_world(int axis, double integer) const {
    return integer * scale[axis] + offset[axis];
  }
  [[nodiscard]] WorldPoint to_world(const LatticePoint& integers) const {
    return {to_world(0, integers[0]), to_world(1, integers[1]), to_world(2, integers[2])};
  }

  /// The integer whose world coordinate is exactly `world`; nothing when there is none.
  [[nodiscard]] std::optional<double> to_integer(int axis, double world) const;

  /// Whether to_world() gives finite and distinct numbers for all integers from `lo` to `hi`, of
  /// which to_integer() finds each again. Proved from the sizes of numbers: true says that it is
  /// so, and false is said only where doubles are nearly as far apart as integers are, or farther.
  [[nodiscard]] bool keeps_apart(int axis, double lo, double hi) const;

  /// Whether to_world() of all integers from `lo` to `hi`, and their differences, are finite.
  [[nodiscard]] bool is_finite(int axis, double lo, double hi) const;

  /// Whether the first `dimensions` axes have one scale, so that the Delaunay triangulation of the
  /// integers is that of the scaled points.
  [[nodiscard]] bool isotropic(int dimensions) const;
};

/// A point of what has this lattice, or none, in output coordinates.
inline WorldPoint in_world(const std::optional<IntegerLattice>& lattice,
                           const LatticePoint& point) {
  return lattice ? lattice->to_world(point) : WorldPoint(point.numbers());
}

}  // namespace spillway::geometry
