#include "stream/checker/torus_boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/geometry/predicates.h"

namespace spillway::checker {
namespace {

constexpr char kAxes[] = "xyz";

/// With one open axis the hull is what lies between two planes.
template <int D>
std::string fault_of_planes(int open, double low, double high,
                            const std::vector<std::array<Point<D>, D>>& facets) {
  for (const std::array<Point<D>, D>& facet : facets) {
    const double at = facet[0][open];
    const bool flat = std::all_of(facet.begin(), facet.end(),
                                  [&](const Point<D>& point) { return point[open] == at; });
    if (flat && (at == low || at == high)) continue;
    return fmt::format(
        "a facet with a corner at {} = {} has one side only, and does not lie on "
        "the hull, from {} to {}",
        kAxes[open], at, low, high);
  }
  return "";
}

/// The corners of the convex hull, counter-clockwise, none in the midst of a side (A. Andrew,
/// "Another efficient algorithm for convex hulls in two dimensions", 1979).
std::vector<Point<2>> convex_hull(std::vector<Point<2>> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point<2>> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Point<2>& point : points) {
      while (hull.size() >= first + 2 &&
             orientation<2>({hull[hull.size() - 2], hull.back(), point}) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area_of(const std::vector<Point<2>>& hull) {
  double twice = 0;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i) {
    const double x1 = hull[i][0] - hull[0][0];
    const double y1 = hull[i][1] - hull[0][1];
    twice += x1 * (hull[i + 1][1] - hull[0][1]) - y1 * (hull[i + 1][0] - hull[0][0]);
  }
  return twice / 2;
}

/// With two open axes in space the hull is a prism along the third one: its facets are seen along
/// that as parts of the sides of a polygon.
TorusBoundary boundary_of_prism(int periodic, double period,
                                const std::vector<std::array<Point<3>, 3>>& facets) {
  const auto seen = [periodic](const Point<3>& point) {
    return Point<2>{point[(periodic + 1) % 3], point[(periodic + 2) % 3]};
  };
  std::vector<Point<2>> points;
  for (const auto& facet : facets) {
    for (const Point<3>& point : facet) points.push_back(seen(point));
  }
  const std::vector<Point<2>> hull = convex_hull(std::move(points));
  TorusBoundary boundary;
  boundary.volume = area_of(hull) * period;
  for (const auto& facet : facets) {
    bool on_side = false;
    for (std::size_t i = 0; i < hull.size() && !on_side; ++i) {
      const Point<2>& next = hull[(i + 1) % hull.size()];
      on_side = std::all_of(facet.begin(), facet.end(), [&](const Point<3>& point) {
        return orientation<2>({hull[i], next, seen(point)}) == 0;
      });
    }
    if (on_side) continue;
    boundary.fault = fmt::format(
        "a facet with a corner at ({}, {}, {}) has one side only, and does not lie on the hull",
        facet[0][0], facet[0][1], facet[0][2]);
    break;
  }
  return boundary;
}

}  // namespace

template <int D>
TorusBoundary torus_boundary(const Torus& torus, const Point<D>& low, const Point<D>& high,
                             const std::vector<std::array<Point<D>, D>>& facets) {
  std::vector<int> open;
  int periodic = 0;
  TorusBoundary boundary;
  boundary.volume = 1;
  for (int k = 0; k < D; ++k) {
    if (torus.periodic(k)) {
      periodic = k;
    } else {
      open.push_back(k);
    }
    boundary.volume *= torus.periodic(k) ? torus.period(k) : high[k] - low[k];
  }
  if (open.empty()) {
    if (!facets.empty())
      boundary.fault = fmt::format("{} facets have one side only", facets.size());
  } else if (open.size() == 1) {
    boundary.fault = fault_of_planes<D>(open[0], low[open[0]], high[open[0]], facets);
  } else if constexpr (D == 3) {
    boundary = boundary_of_prism(periodic, torus.period(periodic), facets);
  }
  return boundary;
}

template TorusBoundary torus_boundary<2>(const Torus&, const Point<2>&, const Point<2>&,
                                         const std::vector<std::array<Point<2>, 2>>&);
template TorusBoundary torus_boundary<3>(const Torus&, const Point<3>&, const Point<3>&,
                                         const std::vector<std::array<Point<3>, 3>>&);

}  // namespace spillway::checker
