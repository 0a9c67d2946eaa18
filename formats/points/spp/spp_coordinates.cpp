#include "formats/points/spp/spp_coordinates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spillway::formats {
namespace {

/// From here on doubles have no digits behind the point; added to a number below, it takes these.
constexpr double kNoFraction = 0x1p52;
constexpr double kLargestExact = 0x1p53;
constexpr std::uint64_t kLargestBits = std::numeric_limits<std::int64_t>::max();  // of no sign

bool is_integer(double value) {
  const bool in_range = value >= -kLargestExact && value <= kLargestExact;
  return static_cast<double>(static_cast<std::int64_t>(in_range ? value : 0.5)) == value;
}

/// Whether all are integers; it may also say no of some above 2^52. Without a comparison, so that
/// several are looked at in one step: the bits of numbers are in the order of their sizes, and
/// what is beyond the largest, or no number, reaches the highest bit.
bool are_surely_integers(std::span<const double> values) {
  std::uint64_t fractions = 0;
  std::uint64_t beyond = 0;
  for (const double value : values) {
    const double size = std::abs(value);
    const auto bits = std::bit_cast<std::uint64_t>(size);
    fractions |= std::bit_cast<std::uint64_t>((size + kNoFraction) - kNoFraction) ^ bits;
    beyond |= bits + (kLargestBits - std::bit_cast<std::uint64_t>(kLargestExact));
  }
  return fractions == 0 && beyond <= kLargestBits;
}

}  // namespace

std::size_t first_invalid_coordinate(std::span<const double> values, bool on_lattice) {
  if (on_lattice && are_surely_integers(values)) return values.size();
  const auto valid = [&](double v) { return on_lattice ? is_integer(v) : std::isfinite(v); };
  if (!on_lattice) {  // most often all are, so they are looked at without a branch first
    bool all = true;
    for (const double value : values) all &= std::isfinite(value);
    if (all) return values.size();
  }
  return std::find_if_not(values.begin(), values.end(), valid) - values.begin();
}

}  // namespace spillway::formats
