#include "src/geometry/lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spillway::geometry {
namespace {

constexpr double kMostExact = 0x1p53;  // integers up to it are doubles

/// From a positive number to the next double.
double step_at(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity()) - value;
}

/// The largest power of two of which a finite number is a multiple; infinity for 0.
double unit_of(double value) {
  if (value == 0) return std::numeric_limits<double>::infinity();
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent);
  const auto digits = static_cast<std::uint64_t>(mantissa * kMostExact);
  return std::ldexp(1.0, exponent - 53 + std::countr_zero(digits));
}

}  // namespace

std::optional<double> IntegerLattice::to_integer(int axis, double world) const {
  const double guess = std::round((world - offset[axis]) / scale[axis]);
  for (const double candidate : {guess, guess - 1, guess + 1}) {
    if (to_world(axis, candidate) == world) return candidate;
  }
  return std::nullopt;
}

/// Neighbours of the range count, as to_integer() looks at them.
///
/// If all products and sums are multiples of a power of two, and not too large, nothing is rounded.
/// Else let p and w be the steps between doubles at the largest product and at the largest result.
/// A product is off by p / 2 at most, and sums that are more than w apart are rounded to different
/// doubles: it takes scale > p + w. On the way back the result is off by (p + w) / 2, the
/// difference by another p / 2, and the quotient's own rounding is worth p at most: less than 3 / 2
/// of a step, which to_integer() makes good, if scale > 2 p + w. Without an offset only product and
/// quotient are rounded, and scale > p will do.
bool IntegerLattice::keeps_apart(int axis, double lo, double hi) const {
  if (!is_finite(axis, lo - 1, hi + 1)) return false;
  const double integer = std::max(std::abs(lo), std::abs(hi)) + 1;
  const double step = std::abs(scale[axis]);
  const double product = integer * step;
  const double world = std::max(std::abs(to_world(axis, lo - 1)), std::abs(to_world(axis, hi + 1)));
  const double unit = std::min(unit_of(scale[axis]), unit_of(offset[axis]));
  const double most = unit * kMostExact;
  if (integer <= kMostExact && product <= most && world <= most) return true;
  if (offset[axis] == 0) return step > step_at(product);
  return step > 2 * step_at(product) + step_at(world);
}

bool IntegerLattice::is_finite(int axis, double lo, double hi) const {
  return std::isfinite(to_world(axis, hi) - to_world(axis, lo));
}

bool IntegerLattice::isotropic(int dimensions) const {
  for (int k = 1; k < dimensions; ++k) {
    if (scale[k] != scale[0]) return false;
  }
  return true;
}

}  // namespace spillway::geometry
