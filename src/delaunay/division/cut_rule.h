#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "src/delaunay/division/cut.h"
#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Points of which no more is known than the box that they lie in, evenly for all one knows.
template <int D>
struct CountedBox {
  Box<D> box;
  double count = 0;
};

/// What is known of points that are to be cut in two.
template <int D>
struct PointsToCut {
  /// Some of them, in any order, which rules may change; each stands for `weight` points.
  std::span<Point<D>> sample{};
  double weight = 1;
  std::span<const CountedBox<D>> boxes{};  ///< of the points that are not sampled
  Box<D> box{};                            ///< around all of them, or around the sample
  CutShare share{};                        ///< how much is to lie below, about
  std::size_t count = 0;                   ///< how many there are, for rules that ask
  std::size_t depth = 0;                   ///< cuts that have led to them
};

/// A rule that says where to cut points: whoever divides points, in memory, into tiles, by plans or
/// among ranks, asks one. For any thread.
template <int D>
class CutRule {
 public:
  virtual ~CutRule() = default;

  /// Where to cut; nothing if no cut pays. Some of the sample, if there is one, are not below the
  /// cut; those that are below may be none, as where all points are equal.
  [[nodiscard]] virtual std::optional<Cut> choose(const PointsToCut<D>& points) const = 0;

  /// The rules for what is below and for what is not, where they are others: a rule may know more
  /// of the points than it is told.
  [[nodiscard]] virtual std::array<std::unique_ptr<CutRule>, 2> for_sides(
      const Cut& /*cut*/) const {
    return {};
  }
};

/// The value of `axis` that has about the share of a sample below it. The sample has points.
template <int D>
double value_at(std::span<Point<D>> sample, int axis, const CutShare& share) {
  const auto place = sample.begin() + static_cast<std::ptrdiff_t>(share.of(sample.size()));
  std::nth_element(sample.begin(), place, sample.end(),
                   [axis](const Point<D>& a, const Point<D>& b) { return a[axis] < b[axis]; });
  return (*place)[axis];
}

}  // namespace spillway::delaunay
