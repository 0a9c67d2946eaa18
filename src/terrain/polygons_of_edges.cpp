#include "src/terrain/polygons_of_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "src/error.h"
#include "src/geometry/predicates.h"

namespace spillway::terrain {
namespace {

using Number = std::uint32_t;

/// Without edges of no length and those that run to and fro, in lexicographic order.
std::vector<BoundaryEdge> without_opposites(std::vector<BoundaryEdge> edges) {
  std::erase_if(edges, [](const BoundaryEdge& edge) { return edge.from == edge.to; });
  const auto ends = [](const BoundaryEdge& edge) { return std::minmax(edge.from, edge.to); };
  std::ranges::sort(edges, [&](const BoundaryEdge& a, const BoundaryEdge& b) {
    return ends(a) != ends(b) ? ends(a) < ends(b) : a < b;
  });
  std::vector<BoundaryEdge> left;
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(
        begin, edges.end(), [&](const BoundaryEdge& edge) { return ends(edge) != ends(*begin); });
    // Those of one direction come first.
    const auto turn = std::find_if(
        begin, end, [&](const BoundaryEdge& edge) { return edge.from != begin->from; });
    const auto forth = turn - begin;
    const auto back = end - turn;
    left.insert(left.end(), begin, begin + std::max(forth - back, std::ptrdiff_t{0}));
    left.insert(left.end(), turn, turn + std::max(back - forth, std::ptrdiff_t{0}));
    begin = end;
  }
  std::ranges::sort(left);
  return left;
}

/// Which edge comes after each in a ring.
class Successors {
 public:
  explicit Successors(const std::vector<BoundaryEdge>& edges) : edges_(edges) {
    if (edges.size() >= std::uint64_t{1} << 32) {
      throw Failure("a band of height has 4 billion edges: choose a smaller interval",
                    ErrorCode::kTooLarge);
    }
    next_.resize(edges.size());
    place_.resize(edges.size());
    is_shared_.resize(edges.size());
    std::vector<Number> arriving(edges.size());
    std::iota(arriving.begin(), arriving.end(), Number{0});
    std::ranges::sort(arriving, [&](Number a, Number b) {
      return edges[a].to != edges[b].to ? edges[a].to < edges[b].to : a < b;
    });
    for (std::size_t begin = 0; begin < edges.size();) {
      const Point<2>& point = edges[begin].from;
      std::size_t end = begin;
      for (; end < edges.size() && edges[end].from == point; ++end) {
        if (edges[arriving[end]].to != point) {
          throw Failure("the triangles do not fit together: check the mesh");
        }
        place_[end] = static_cast<Number>(begin);
      }
      if (end - begin == 1) {
        next_[arriving[begin]] = static_cast<Number>(begin);
      } else {
        std::fill(is_shared_.begin() + static_cast<std::ptrdiff_t>(begin),
                  is_shared_.begin() + static_cast<std::ptrdiff_t>(end), true);
        match(std::span(arriving).subspan(begin, end - begin), static_cast<Number>(begin));
      }
      begin = end;
    }
  }

  [[nodiscard]] Number next(Number edge) const { return next_[edge]; }
  /// A number of the point that an edge begins at.
  [[nodiscard]] Number place(Number edge) const { return place_[edge]; }
  /// Whether others begin there.
  [[nodiscard]] bool is_shared(Number edge) const { return is_shared_[edge]; }

 private:
  struct Spoke {
    Point<2> end;
    bool leaves = false;
    Number edge = 0;
  };

  /// Of several edges that arrive at a point and leave it, numbers from `first` on, each that
  /// arrives is followed by the one that lies next to its left: what both bound is between them.
  void match(std::span<const Number> arriving, Number first) {
    const Point<2> point = edges_[first].from;
    std::vector<Spoke> spokes;
    for (std::size_t i = 0; i < arriving.size(); ++i) {
      const auto leaving = static_cast<Number>(first + i);
      spokes.push_back({edges_[leaving].to, true, leaving});
      spokes.push_back({edges_[arriving[i]].from, false, arriving[i]});
    }
    const auto is_lower = [&](const Point<2>& p) {
      return p[1] < point[1] || (p[1] == point[1] && p[0] < point[0]);
    };
    std::ranges::sort(spokes, [&](const Spoke& a, const Spoke& b) {
      if (is_lower(a.end) != is_lower(b.end)) return is_lower(b.end);
      const int turn = orientation<2>({point, a.end, b.end});
      if (turn != 0) return turn > 0;
      return std::pair(a.leaves, a.edge) < std::pair(b.leaves, b.edge);
    });
    std::vector<Number> leaving;
    for (int round = 0; round < 2; ++round) {
      for (Spoke& spoke : spokes) {
        if (spoke.leaves) {
          if (round == 0) leaving.push_back(spoke.edge);
        } else if (spoke.edge != kMatched && !leaving.empty()) {
          next_[std::exchange(spoke.edge, kMatched)] = leaving.back();
          leaving.pop_back();
        }
      }
    }
  }

