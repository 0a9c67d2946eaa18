#pragma once

#include "src/rooms.h"

namespace spillway::generators {

/// A unit vector of the plane.
struct Direction {
  double cosine, sine;
};

/// The direction at an angle, counted in whole turns from the first axis: 0.25 is a right angle.
/// Good to a few units in the last place for up to 2^50 turns, and the same on every machine, since
/// it takes additions and multiplications only.
Direction direction_at(double turns);

}  // namespace spillway::generators
