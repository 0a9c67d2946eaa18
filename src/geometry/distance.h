#pragma once

#include <cmath>
#include <optional>

#include "src/geometry/point.h"
#include "src/geometry/strict_arithmetic.h"

namespace spillway::geometry {

namespace distance_stages {

/// Double arithmetic with an error bound; never answers 0. Each square, and the difference in it,
/// is off by less than 3u of itself (u = 2^-53), each sum by u more: so the two sums by less than
/// 6u of theirs, while nothing overflows and what underflow loses (2^-1070) is far below u.
template <int D>
std::optional<int> filtered(const Point<D>& place, const Point<D>& a, const Point<D>& b) {
  constexpr double kBound = 16 * 0x1p-53;
  constexpr double kSmallestSafe = 0x1p-900;
  constexpr double kLargestSafe = 0x1p1000;
  double to_a = 0, to_b = 0;
  for (int k = 0; k < D; ++k) {
    to_a += (a[k] - place[k]) * (a[k] - place[k]);
    to_b += (b[k] - place[k]) * (b[k] - place[k]);
  }
  const double sum = to_a + to_b;
  const double difference = to_a - to_b;
  if (!(sum > kSmallestSafe && sum < kLargestSafe)) return std::nullopt;
  if (std::abs(difference) <= kBound * sum) return std::nullopt;
  return difference > 0 ? 1 : -1;
}

/// By big integers. Throws Error if a coordinate is not finite.
template <int D>
int exact(const Point<D>& place, const Point<D>& a, const Point<D>& b);

}  // namespace distance_stages

/// The sign of |a - place| - |b - place|: -1 if `a` is nearer, 0 if both are equally far. Exact for
/// all finite doubles. Throws Failure if a coordinate is not finite.
template <int D>
int compare_distances(const Point<D>& place, const Point<D>& a, const Point<D>& b) {
  if (const auto answer = distance_stages::filtered<D>(place, a, b)) return *answer;
  return distance_stages::exact<D>(place, a, b);
}

}  // namespace spillway::geometry
