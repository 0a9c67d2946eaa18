#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/geometry/lattice.h"

namespace spillway::terrain {

/// How many steps of the lattice, from its offset on, a coordinate is. What is a whole number but
/// for the roundings of the coordinate and of the lattice's own map is that whole number.
inline double lattice_steps(const IntegerLattice& lattice, int axis, double world) {
  constexpr double kRoundings = 8 * std::numeric_limits<double>::epsilon();
  constexpr double kLeast = 1e-6;  // of what was computed from other coordinates
  constexpr double kMost = 0.25;   // doubles that are nearly as far apart as steps
  const double steps = (world - lattice.offset[axis]) / lattice.scale[axis];
  const double whole = std::nearbyint(steps);
  const double rounding = kRoundings * ((std::abs(world) + std::abs(lattice.offset[axis])) /
                                            std::abs(lattice.scale[axis]) +
                                        std::abs(steps));
  return std::abs(steps - whole) <= std::clamp(rounding, kLeast, kMost) ? whole : steps;
}

}  // namespace spillway::terrain
