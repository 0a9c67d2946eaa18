#include "src/terrain/polygon_edges.h"

#include <algorithm>
#include <utility>

#include "src/geometry/predicates.h"

namespace spillway::terrain {
namespace {

/// Edges of a strip, on average, if each lay in one.
constexpr std::size_t kEdgesOfStrip = 4;
/// In how many strips an edge may be, on average: tall edges make for fewer strips.
constexpr std::size_t kMostStripsOfEdge = 8;

/// Above 0: `place` is to the left of the line from a to b.
int side_of(const Point<2>& a, const Point<2>& b, const Point<2>& place) {
  return orientation<2>({a, b, place});
}

double cross(const Point<2>& u, const Point<2>& v) { return u[0] * v[1] - u[1] * v[0]; }

Point<2> difference(const Point<2>& a, const Point<2>& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// Where an edge crosses a segment, both from their lesser end to the other: on the edge, and
/// exactly so if that is level or upright.
Point<2> crossing_of(const Point<2>& low, const Point<2>& high, const Point<2>& a,
                     const Point<2>& b) {
  const Point<2> along = difference(b, a);
  const Point<2> edge = difference(high, low);
  const double share = cross(difference(a, low), along) / cross(edge, along);
  if (!(share >= 0 && share <= 1)) return share < 0 ? low : high;  // where rounding leaves nothing
  return {low[0] + edge[0] * share, low[1] + edge[1] * share};
}

Point<2> middle_of(const Point<2>& a, const Point<2>& b) {
  return {a[0] + (b[0] - a[0]) / 2, a[1] + (b[1] - a[1]) / 2};
}

bool is_between(const Point<2>& a, const Point<2>& b, const Point<2>& place) {
  const auto between = [&](int k) {
    return std::min(a[k], b[k]) <= place[k] && place[k] <= std::max(a[k], b[k]);
  };
  return between(0) && between(1);
}

}  // namespace

Box<2> box_of_line(std::span<const Point<2>> line) {
  Box<2> box;
  for (const Point<2>& point : line) box.expand(point);
  return box;
}

PolygonEdges::PolygonEdges(std::span<const std::vector<Point<2>>> rings) {
  for (const std::vector<Point<2>>& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point<2>& from = ring[i];
      const Point<2>& to = ring[(i + 1) % ring.size()];
      box_.expand(from);
      if (from == to) continue;
      const bool rises = std::pair(from[1], from[0]) < std::pair(to[1], to[0]);
      edges_.push_back(rises ? Edge{from, to} : Edge{to, from});
    }
  }
  strips_ = std::max<std::size_t>(edges_.size() / kEdgesOfStrip, 1);
  const auto entries = [&] {
    std::size_t sum = 0;
    for (const auto& [low, high] : edges_) sum += strip_of(high[1]) - strip_of(low[1]) + 1;
    return sum;
  };
  while (strips_ > 1 && entries() > kMostStripsOfEdge * edges_.size()) strips_ /= 2;
  std::vector<std::size_t> counts(strips_ + 1);
  const auto for_each_strip = [&](const auto& act) {
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      const std::size_t last = strip_of(edges_[e].high[1]);
      for (std::size_t s = strip_of(edges_[e].low[1]); s <= last; ++s) act(s, e);
    }
  };
  for_each_strip([&](std::size_t s, std::uint32_t /*edge*/) { ++counts[s + 1]; });
  for (std::size_t s = 0; s < strips_; ++s) counts[s + 1] += counts[s];
  first_of_strip_ = counts;
  edges_of_strips_.resize(counts.back());
  for_each_strip([&](std::size_t s, std::uint32_t edge) { edges_of_strips_[counts[s]++] = edge; });
}

/// Of what lies beyond the box, the outermost strip.
std::size_t PolygonEdges::strip_of(double y) const {
  const double height = box_.hi[1] - box_.lo[1];
  if (!(height > 0)) return 0;
  const double strip = (y - box_.lo[1]) / height * static_cast<double>(strips_);
  return static_cast<std::size_t>(std::clamp(strip, 0.0, static_cast<double>(strips_ - 1)));
}

