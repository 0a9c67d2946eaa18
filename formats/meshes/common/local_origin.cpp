#include "formats/meshes/common/local_origin.h"

#include <cmath>
#include <limits>

namespace spillway::formats {
namespace {

constexpr int kDigits = 9;

double rounded(double coordinate) {
  const double whole = std::round(coordinate);
  if (std::abs(whole) < std::pow(10.0, kDigits)) return whole + 0.0;  // no negative zero
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(whole))) - (kDigits - 1));
  const double result = std::round(whole / step) * step;
  return std::isfinite(result) ? result : 0.0;
}

}  // namespace

WorldPoint local_origin(const WorldPoint& vertex) {
  return {rounded(vertex[0]), rounded(vertex[1]), rounded(vertex[2])};
}

std::optional<std::array<float, 3>> to_local(const WorldPoint& vertex, const WorldPoint& origin) {
  std::array<float, 3> local{};
  for (int axis = 0; axis < 3; ++axis) {
    const double difference = vertex[axis] - origin[axis];
    if (!(std::abs(difference) <= std::numeric_limits<float>::max())) return std::nullopt;
    local[axis] = static_cast<float>(difference);
  }
  return local;
}

}  // namespace spillway::formats
