#include "stream/points/point_sample.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/delaunay/common/hash.h"

namespace spillway::stream {
namespace {

/// Points that span so much of the extent on every axis show the whole distribution.
constexpr double kNearlyAll = 0.9;
/// Most points that stand for those to come.
constexpr std::size_t kMostExpected = 1'000'000;

}  // namespace

void PointSample::add(std::span<const LatticePoint> points) {
  for (; next_ < first_ + points.size(); next_ += 1 + mix64(next_) % (2 * stride_ - 1)) {
    sample_.push_back(points[next_ - first_]);
  }
  first_ += points.size();
}

bool spans_extent(const Box<3>& box, const Box<3>& extent, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    if (box.extent(k) < kNearlyAll * extent.extent(k)) return false;
  }
  return true;
}

void append_expected_points(std::vector<LatticePoint>& sample, const Box<3>& seen,
                            const Box<3>& extent, int dimension, double more) {
  const auto wanted = static_cast<std::size_t>(
      std::min<double>(kMostExpected, more * static_cast<double>(sample.size())));
  sample.reserve(sample.size() + wanted);
  // Steps of a Kronecker sequence: M. Roberts, "The unreasonable effectiveness of quasirandom
  // sequences" (2018); the powers of the plastic number and of its equivalent in space.
  const std::array<double, 3> step =
      dimension == 2 ? std::array{0.7548776662466927, 0.5698402909980532, 0.0}
                     : std::array{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  std::size_t added = 0;
  for (std::size_t i = 1; added < wanted && i <= 4 * wanted; ++i) {
    LatticePoint point{};
    bool inside = true;
    for (int k = 0; k < dimension; ++k) {
      const double turns = step[k] * static_cast<double>(i);
      point[k] = extent.lo[k] + (turns - std::floor(turns)) * extent.extent(k);
      inside = inside && point[k] >= seen.lo[k] && point[k] <= seen.hi[k];
    }
    if (inside) continue;
    sample.push_back(point);
    ++added;
  }
}

}  // namespace spillway::stream
