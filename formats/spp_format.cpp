#include "formats/spp_format.h"

#include <algorithm>
#include <cmath>

namespace spillway {
namespace {

constexpr double kLargestExact = 9007199254740992.0;  // 2^53

bool is_integer(double value) {
  const bool in_range = value >= -kLargestExact && value <= kLargestExact;
  return static_cast<double>(static_cast<std::int64_t>(in_range ? value : 0.5)) == value;
}

/// The place of the first value that is not valid. Most often there is none, so all are looked at
/// without a branch first.
template <typename Valid>
std::size_t first_invalid(std::span<const double> values, Valid valid) {
  bool all = true;
  for (const double value : values) all &= valid(value);
  if (all) return values.size();
  return std::find_if_not(values.begin(), values.end(), valid) - values.begin();
}

}  // namespace

std::size_t first_invalid_coordinate(std::span<const double> values, bool on_lattice) {
  if (on_lattice) return first_invalid(values, is_integer);
  return first_invalid(values, [](double value) { return std::isfinite(value); });
}

}  // namespace spillway
