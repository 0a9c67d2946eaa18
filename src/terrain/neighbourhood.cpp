#include "src/terrain/neighbourhood.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace spillway::terrain {
namespace {

constexpr double kPercent = 100;

/// The cosine of the angle between the light and the normal, times the normal's length; from 0.
double towards_light(const Gradient& gradient, const Point<3>& light) {
  return std::max(0.0, light[2] - light[0] * gradient[0] - light[1] * gradient[1]);
}

double length_of_normal(const Gradient& gradient) {
  return std::sqrt(1 + gradient[0] * gradient[0] + gradient[1] * gradient[1]);
}

/// Goes on beyond `middle` as from `opposite`, where there is no height.
void extrapolate(float& height, float middle, float opposite) {
  if (!std::isfinite(height)) height = 2 * middle - opposite;
}

}  // namespace

void complete(Neighbourhood& z, const RasterEnd& end) {
  if ((end.north && end.south) || (end.west && end.east)) return;
  if (end.north || end.south) {
    const std::size_t beyond = end.north ? 0 : 6;
    const std::size_t opposite = 6 - beyond;
    for (const std::size_t row : {opposite, std::size_t{3}}) {
      if (end.west && !std::isfinite(z[row])) z[row] = z[row + 1];
      if (end.east && !std::isfinite(z[row + 2])) z[row + 2] = z[row + 1];
    }
    for (std::size_t c = 0; c < 3; ++c) extrapolate(z[beyond + c], z[3 + c], z[opposite + c]);
  } else if (end.west || end.east) {
    const std::size_t beyond = end.west ? 0 : 2;
    for (std::size_t r = 0; r < 9; r += 3) {
      extrapolate(z[r + beyond], z[r + 1], z[r + 2 - beyond]);
    }
  }
  for (float& height : z) {
    if (!std::isfinite(height)) height = z[4];
  }
}

float rounded_aspect_of(const Gradient& gradient) {
  if (gradient[0] == 0 && gradient[1] == 0) return std::numeric_limits<float>::quiet_NaN();
  const auto from_east =
      static_cast<float>(std::atan2(-gradient[1], -gradient[0]) * 180 / std::numbers::pi);
  const float from_north = (from_east > 90 ? 450 : 90) - from_east;
  return from_north < 360 ? from_north : 0;
}

double shade_of(const Gradient& gradient, const Point<3>& light_direction) {
  const double cosine = towards_light(gradient, light_direction) / length_of_normal(gradient);
  return 1 + 254 * std::min(cosine, 1.0);
}

MultiShade::MultiShade(double altitude)
    : sine_(std::sin(altitude * std::numbers::pi / 180)),
      cosine_(std::cos(altitude * std::numbers::pi / 180)) {}

double MultiShade::of(const Gradient& gradient) const {
  const double square = gradient[0] * gradient[0] + gradient[1] * gradient[1];
  if (square == 0) return 1 + 254 * sine_;
  constexpr double kRoot = std::numbers::sqrt2 / 2;
  // East and north of the lights.
  constexpr std::array<std::array<double, 2>, 4> kLights = {
      {{-kRoot, -kRoot}, {-1, 0}, {-kRoot, kRoot}, {0, 1}}};
  double sum = 0;
  for (const auto& [east, north] : kLights) {
    const double along = gradient[0] * east + gradient[1] * north;
    sum += along * along * towards_light(gradient, {cosine_ * east, cosine_ * north, sine_});
  }
  // The weights add up to twice the square.
  return 1 + 127 * sum / square / length_of_normal(gradient);
}

double roughness_of(const Neighbourhood& z) {
  const auto [lowest, highest] = std::minmax_element(z.begin(), z.end());
  return *highest - *lowest;
}

double ruggedness_of(const Neighbourhood& z) {
  double sum = 0;
  for (const float height : z) {
    const double difference = double{height} - z[4];
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

double position_of(const Neighbourhood& z) {
  double sum = 0;
  for (const float height : z) sum += double{z[4]} - height;
  return sum / 8;
}

CurvedSurface::CurvedSurface(const Neighbourhood& z, const Point<2>& sides, double factor) {
  const double x = sides[0];
  const double y = sides[1];
  const double centre = z[4];
  d_ = factor * ((double{z[3]} + z[5]) / 2 - centre) / (x * x);
  e_ = factor * ((double{z[1]} + z[7]) / 2 - centre) / (y * y);
  f_ = factor * (double{z[2]} - z[0] + z[6] - z[8]) / (4 * x * y);
  g_ = factor * (double{z[5]} - z[3]) / (2 * x);
  h_ = factor * (double{z[1]} - z[7]) / (2 * y);
}

double CurvedSurface::curvature() const { return -2 * (d_ + e_) * kPercent; }

double CurvedSurface::profile() const {
  const double square = g_ * g_ + h_ * h_;
  if (square == 0) return 0;
  return 2 * (d_ * g_ * g_ + e_ * h_ * h_ + f_ * g_ * h_) / square * kPercent;
}

double CurvedSurface::plan() const {
  const double square = g_ * g_ + h_ * h_;
  if (square == 0) return 0;
  return -2 * (d_ * h_ * h_ + e_ * g_ * g_ - f_ * g_ * h_) / square * kPercent;
}

}  // namespace spillway::terrain
