// The exact stages of what is computed from coordinates, in one file because big integers compile
// slowly.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "src/geometry/big_integer.h"
#include "src/geometry/constructions/barycentric.h"
#include "src/geometry/constructions/circumcentre.h"
#include "src/geometry/determinants.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/distance.h"

namespace spillway::geometry {
namespace {

template <int D>
using BigVector = std::array<BigInt, D>;

template <int D>
BigVector<D> difference(const CommonScale& scale, const Point<D>& a, const Point<D>& b) {
  BigVector<D> v;
  for (int k = 0; k < D; ++k) v[k] = scale.integer(a[k]) - scale.integer(b[k]);
  return v;
}

/// numerator / denominator * 2^exponent, rounded to the nearest double unless that is subnormal,
/// where it may be the one beside it.
double rounded_quotient(BigInt numerator, BigInt denominator, int exponent) {
  if (numerator == 0) return 0;
  const bool negative = (numerator < 0) != (denominator < 0);
  numerator = abs(numerator);
  denominator = abs(denominator);
  // So that the quotient has 63 or 64 bits.
  const int shift = 63 - static_cast<int>(msb(numerator)) + static_cast<int>(msb(denominator));
  if (shift > 0) {
    numerator <<= shift;
  } else {
    denominator <<= -shift;
  }
  BigInt quotient, remainder;
  divide_qr(numerator, denominator, quotient, remainder);
  auto bits = static_cast<std::uint64_t>(quotient);
  if (remainder != 0) bits |= 1;  // decides ties; far below the last bit that stays
  const double value = std::ldexp(static_cast<double>(bits), exponent - shift);
  return negative ? -value : value;
}

}  // namespace

template <int D>
int distance_stages::exact(const Point<D>& place, const Point<D>& a, const Point<D>& b) {
  CommonScale scale;
  scale.include_point(place);
  scale.include_point(a);
  scale.include_point(b);
  const BigInt to_a = squared_length(difference<D>(scale, a, place));
  const BigInt to_b = squared_length(difference<D>(scale, b, place));
  return to_a > to_b ? 1 : to_a < to_b ? -1 : 0;
}

// In its plane, as a sum of two edges.
Point<3> exact_circle_centre(const std::array<Point<3>, 3>& triangle) {
  CommonScale scale;
  for (const Point<3>& p : triangle) scale.include_point(p);
  const BigVector<3> a = difference<3>(scale, triangle[1], triangle[0]);
  const BigVector<3> b = difference<3>(scale, triangle[2], triangle[0]);
  const BigInt aa = squared_length(a);
  const BigInt bb = squared_length(b);
  BigInt ab = 0;
  for (int k = 0; k < 3; ++k) ab += a[k] * b[k];
  const BigInt denominator = 2 * (aa * bb - ab * ab);
  Point<3> centre;
  centre.fill(std::numeric_limits<double>::infinity());
  if (denominator == 0) return centre;
  const BigInt of_a = bb * (aa - ab);
  const BigInt of_b = aa * (bb - ab);
  for (int k = 0; k < 3; ++k) {
    const BigInt relative = of_a * a[k] + of_b * b[k];
    const BigInt numerator = relative + scale.integer(triangle[0][k]) * denominator;
    centre[k] = rounded_quotient(numerator, denominator, scale.exponent());
  }
  return centre;
}

// By Cramer's rule on 2 (p_i - p_0) . c = |p_i - p_0|^2.
template <int D>
Point<D> exact_circumcentre(const std::array<Point<D>, D + 1>& simplex) {
  CommonScale scale;
  for (const Point<D>& p : simplex) scale.include_point(p);
  Vectors<D, D, BigInt> rows;
  for (int i = 0; i < D; ++i) rows[i] = difference<D>(scale, simplex[i + 1], simplex[0]);
  const BigInt denominator = 2 * orientation_determinant<D>(rows);
  Point<D> centre;
  for (int k = 0; k < D; ++k) {
    Vectors<D, D, BigInt> replaced = rows;
    for (int i = 0; i < D; ++i) replaced[i][k] = squared_length(rows[i]);
    const BigInt relative = orientation_determinant<D>(replaced);
    const BigInt numerator = relative + scale.integer(simplex[0][k]) * denominator;
    centre[k] = rounded_quotient(numerator, denominator, scale.exponent());
  }
  return centre;
}

template <int D>
std::array<double, D + 1> exact_barycentric_coordinates(const std::array<Point<D>, D + 1>& simplex,
                                                        const Point<D>& place) {
  CommonScale scale;
  scale.include_point(place);
  for (const Point<D>& p : simplex) scale.include_point(p);
  Vectors<D, D + 1, BigInt> v;
  for (int i = 0; i <= D; ++i) v[i] = difference<D>(scale, simplex[i], place);
  const auto weights = barycentric_determinants<D>(v);
  BigInt sum = 0;
  for (const BigInt& weight : weights) sum += weight;
  std::array<double, D + 1> coordinates;
  for (int i = 0; i <= D; ++i) coordinates[i] = rounded_quotient(weights[i], sum, 0);
  return coordinates;
}

#define SPILLWAY_INSTANTIATE(D)                                                              \
  template int distance_stages::exact<D>(const Point<D>&, const Point<D>&, const Point<D>&); \
  template Point<D> exact_circumcentre<D>(const std::array<Point<D>, D + 1>&);               \
  template std::array<double, D + 1> exact_barycentric_coordinates<D>(                       \
      const std::array<Point<D>, D + 1>&, const Point<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
