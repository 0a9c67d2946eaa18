#include "src/geometry/lattice.h"

#include <cmath>

namespace spillway {

std::optional<double> Lattice::to_integer(int axis, double world) const {
  const double guess = std::round((world - offset[axis]) / scale[axis]);
  for (const double candidate : {guess, guess - 1, guess + 1}) {
    if (to_world(axis, candidate) == world) return candidate;
  }
  return std::nullopt;
}

bool Lattice::isotropic(int dimensions) const {
  for (int k = 1; k < dimensions; ++k) {
    if (scale[k] != scale[0]) return false;
  }
  return true;
}

}  // namespace spillway