bool PolygonEdges::contains(const Point<2>& place) const {
  if (!box_.contains(place)) return false;
  bool is_inside = false;
  for (const std::uint32_t e : strip(strip_of(place[1]))) {
    const auto& [low, high] = edges_[e];
    if (place[1] < low[1] || place[1] >= high[1]) continue;
    if (side_of(low, high, place) <= 0) is_inside = !is_inside;  // the edge is west of it
  }
  return is_inside;
}

/// Appends where the inner part of a segment has a place on an edge, in order. Returns whether an
/// edge has a place on the segment, with its ends.
bool PolygonEdges::find_crossings(const Point<2>& from, const Point<2>& to,
                                  std::vector<Point<2>>& crossings) const {
  for (int k = 0; k < 2; ++k) {
    if (std::max(from[k], to[k]) < box_.lo[k] || std::min(from[k], to[k]) > box_.hi[k]) {
      return false;
    }
  }
  const std::size_t before = crossings.size();
  bool touches = false;
  const auto& [a, b] = from < to ? std::pair(from, to) : std::pair(to, from);
  const auto add = [&](const Point<2>& place) {
    touches = true;
    if (place != from && place != to) crossings.push_back(place);
  };
  const std::size_t first = strip_of(std::min(a[1], b[1]));
  const std::size_t last = strip_of(std::max(a[1], b[1]));
  for (std::size_t s = first; s <= last; ++s) {
    for (const std::uint32_t e : strip(s)) {
      const auto& [low, high] = edges_[e];
      if (s != std::max(first, strip_of(low[1]))) continue;  // had it in an earlier strip
      if (std::max(low[0], high[0]) < a[0] || std::min(low[0], high[0]) > b[0]) continue;
      const int side_of_a = side_of(low, high, a);
      const int side_of_b = side_of(low, high, b);
      if (side_of_a * side_of_b > 0) continue;
      const int side_of_low = side_of(a, b, low);
      const int side_of_high = side_of(a, b, high);
      if (side_of_low * side_of_high > 0) continue;
      if (side_of_low == 0 && is_between(a, b, low)) add(low);
      if (side_of_high == 0 && is_between(a, b, high)) add(high);
      if (side_of_a == 0 && is_between(low, high, a)) add(a);
      if (side_of_b == 0 && is_between(low, high, b)) add(b);
      if (side_of_a * side_of_b < 0 && side_of_low * side_of_high < 0) {
        add(crossing_of(low, high, a, b));
      }
    }
  }
  const auto along = [&](const Point<2>& place) {
    return (place[0] - from[0]) * (to[0] - from[0]) + (place[1] - from[1]) * (to[1] - from[1]);
  };
  std::sort(crossings.begin() + static_cast<std::ptrdiff_t>(before), crossings.end(),
            [&](const Point<2>& p, const Point<2>& q) {
              return std::pair(along(p), p) < std::pair(along(q), q);
            });
  return touches;
}

void PolygonEdges::cut(std::span<const Point<2>> line,
                       const std::function<void(std::span<const Point<2>>)>& take) const {
  std::vector<std::vector<Point<2>>> pieces;
  std::vector<Point<2>> stops;
  bool is_known = false;  // whether what comes next is inside
  bool is_inside = false;
  for (std::size_t i = 1; i < line.size(); ++i) {
    stops.assign({line[i - 1]});
    if (find_crossings(line[i - 1], line[i], stops)) is_known = false;
    stops.push_back(line[i]);
    for (std::size_t k = 1; k < stops.size(); ++k) {
      const Point<2>& from = stops[k - 1];
      const Point<2>& to = stops[k];
      if (from == to) continue;
      const bool goes_on = is_inside && !pieces.empty();
      if (!is_known) is_inside = contains(middle_of(from, to));
      is_known = stops.size() == 2;
      if (!is_inside) continue;
      if (!goes_on) pieces.push_back({from});
      pieces.back().push_back(to);
    }
  }
  const bool is_closed = !line.empty() && line.front() == line.back();
  if (is_closed && pieces.size() > 1 && pieces.front().front() == line.front() &&
      pieces.back().back() == line.front()) {
    std::vector<Point<2>>& last = pieces.back();
    last.insert(last.end(), pieces.front().begin() + 1, pieces.front().end());
    pieces.front() = std::move(last);
    pieces.pop_back();
  }
  for (const std::vector<Point<2>>& piece : pieces) take(piece);
}

}  // namespace spillway::terrain