  static constexpr Number kMatched = ~Number{0};
  const std::vector<BoundaryEdge>& edges_;
  std::vector<Number> next_;
  std::vector<Number> place_;
  std::vector<bool> is_shared_;
};

/// All rings; those that come to a point several times are cut there.
std::vector<Ring> rings_of(const std::vector<BoundaryEdge>& edges) {
  const Successors successors(edges);
  std::vector<Ring> rings;
  std::vector<bool> is_done(edges.size());
  std::vector<Number> path;
  std::unordered_map<Number, std::size_t> on_path;  // shared points, where they are on it
  const auto cut = [&](std::size_t begin) {
    Ring& ring = rings.emplace_back();
    for (std::size_t i = begin; i < path.size(); ++i) {
      ring.push_back(edges[path[i]].from);
      if (successors.is_shared(path[i])) on_path.erase(successors.place(path[i]));
    }
    path.resize(begin);
  };
  for (Number begin = 0; begin < edges.size(); ++begin) {
    for (Number edge = begin; !is_done[edge]; edge = successors.next(edge)) {
      is_done[edge] = true;
      if (successors.is_shared(edge)) {
        const auto found = on_path.find(successors.place(edge));
        if (found != on_path.end()) cut(found->second);
        on_path[successors.place(edge)] = path.size();
      }
      path.push_back(edge);
    }
    if (!path.empty()) cut(0);
  }
  return rings;
}

double area(const Ring& ring) {
  const Point<2>& origin = ring.front();
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    twice += (ring[i][0] - origin[0]) * (ring[i + 1][1] - origin[1]) -
             (ring[i + 1][0] - origin[0]) * (ring[i][1] - origin[1]);
  }
  return twice / 2;
}

/// 1 if a ring runs counter-clockwise, -1 if clockwise, 0 if it is flat.
int direction(const Ring& ring) {
  if (ring.size() < 3) return 0;
  const int turn = orientation<2>({ring.back(), ring[0], ring[1]});  // at its least point
  if (turn != 0) return turn;
  const double size = area(ring);
  return size > 0 ? 1 : size < 0 ? -1 : 0;
}

/// The middle of a ring's longest edge: a point at which no other ring is likely to be.
Point<2> middle_of(const Ring& ring) {
  double most = -1;
  Point<2> middle{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point<2>& a = ring[i];
    const Point<2>& b = ring[i + 1 < ring.size() ? i + 1 : 0];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (length <= most) continue;
    most = length;
    middle = {a[0] + (b[0] - a[0]) / 2, a[1] + (b[1] - a[1]) / 2};
  }
  return middle;
}

/// Finds the smallest polygon that holds a point: by the edges that are below it, among those of
/// its column.
class OuterRings {
 public:
  explicit OuterRings(const std::vector<PolygonWithHoles>& polygons) {
    std::size_t count = 0;
    west_ = INFINITY;
    double east = -INFINITY;
    for (const PolygonWithHoles& polygon : polygons) {
      areas_.push_back(area(polygon.outer));
      count += polygon.outer.size();
      for (const Point<2>& point : polygon.outer) {
        west_ = std::min(west_, point[0]);
        east = std::max(east, point[0]);
      }
    }
    columns_.resize(1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(count))));
    width_ = (east - west_) / static_cast<double>(columns_.size());
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      const Ring& ring = polygons[p].outer;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        add(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0], static_cast<Number>(p));
      }
    }
    is_inside_.resize(polygons.size());
  }

  /// Its number; that of no polygon if there is none.
  std::size_t around(const Point<2>& point) {
    std::vector<Number> below;
    for (const Edge& edge : columns_[column(point[0])]) {
      if (edge.west[0] > point[0] || edge.east[0] <= point[0]) continue;
      if (orientation<2>({edge.west, edge.east, point}) <= 0) continue;
      is_inside_[edge.polygon] = !is_inside_[edge.polygon];
      below.push_back(edge.polygon);
    }
    std::size_t smallest = areas_.size();
    for (const Number polygon : below) {
      if (!is_inside_[polygon]) continue;
      is_inside_[polygon] = false;
      if (smallest == areas_.size() || areas_[polygon] < areas_[smallest]) smallest = polygon;
    }
    return smallest;
  }

 private:
  struct Edge {
    Point<2> west;
    Point<2> east;
    Number polygon = 0;
  };

  [[nodiscard]] std::size_t column(double x) const {
    const double column = width_ > 0 ? std::floor((x - west_) / width_) : 0;
    return static_cast<std::size_t>(
        std::clamp(column, 0.0, static_cast<double>(columns_.size() - 1)));
  }

  void add(const Point<2>& a, const Point<2>& b, Number polygon) {
    const auto& [west, east] = std::minmax(a, b);
    if (west[0] == east[0]) return;
    for (std::size_t c = column(west[0]); c <= column(east[0]); ++c) {
      columns_[c].push_back({west, east, polygon});
    }
  }

  double west_ = 0;
  double width_ = 0;
  std::vector<std::vector<Edge>> columns_;
  std::vector<double> areas_;
  std::vector<bool> is_inside_;
};

}  // namespace

std::vector<PolygonWithHoles> polygons_of_edges(std::vector<BoundaryEdge> edges) {
  std::vector<PolygonWithHoles> polygons;
  std::vector<Ring> holes;
  for (Ring& ring : rings_of(without_opposites(std::move(edges)))) {
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    const int turn = direction(ring);
    if (turn > 0) {
      polygons.push_back({.outer = std::move(ring), .holes = {}});
    } else if (turn < 0) {
      holes.push_back(std::move(ring));
    }
  }
  std::ranges::sort(polygons, {}, &PolygonWithHoles::outer);
  std::ranges::sort(holes);
  OuterRings outer(polygons);
  for (Ring& hole : holes) {
    const std::size_t around = outer.around(middle_of(hole));
    if (around < polygons.size()) polygons[around].holes.push_back(std::move(hole));
  }
  return polygons;
}

}  // namespace spillway::terrain
