#pragma once
// Space without a boundary: boxes whose opposite sides are one.

#include <spillway/extent.h>

#include <array>

namespace spillway {

/// A rectangle or cuboid that repeats without end along its periodic axes: the flat torus of it if
/// all axes are. Whatever leaves it through one side comes back through the opposite one.
///
/// A point stands for all of its copies, which lie whole periods apart. It is brought into the box:
/// at or above `low`, below `high`. The coordinates of such an axis are rounded to multiples of a
/// power of 2 at which copies of them are exact (2^-52 of the box, or finer), and so are the sides;
/// on a lattice the sides must be on it.
struct PeriodicBox {
  Extent box{};                                    ///< sides of open axes are not looked at
  std::array<bool, 3> periodic{true, true, true};  ///< by axis; in the plane x and y count

  bool operator==(const PeriodicBox&) const = default;

  [[nodiscard]] double period(int axis) const { return box.high[axis] - box.low[axis]; }
};

}  // namespace spillway
