#include "src/geometry/constructions/plate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/geometry/dimensions.h"

// With u half an ulp of 1, each result below has less than 32 roundings, of values that are at most
// as large as what the bounds are multiplied with: 64 u are enough for all of them, and 2^-46 is
// 128 u. Underflow is far below that, as kSmallest is added. A normal's length errs by less, too.

namespace spillway::geometry {
namespace {

constexpr double kError = 0x1p-46;
constexpr double kSmallest = 0x1p-500;

template <int D>
double dot(const Point<D>& a, const Point<D>& b) {
  double sum = 0;
  for (int k = 0; k < D; ++k) sum += a[k] * b[k];
  return sum;
}

/// The parts of a vector along a normal and across it, as absolute values; and how far off the two
/// may be.
struct Parts {
  double along = 0;
  double across = 0;
  double along_error = 0;
  double across_error = 0;
};

template <int D>
Parts parts_of(const Point<D>& vector, const Point<D>& normal) {
  const double squared = dot<D>(vector, vector);
  const double length = std::sqrt(squared);
  const double along = std::abs(dot<D>(vector, normal));
  const double rest = std::max(0.0, squared - along * along);
  Parts parts{.along = along, .across = std::sqrt(rest)};
  parts.along_error = kError * length + kSmallest;
  // Of the square of `across` it is kError * squared; its root is closer where `across` is large.
  const double slack = kError * squared;
  const double of_root = rest < slack ? std::sqrt(2 * slack) : slack / parts.across;
  parts.across_error = of_root + kError * length + kSmallest;
  return parts;
}

/// The larger one; what has overflowed is infinite.
double larger(double a, double b) {
  return b <= std::numeric_limits<double>::max() ? std::max(a, b)
                                                 : std::numeric_limits<double>::infinity();
}

}  // namespace

template <int D>
void Plate<D>::expand(const Plate& other) {
  Point<D> step;
  for (int k = 0; k < D; ++k) step[k] = other.centre[k] - centre[k];
  const Parts to = parts_of<D>(step, normal);
  const Parts lean = parts_of<D>(other.normal, normal);
  const double along = to.along + to.along_error +
                       (lean.along + lean.along_error) * other.thickness +
                       (lean.across + lean.across_error) * other.radius;
  const double distance = std::sqrt(dot<D>(step, step)) + other.radius;
  thickness = larger(thickness, along * (1 + kError) + kSmallest);
  radius = larger(radius, distance * (1 + kError) + kSmallest);
}

template <int D>
bool may_meet(const CertifiedBall<D>& ball, const Plate<D>& plate) {
  Point<D> to_ball;
  double size = 0;  // of the numbers that the vector is made of
  for (int k = 0; k < D; ++k) {
    const double shift = ball.anchor[k] - plate.centre[k];
    to_ball[k] = shift + ball.centre[k];
    size += std::abs(shift) + std::abs(ball.centre[k]);
  }
  const Parts parts = parts_of<D>(to_ball, plate.normal);
  const double off = D * ball.error + kError * size;
  const double beside = parts.along - parts.along_error - off - plate.thickness;
  const double beyond = parts.across - parts.across_error - off - plate.radius;
  double squared_distance = 0;
  if (beside > 0) squared_distance += beside * beside;
  if (beyond > 0) squared_distance += beyond * beyond;
  return !(squared_distance * (1 - kError) > ball.squared_radius);
}

template <int D>
bool may_meet(const HalfSpace<D>& half_space, const Plate<D>& plate) {
  const auto [beyond, error] = half_space.place_of(plate.centre);
  const Point<D>& normal = half_space.normal();
  const Parts parts = parts_of<D>(normal, plate.normal);
  double size = 0;
  for (const double magnitude : half_space.magnitude()) size += magnitude;
  const double reach = (parts.along + parts.along_error) * plate.thickness +
                       (parts.across + parts.across_error) * plate.radius +
                       kError * size * plate.radius;
  return !(beyond + error + reach * (1 + kError) < 0);
}

#define SPILLWAY_INSTANTIATE(D)                                        \
  template struct Plate<D>;                                            \
  template bool may_meet<D>(const CertifiedBall<D>&, const Plate<D>&); \
  template bool may_meet<D>(const HalfSpace<D>&, const Plate<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
