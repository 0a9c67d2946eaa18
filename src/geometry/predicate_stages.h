#pragma once
// The first stages of the predicates, each of which is right or says nothing: the filter (floating
// point), and the exact stage (128-bit integers, else big integers). predicates.cpp tries one after
// the other and adds the symbolic stage; tests compare them. Bounds are derived in
// docs/algorithm-predicates.md.
//
// A predicate P (Orientation<D> or InSphere<D>) is a determinant of differences of points.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "src/geometry/determinants.h"

namespace spillway::geometry::stages {

/// Unit roundoff of double: half a unit in the last place of 1.
inline constexpr double kRoundoff = 0x1p-53;

/// Largest coordinate differences between which filters are proved: within, no intermediate result
/// overflows, and what underflow loses is negligible.
template <int D>
inline constexpr double kSmallestSafe = D <= 4 ? 0x1p-150 : 0x1p-120;
template <int D>
inline constexpr double kLargestSafe = 1 / kSmallestSafe<D>;

constexpr std::int64_t factorial(int n) { return n <= 1 ? 1 : n * factorial(n - 1); }

/// The largest power of two such that a polynomial of so many monomials, all of this degree in
/// numbers that are no larger, fits 128 bits, whatever the order in which it is summed up.
constexpr double largest_integer(int degree, std::int64_t monomials) {
  const int bits = (127 - std::bit_width(static_cast<std::uint64_t>(monomials))) / degree;
  return static_cast<double>(std::int64_t{1} << bits);
}

/// Roundings that a monomial of the orientation determinant goes through: those of its D
/// differences, its products, and the sums of minors it is part of; one more is for the bound's.
template <int D>
inline constexpr int kOrientationRoundings = 2 * D - 1 + D*(D - 1) / 2 + 1;

__extension__ using Int128 = __int128;

template <std::size_t D>
double product(const std::array<double, D>& factors) {
  double result = factors[0] * factors[1];
  for (std::size_t k = 2; k < D; ++k) result *= factors[k];
  return result;
}

/// Orientation of points p0, ..., pD: differences are taken to p0.
template <int D>
struct Orientation {
  static constexpr int kDimension = D;
  static constexpr int kVectors = D;
  static constexpr int kOrigin = 0;
  /// Differences up to this size fit the determinant into 128 bits.
  static constexpr double kLargestInteger = largest_integer(D, factorial(D));

  template <typename T>
  static T determinant(const Vectors<D, D, T>& v) {
    return orientation_determinant<D>(v);
  }
  /// The filter's error bound, from the largest difference along each axis.
  static double error_bound(const std::array<double, D>& m) {
    return factorial(D) * kOrientationRoundings<D> * kRoundoff * product(m);
  }
};

/// In-sphere test of points p0, ..., pD and the query p(D+1): differences are taken to the query.
template <int D>
struct InSphere {
  static constexpr int kDimension = D;
  static constexpr int kVectors = D + 1;
  static constexpr int kOrigin = D + 1;
  static constexpr double kLargestInteger = largest_integer(D + 2, D* factorial(D + 1));
  /// Besides those, a monomial has the squared length, the product with it, and the last sum.
  static constexpr int kRoundings = kOrientationRoundings<D> + 2 * D + 3;

  template <typename T>
  static T determinant(const Vectors<D, D + 1, T>& v) {
    return in_sphere_determinant<D>(v);
  }
  static double error_bound(const std::array<double, D>& m) {
    return factorial(D + 1) * kRoundings * kRoundoff * (product(m) * squared_length(m));
  }
};

/// The points of one evaluation: the predicate's vectors plus their origin.
template <typename P>
using Points = std::array<Point<P::kDimension>, P::kVectors + 1>;

template <typename T>
int sign(const T& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// The number of the point that becomes vector i.
template <typename P>
constexpr int source(int i) {
  return P::kOrigin == 0 ? i + 1 : i;
}

/// Stage 1: double arithmetic with an error bound. Never answers 0.
template <typename P>
std::optional<int> filtered(const Points<P>& points) {
  constexpr int D = P::kDimension;
  Vectors<D, P::kVectors, double> v;
  std::array<double, D> largest{};
  for (int i = 0; i < P::kVectors; ++i) {
    for (int k = 0; k < D; ++k) {
      v[i][k] = points[source<P>(i)][k] - points[P::kOrigin][k];
      largest[k] = std::max(largest[k], std::abs(v[i][k]));
    }
  }
  for (int k = 0; k < D; ++k) {
    if (!(largest[k] >= kSmallestSafe<D> && largest[k] <= kLargestSafe<D>)) return std::nullopt;
  }
  const double determinant = P::determinant(v);
  const double bound = P::error_bound(largest);
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return std::nullopt;
}

/// Whether difference == a - b without any rounding.
inline bool exact_difference(double a, double b, double difference) {
  const double b_rounded = a - difference;
  const double a_rounded = difference + b_rounded;
  return (a - a_rounded) + (b_rounded - b) == 0;
}

/// Stage 2: exact, for differences that are small enough integers, as those of LiDAR lattices are.
template <typename P>
std::optional<int> integer(const Points<P>& points) {
  constexpr int D = P::kDimension;
  Vectors<D, P::kVectors, Int128> v;
  for (int i = 0; i < P::kVectors; ++i) {
    for (int k = 0; k < D; ++k) {
      const double a = points[source<P>(i)][k];
      const double b = points[P::kOrigin][k];
      const double difference = a - b;
      if (!(std::abs(difference) <= P::kLargestInteger)) return std::nullopt;
      const auto whole = static_cast<std::int64_t>(difference);
      if (static_cast<double>(whole) != difference) return std::nullopt;
      if (!exact_difference(a, b, difference)) return std::nullopt;
      v[i][k] = whole;
    }
  }
  return sign(P::determinant(v));
}

/// Stage 3: exact for all finite doubles, by big integers. Throws Failure if a coordinate is not
/// finite.
template <typename P>
int exact(const Points<P>& points);

}  // namespace spillway::geometry::stages
