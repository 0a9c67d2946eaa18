#pragma once

#include <array>

namespace spillway {

/// The steps that coordinates are multiples of, as those of LAS files are: on each axis
/// coordinate = integer * scale + offset, one multiplication and one addition of doubles. Points on
/// one lattice are triangulated by their integers, so that ties are what they are in the file, and
/// decimals are written as the lattice has them.
struct Lattice {
  std::array<double, 3> scale{1, 1, 1};  ///< of x, y, z: not 0
  std::array<double, 3> offset{0, 0, 0};
  /// Whether z lies on it, too. If not, its scale and offset of z are 1 and 0.
  bool has_z = true;

  bool operator==(const Lattice&) const = default;

  /// The coordinate that an integer stands for.
  [[nodiscard]] double coordinate(int axis, double integer) const {
    return integer * scale[axis] + offset[axis];
  }
};

}  // namespace spillway
