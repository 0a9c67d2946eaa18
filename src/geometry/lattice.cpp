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

std::optional<std::array<double, 3>> lattice_shift(const Lattice& base, const Lattice& other) {
  constexpr double kLargestShift = 4.5e15;  // keeps shifted 32-bit integers exact in a double
  if (base.scale != other.scale) return std::nullopt;
  std::array<double, 3> shift{};
  for (int k = 0; k < 3; ++k) {
    const double steps = (other.offset[k] - base.offset[k]) / base.scale[k];
    shift[k] = std::round(steps);
    if (!(std::abs(steps - shift[k]) <= 1e-6) || std::abs(shift[k]) > kLargestShift) {
      return std::nullopt;
    }
  }
  return shift;
}

}  // namespace spillway
