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
/// How far a portal reaches of the way to the next level: less than a half, so that there is
/// something between the portals of two levels.
constexpr double kTowardsNext = 0.45;
/// And to the end of its edge, so that there is something between portals of the same level there.
constexpr double kTowardsEnd = 0.9;
/// Numbers of levels stay exact in double.
constexpr double kLargestNumber = 0x1p52;

/// The end of a portal on the side of an edge's end: `rise` is the height from the crossing to
/// there, `most` how much of it the portal may have.
Point<2> portal_end(const Point<2>& at, const Point<3>& end, double rise, double most,
                    double slide) {
  if (!(rise > 0)) return at;
  const Point<2> way = {end[0] - at[0], end[1] - at[1]};
  const double length = std::hypot(way[0], way[1]);
  if (!(length > 0)) return at;
  const double share = std::min({kTowardsEnd, most / rise, slide / length});
  return {at[0] + share * way[0] + 0.0, at[1] + share * way[1] + 0.0};
}

/// The portal of a level on an edge, of which the first end is above it and the other one below.
Portal portal_at(const Point<3>& above, const Point<3>& below, double height, double most,
                 double slide) {
  Portal portal;
  portal.at = portal.left = portal.right = crossing_point(above, below, height);
  if (slide > 0) {
    portal.left = portal_end(portal.at, above, above[2] - height, most, slide);
    portal.right = portal_end(portal.at, below, height - below[2], most, slide);
  }
  return portal;
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

bool Levels::has(std::int64_t number) const {
  return interval_ != 0 || (number >= 0 && number < static_cast<std::int64_t>(list_.size()));
}

double Levels::distance_to_next(std::int64_t number) const {
  double distance = std::numeric_limits<double>::infinity();
  const double here = height(number);
  if (has(number - 1)) distance = here - height(number - 1);
  if (has(number + 1)) distance = std::min(distance, height(number + 1) - here);
  return distance;
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

// Zeros have no sign, so that equal places have equal bits.
Point<2> crossing_point(const Point<3>& one, const Point<3>& other, double height) {
  const auto& [a, b] = std::minmax(one, other);
  if (a[2] == height) return {a[0] + 0.0, a[1] + 0.0};
  if (b[2] == height) return {b[0] + 0.0, b[1] + 0.0};
  const double share = (height - a[2]) / (b[2] - a[2]);
  return {a[0] + share * (b[0] - a[0]) + 0.0, a[1] + share * (b[1] - a[1]) + 0.0};
}

void append_segments(const std::array<Corner, 3>& corners, const Levels& levels, double slide,
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
    const double most = slide > 0 ? kTowardsNext * levels.distance_to_next(level) : 0;
    IsoSegment segment;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& here = corners[i];
      const Corner& next = corners[(i + 1) % 3];
      const bool above = here.point[2] >= height;
      if (above == (next.point[2] >= height)) continue;
      // Higher ground to the left: in over the edge that goes down, out over the one that goes up.
      (above ? segment.from : segment.to) = crossing(here, next, level);
      (above ? segment.from_portal : segment.to_portal) =
          portal_at((above ? here : next).point, (above ? next : here).point, height, most, slide);
    }
    segments.push_back(segment);
  }
}

}  // namespace spillway::terrain
