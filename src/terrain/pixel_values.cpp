#include "src/terrain/pixel_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace spillway::terrain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Differences of products that lose more than this share to cancellation are computed again.
constexpr double kCancellation = 0x1p-20;

/// a * b - c * d, off by some roundings of the result (Kahan; Jeannerod, Louvet, Muller, "Further
/// analysis of Kahan's algorithm for the accurate computation of 2x2 determinants", 2013).
double difference_of_products(double a, double b, double c, double d) {
  const double first = a * b;
  const double second = c * d;
  const double difference = first - second;
  if (std::abs(difference) > kCancellation * std::max(std::abs(first), std::abs(second))) {
    return difference;
  }
  return std::fma(a, b, -second) + std::fma(-c, d, second);
}

/// The height on the edge from `a` to `b`, measured along its longer side.
double on_edge(const Point<3>& a, const Point<3>& b, double x, double y) {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double share = dx >= std::abs(dy) ? (x - a[0]) / dx : (y - a[1]) / dy;
  const auto [lowest, highest] = std::minmax(a[2], b[2]);
  return std::clamp(a[2] + (b[2] - a[2]) * share, lowest, highest);
}

}  // namespace

TrianglePlane::TrianglePlane(const Triangle& canonical, const Point<2>& scale)
    : corners_(canonical), scale_(scale) {
  std::array<Point<3>, 2> to;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) to[i][k] = canonical[i + 1][k] - canonical[0][k];
  }
  const double area = difference_of_products(to[0][0], to[1][1], to[1][0], to[0][1]);
  gradient_[0] = difference_of_products(to[0][2], to[1][1], to[1][2], to[0][1]) / area;
  gradient_[1] = difference_of_products(to[0][0], to[1][2], to[1][0], to[0][2]) / area;
  lowest_ = std::min({canonical[0][2], canonical[1][2], canonical[2][2]});
  highest_ = std::max({canonical[0][2], canonical[1][2], canonical[2][2]});
}

double TrianglePlane::at(TriangleRelation relation, double x, double y) const {
  switch (relation) {
    case TriangleRelation::kInside:
      return inside(x, y);
    case TriangleRelation::kEdge01:
      return on_edge(corners_[0], corners_[1], x, y);
    case TriangleRelation::kEdge02:
      return on_edge(corners_[0], corners_[2], x, y);
    case TriangleRelation::kEdge12:
      return on_edge(corners_[1], corners_[2], x, y);
    case TriangleRelation::kCorner0:
      return corners_[0][2];
    case TriangleRelation::kCorner1:
      return corners_[1][2];
    case TriangleRelation::kCorner2:
      return corners_[2][2];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double slope_of(const Gradient& gradient) {
  return std::atan(std::hypot(gradient[0], gradient[1])) / kDegree;
}

double aspect_of(const Gradient& gradient) {
  if (gradient[0] == 0 && gradient[1] == 0) return std::numeric_limits<double>::quiet_NaN();
  const double degrees = std::atan2(-gradient[0], -gradient[1]) / kDegree;
  const double turned = degrees < 0 ? degrees + 360 : degrees;
  // Due north is 0: neither -0, as the arc tangent has it, nor 360.
  return turned > 0 && static_cast<float>(turned) < 360 ? turned : 0;
}

Point<3> direction_of(const Light& light) {
  const double azimuth = light.azimuth * kDegree;
  const double altitude = light.altitude * kDegree;
  return {std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth),
          std::sin(altitude)};
}

double hillshade_of(const Gradient& gradient, const Point<3>& light_direction) {
  const double towards_light =
      light_direction[2] - light_direction[0] * gradient[0] - light_direction[1] * gradient[1];
  const double cosine =
      towards_light / std::sqrt(1 + gradient[0] * gradient[0] + gradient[1] * gradient[1]);
  return 255 * std::clamp(cosine, 0.0, 1.0) + 0.0;  // a sum of zeros is 0, not -0
}

}  // namespace spillway::terrain
