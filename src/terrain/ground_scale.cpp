#include "src/terrain/ground_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spillway::terrain {

Point<2> lengths_at(const GroundScale& scale, double y) {
  if (scale.degrees == 0) return {1, 1};
  constexpr double kLeastCosine = 1e-9;  // a pole has no east
  const double radians = scale.degrees * std::numbers::pi / 180;
  const double sine = std::sin(y * radians);
  const double cosine = std::max(std::abs(std::cos(y * radians)), kLeastCosine);
  const double eccentricity = scale.flattening * (2 - scale.flattening);  // its square
  const double root = std::sqrt(1 - eccentricity * sine * sine);
  const double across = scale.semi_major / root;
  const double along = across * (1 - eccentricity) / (root * root);
  return {across * cosine * radians, along * radians};
}

}  // namespace spillway::terrain
