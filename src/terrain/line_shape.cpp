#include "src/terrain/line_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/geometry/predicates.h"

namespace spillway::terrain {
namespace {

/// How often points are moved to make a line smooth.
constexpr int kRounds = 10;

Point<2> between(const Point<2>& from, const Point<2>& to, double share) {
  return {from[0] + share * (to[0] - from[0]) + 0.0, from[1] + share * (to[1] - from[1]) + 0.0};
}

/// As far from one point towards the other as it is, but no farther than `distance`.
Point<2> towards(const Point<2>& from, const Point<2>& to, double distance) {
  const double whole = std::hypot(to[0] - from[0], to[1] - from[1]);
  return whole <= distance ? to : between(from, to, distance / whole);
}

/// The part of a portal that is no farther than `distance` from where it is passed.
Portal narrowed(const Portal& portal, double distance) {
  return {portal.at, towards(portal.at, portal.left, distance),
          towards(portal.at, portal.right, distance)};
}

double cross(const Point<2>& a, const Point<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

Point<2> minus(const Point<2>& a, const Point<2>& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// The place in a portal nearest to where the line from `before` to `behind` passes its edge, from
/// 0 at its right end to 1 at the left one; `now` if the line does not pass it in one point.
double straight_place(const Portal& portal, const Point<2>& before, const Point<2>& behind,
                      double now) {
  const Point<2> line = minus(behind, before);
  const double passes = cross(line, minus(portal.left, portal.right));
  if (!(passes > 0)) return now;
  return std::clamp(cross(line, minus(before, portal.right)) / passes, 0.0, 1.0);
}

/// The place of the point at which a portal is passed.
double place_of(const Portal& portal) {
  const Point<2> whole = minus(portal.left, portal.right);
  const std::size_t axis = std::abs(whole[0]) > std::abs(whole[1]) ? 0 : 1;
  if (whole[axis] == 0) return 0;
  return std::clamp((portal.at[axis] - portal.right[axis]) / whole[axis], 0.0, 1.0);
}

/// Next to an end, where lines of the same level may be, it is the end: a rounded point might be
/// on the other side of them.
Point<2> at_place(const Portal& portal, double place) {
  constexpr double kNear = 1e-6;
  if (place < kNear) return portal.right;
  return place > 1 - kNear ? portal.left : between(portal.right, portal.left, place);
}

/// Moves where portals are passed, by no more than `distance` each.
void smooth(std::vector<Portal>& portals, double distance, bool is_closed) {
  std::vector<Portal> parts;
  std::vector<double> places;
  for (const Portal& portal : portals) {
    parts.push_back(narrowed(portal, distance));
    places.push_back(place_of(parts.back()));
  }
  std::vector<double> moved = places;
  const std::size_t size = portals.size();
  const std::size_t first = is_closed ? 0 : 1;  // of a closed line the last is the first
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = first; i + 1 < size; ++i) {
      const Point<2>& before = portals[i > 0 ? i - 1 : size - 2].at;
      const double place = straight_place(parts[i], before, portals[i + 1].at, places[i]);
      moved[i] = (places[i] + place) / 2;
    }
    if (is_closed) moved.back() = moved.front();
    places = moved;
    for (std::size_t i = first; i + first < size; ++i)
      portals[i].at = at_place(parts[i], places[i]);
  }
}

/// Points of a funnel from its apex on, without it; those before `begin_` are passed.
class Chain {
 public:
  [[nodiscard]] bool empty() const { return begin_ == points_.size(); }
  [[nodiscard]] const Point<2>& front() const { return points_[begin_]; }
  [[nodiscard]] auto begin() const { return points_.begin() + static_cast<std::ptrdiff_t>(begin_); }
  [[nodiscard]] auto end() const { return points_.end(); }
  void push_back(const Point<2>& point) { points_.push_back(point); }
  void pop_front() {
    if (++begin_ == points_.size()) clear();
  }
  void pop_back() {
    points_.pop_back();
    if (begin_ == points_.size()) clear();
  }
  [[nodiscard]] const Point<2>& back() const { return points_.back(); }
  /// The point before the last one, or the apex.
  [[nodiscard]] const Point<2>& before_back(const Point<2>& apex) const {
    return points_.size() - begin_ > 1 ? points_[points_.size() - 2] : apex;
  }

 private:
  void clear() {
    points_.clear();
    begin_ = 0;
  }
  std::vector<Point<2>> points_;
  std::size_t begin_ = 0;
};

/// The shortest paths from its apex to the ends of the last portal: two chains that bend away from
/// each other.
class Funnel {
 public:
  explicit Funnel(const Point<2>& apex) : path_{apex} {}

  void add(const Portal& portal) {
    add(portal.left, left_, right_, 1);
    add(portal.right, right_, left_, -1);
  }

  /// The shortest path to a point in or behind the last portal.
  std::vector<Point<2>> path_to(const Point<2>& end) && {
    add(end, left_, right_, 1);
    path_.insert(path_.end(), left_.begin(), left_.end());
    return std::move(path_);
  }

 private:
  /// `side`: 1 if the chain is the left one, -1 if it is the right one.
  void add(const Point<2>& point, Chain& chain, Chain& other, int side) {
    while (!chain.empty() &&
           side * orientation<2>({chain.before_back(path_.back()), chain.back(), point}) <= 0) {
      chain.pop_back();
    }
    while (chain.empty() && !other.empty() &&
           side * orientation<2>({path_.back(), other.front(), point}) < 0) {
      path_.push_back(other.front());
      other.pop_front();
    }
    chain.push_back(point);
  }

  std::vector<Point<2>> path_;  ///< what is certain of it; its end is the apex
  Chain left_;
  Chain right_;
};

}  // namespace

std::vector<Point<2>> shaped_line(std::span<const Portal> portals, const LineTolerance& tolerance) {
  std::vector<Portal> passed(portals.begin(), portals.end());
  const bool is_closed = portals.size() > 1 && portals.front() == portals.back();
  if (tolerance.smooth > 0) smooth(passed, tolerance.smooth, is_closed);
  if (tolerance.simplify > 0) {
    Funnel funnel(passed.front().at);
    for (std::size_t i = 1; i + 1 < passed.size(); ++i) {
      funnel.add(narrowed(passed[i], tolerance.simplify));
    }
    return std::move(funnel).path_to(passed.back().at);
  }
  std::vector<Point<2>> points;
  points.reserve(passed.size());
  for (const Portal& portal : passed) points.push_back(portal.at);
  return points;
}

}  // namespace spillway::terrain
