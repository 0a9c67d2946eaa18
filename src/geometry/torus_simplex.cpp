#include "src/geometry/torus_simplex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/error.h"
#include "src/geometry/constructions/circumcentre.h"
#include "src/geometry/determinants.h"
#include "src/geometry/predicates.h"

namespace spillway::geometry {
namespace {

/// Centres of larger spheres, in periods, are computed exactly: they may lie far away along an open
/// axis, and must be known to far less than a period along the others.
constexpr double kLargestRadius = 1024;

/// By how much a computed radius may be too small.
constexpr double kRoundedUp = 1 + 0x1p-30;

template <int D>
Point<D> difference(const Point<D>& a, const Point<D>& b) {
  Point<D> difference;
  for (int k = 0; k < D; ++k) difference[k] = a[k] - b[k];
  return difference;
}

/// By how much a place near that point may be rounded, at most.
template <int D>
double rounding_of(const Point<D>& point) {
  double most = 0;
  for (const double x : point) most = std::max(most, std::abs(x));
  return 4 * std::numeric_limits<double>::epsilon() * most;
}

/// Some points, seen from the first one along periodic axes and as they are along open ones: exact,
/// and the same for all copies.
template <int D, std::size_t Count>
std::array<Point<D>, Count> seen_from_first(const Torus& torus,
                                            const std::array<Point<D>, Count>& points) {
  std::array<Point<D>, Count> seen = points;
  for (Point<D>& point : seen) {
    for (int k = 0; k < D; ++k) {
      if (torus.periodic(k)) point[k] -= points[0][k];
    }
  }
  return seen;
}

/// Adds to the periods of `lowest` those that `centre`, seen from it, lies beyond.
template <int D>
Periods<D> periods_of_centre(const Torus& torus, const Point<D>& lowest, const Point<D>& centre) {
  Periods<D> periods = torus.periods_of<D>(lowest);
  for (int k = 0; k < D; ++k) {
    if (!torus.periodic(k)) continue;
    const double inside = torus.moved(k, lowest[k], -periods[k]) - torus.low(k);
    const double beyond = std::floor((inside + centre[k]) / torus.period(k));
    const double near = std::isfinite(beyond) ? std::clamp(beyond, -100.0, 100.0) : 100;
    periods[k] = static_cast<std::int8_t>(periods[k] + near);
  }
  return periods;
}

/// The centre of a simplex of which the determinant of its edges is well away from 0, seen from the
/// first corner: within 2^-30 of its distance. False for others.
template <int D>
bool plain_centre(const std::array<Point<D>, D + 1>& corners, Point<D>& centre) {
  constexpr double kWellAway = 0x1p-12;
  std::array<Point<D>, D> edges;
  double size = 0;
  std::array<double, D> squares;
  for (int i = 0; i < D; ++i) {
    edges[i] = difference<D>(corners[i + 1], corners[0]);
    squares[i] = squared_length(edges[i]);
    size = std::max(size, squares[i]);
  }
  if constexpr (D == 2) {
    const double det = edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0];
    if (!(std::abs(det) > kWellAway * size)) return false;
    const double scale = 0.5 / det;
    centre = {(squares[0] * edges[1][1] - squares[1] * edges[0][1]) * scale,
              (squares[1] * edges[0][0] - squares[0] * edges[1][0]) * scale};
  } else {
    const auto cross = [](const Point<3>& a, const Point<3>& b) {
      return Point<3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
    };
    const Point<3> bc = cross(edges[1], edges[2]);
    const Point<3> ca = cross(edges[2], edges[0]);
    const Point<3> ab = cross(edges[0], edges[1]);
    const double det = edges[0][0] * bc[0] + edges[0][1] * bc[1] + edges[0][2] * bc[2];
    if (!(det * det > kWellAway * kWellAway * size * size * size)) return false;
    const double scale = 0.5 / det;
    for (int k = 0; k < 3; ++k) {
      centre[k] = (squares[0] * bc[k] + squares[1] * ca[k] + squares[2] * ab[k]) * scale;
    }
  }
  return true;
}

/// False if rounding might decide in which copy of the box the centre lies.
template <int D>
bool place_at_once(const Torus& torus, const std::array<Point<D>, D + 1>& corners,
                   SimplexPlace<D>& place) {
  constexpr double kUnsure = 0x1p-20;
  Point<D> centre;
  if (!plain_centre<D>(corners, centre)) return false;
  place.radius = std::sqrt(squared_length(centre)) * kRoundedUp + rounding_of<D>(corners[0]);
  if (!(place.radius <= torus.shortest_period())) return false;
  for (int k = 0; k < D; ++k) {
    place.centre[k] = corners[0][k] + centre[k];
    place.periods[k] = 0;
    if (!torus.periodic(k)) continue;
    const double along = (place.centre[k] - torus.low(k)) / torus.period(k);
    const int whole = along < 0 ? -1 : static_cast<int>(along);
    const double beyond = along - whole;
    if (!(along > -1 && along < 2 && beyond > kUnsure && beyond < 1 - kUnsure)) return false;
    place.periods[k] = static_cast<std::int8_t>(whole);
  }
  return true;
}

}  // namespace

