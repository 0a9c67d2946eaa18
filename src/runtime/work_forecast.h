#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/rooms.h"

namespace spillway::runtime {

/// What the triangulation of some points has made.
struct SampleSize {
  std::size_t points = 0;
  std::size_t simplices = 0;
};

/// What a triangulation will take, by what samples of its points have made.
struct WorkForecast {
  double points = 1;    ///< of the larger sample
  double bytes = 0;     ///< that it took
  double exponent = 2;  ///< of the bytes, as a power of the points

  /// By two samples in so many dimensions, where a simplex takes so many bytes.
  static WorkForecast of(const SampleSize& smaller, const SampleSize& larger, int dimension,
                         double simplex_bytes) {
    // There are at most about as many simplices as this power of the points (McMullen's upper bound
    // theorem). In a small sample relatively many of them are on the hull, and it seems less than
    // it is.
    const double most = (dimension + 1) / 2;  // NOLINT(bugprone-integer-division): rounded down
    constexpr double kHull = 0.1;
    WorkForecast forecast{.points = static_cast<double>(larger.points),
                          .bytes = static_cast<double>(larger.simplices) * simplex_bytes};
    if (larger.points > smaller.points && smaller.points > 0 && smaller.simplices > 0) {
      const auto ratio = [](std::size_t now, std::size_t before) {
        return std::log(static_cast<double>(now) / static_cast<double>(before));
      };
      forecast.exponent = std::clamp(
          ratio(larger.simplices, smaller.simplices) / ratio(larger.points, smaller.points) + kHull,
          1.0, most);
    }
    return forecast;
  }

  [[nodiscard]] double bytes_for(double all_points) const {
    return bytes * std::pow(std::max(1.0, all_points / points), exponent);
  }
};

}  // namespace spillway::runtime
