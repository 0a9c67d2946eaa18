#include "src/terrain/isolines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/error.h"

namespace spillway::terrain {
namespace {

constexpr std::int64_t kMostInTriangle = 1'000'000;
/// Numbers of levels stay exact in double.
constexpr double kLargestNumber = 0x1p52;

/// Where the level crosses the edge from one corner to another. The order in which they are given
/// does not matter. Zeros have no sign, so that equal places have equal bits.
Point<2> crossing_point(const Point<3>& one, const Point<3>& other, double height) {
  const auto& [a, b] = std::minmax(one, other);
  if (a[2] == height) return {a[0] + 0.0, a[1] + 0.0};
  if (b[2] == height) return {b[0] + 0.0, b[1] + 0.0};
  const double share = (height - a[2]) / (b[2] - a[2]);
  return {a[0] + share * (b[0] - a[0]) + 0.0, a[1] + share * (b[1] - a[1]) + 0.0};
}

Crossing crossing(const Corner& one, const Corner& other, std::int64_t level) {
  return {{std::min(one.number, other.number), std::max(one.number, other.number)}, level};
}

}  // namespace

Levels Levels::every(double interval, double base) {
  if (!(interval > 0) || !std::isfinite(interval) || !std::isfinite(base)) {
    throw InvalidArgument(
        fmt::format("levels every {} from {}: an interval is a number above 0, and "
                    "its base a finite one",
                    interval, base));
  }
  Levels levels;
  levels.interval_ = interval;
  levels.base_ = base;
  return levels;
}

Levels Levels::of_list(std::vector<double> heights) {
  const auto finite = [](double height) { return std::isfinite(height); };
  if (heights.empty() || !std::all_of(heights.begin(), heights.end(), finite)) {
    throw InvalidArgument("a list of levels needs at least one finite number");
  }
  Levels levels;
  levels.list_ = std::move(heights);
  std::sort(levels.list_.begin(), levels.list_.end());
  levels.list_.erase(std::unique(levels.list_.begin(), levels.list_.end()), levels.list_.end());
  for (double& height : levels.list_) height += 0.0;  // -0 becomes 0
  return levels;
}

double Levels::height(std::int64_t number) const {
  return interval_ == 0 ? list_[static_cast<std::size_t>(number)]
                        : base_ + static_cast<double>(number) * interval_;
}

bool Levels::is_index(std::int64_t number, std::uint64_t every) const {
  // Numbers are below 2^52 in size, so no other multiple of a larger one is among them.
  const auto period = static_cast<std::int64_t>(
      std::min(every, static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())));
  return interval_ != 0 && number % period == 0;
}

std::int64_t Levels::first_above(double low) const {
  if (interval_ == 0) {
    return std::upper_bound(list_.begin(), list_.end(), low) - list_.begin();
  }
  const double estimate = std::floor((low - base_) / interval_);
  if (!(std::abs(estimate) < kLargestNumber)) {
    throw Failure(
        fmt::format("the height {} is too far from level {} for an interval of {}: choose "
                    "a larger one",
                    low, base_, interval_),
        ErrorCode::kInvalidArgument);
  }
  // The quotient is rounded, so the number is found by the levels themselves.
  auto number = static_cast<std::int64_t>(estimate) - 1;
  for (; height(number) <= low; ++number) {
    if (height(number + 1) == height(number)) {
      throw Failure(
          fmt::format("{} is too small an interval: at height {} its levels cannot be told apart; "
                      "choose a larger one",
                      interval_, low),
          ErrorCode::kInvalidArgument);
    }
  }
  return number;
}

Levels::Range Levels::between(double low, double high) const {
  const Range range{first_above(low), first_above(high)};
  return {range.first, std::max(range.first, range.end)};
}

void append_segments(const std::array<Corner, 3>& corners, const Levels& levels,
                     std::vector<IsoSegment>& segments) {
  const auto [low, high] =
      std::minmax({corners[0].point[2], corners[1].point[2], corners[2].point[2]});
  const Levels::Range range = levels.between(low, high);
  if (range.end - range.first > kMostInTriangle) {
    throw Failure(
        fmt::format("a single triangle, from height {} to {}, crosses {} levels: choose a "
                    "larger interval",
                    low, high, range.end - range.first),
        ErrorCode::kInvalidArgument);
  }
  for (std::int64_t level = range.first; level < range.end; ++level) {
    const double height = levels.height(level);
    IsoSegment segment;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& here = corners[i];
      const Corner& next = corners[(i + 1) % 3];
      const bool above = here.point[2] >= height;
      if (above == (next.point[2] >= height)) continue;
      // Higher ground to the left: in over the edge that goes down, out over the one that goes up.
      (above ? segment.from : segment.to) = crossing(here, next, level);
      (above ? segment.from_point : segment.to_point) =
          crossing_point(here.point, next.point, height);
    }
    segments.push_back(segment);
  }
}

}  // namespace spillway::terrain