template <int D>
SimplexPlace<D> place_simplex(const Torus& torus, const std::array<Point<D>, D + 1>& corners) {
  SimplexPlace<D> place;
  if (place_at_once<D>(torus, corners, place)) return place;
  // In an order that all copies have, so that they agree to the last bit.
  std::array<Point<D>, D + 1> sorted = corners;
  std::sort(sorted.begin(), sorted.end());
  const std::array<Point<D>, D + 1> seen = seen_from_first<D>(torus, sorted);
  Point<D> centre = circumcentre<D>(seen);
  const double radius = std::sqrt(squared_length(difference<D>(centre, seen[0])));
  if (!(radius <= kLargestRadius * torus.shortest_period())) centre = exact_circumcentre<D>(seen);
  place.radius = radius * kRoundedUp + rounding_of<D>(corners[0]);
  place.periods = periods_of_centre<D>(torus, sorted[0], centre);
  for (int k = 0; k < D; ++k) {
    place.centre[k] = torus.periodic(k) ? sorted[0][k] + centre[k] : centre[k];
  }
  return place;
}

template <int D>
bool is_along_periods(const Torus& torus, const std::array<Point<D>, D>& facet) {
  std::array<int, D> open{};
  int count = 0;
  for (int k = 0; k < D; ++k) {
    if (!torus.periodic(k)) open[count++] = k;
  }
  if (count == 1) {
    return std::all_of(facet.begin(), facet.end(),
                       [&](const Point<D>& point) { return point[open[0]] == facet[0][open[0]]; });
  }
  if constexpr (D == 3) {
    if (count == 2) {
      std::array<Point<2>, 3> seen;
      for (int i = 0; i < 3; ++i) seen[i] = {facet[i][open[0]], facet[i][open[1]]};
      return orientation<2>(seen) == 0;
    }
  }
  return false;
}

template <int D>
bool is_chosen_hull_facet(const Torus& torus, const std::array<Point<D>, D>& facet) {
  if (!is_along_periods<D>(torus, facet)) return false;
  std::array<Point<D>, D> sorted = facet;
  std::sort(sorted.begin(), sorted.end());
  const std::array<Point<D>, D> seen = seen_from_first<D>(torus, sorted);
  Point<D> centre;
  if constexpr (D == 2) {
    for (int k = 0; k < D; ++k) centre[k] = seen[1][k] / 2;  // of open axes nothing is asked
  } else {
    centre = exact_circle_centre(seen);
  }
  return periods_of_centre<D>(torus, sorted[0], centre) == Periods<D>{};
}

void refuse_long_simplices(const Torus& torus, const std::array<double, 3>& reach) {
  int axis = 0;
  const auto share = [&](int k) { return reach[k] / torus.period(k); };
  for (int k = 1; k < torus.dimension(); ++k) {
    if (share(k) > share(axis)) axis = k;
  }
  if (share(axis) < 0.5) return;
  throw Failure(
      fmt::format("too few points for a triangulation of the periodic box: a {} is {:.3g} of the "
                  "period long along {}, and all must be shorter than half of it; add points where "
                  "there are few, or repeat points and box two or three times along {}",
                  torus.dimension() == 2 ? "triangle" : "tetrahedron", share(axis), "xyz"[axis],
                  "xyz"[axis]),
      ErrorCode::kDegenerateInput);
}

#define SPILLWAY_INSTANTIATE(D)                                                                \
  template SimplexPlace<D> place_simplex<D>(const Torus&, const std::array<Point<D>, D + 1>&); \
  template bool is_along_periods<D>(const Torus&, const std::array<Point<D>, D>&);             \
  template bool is_chosen_hull_facet<D>(const Torus&, const std::array<Point<D>, D>&);
SPILLWAY_INSTANTIATE(2)
SPILLWAY_INSTANTIATE(3)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
