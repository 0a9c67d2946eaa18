#include "src/geometry/torus_simplex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// The middle of the box around points that are given by their differences from one of them.
template <int D, std::size_t Count>
Point<D> middle_of(const std::array<Point<D>, Count>& differences) {
  Point<D> middle;
  for (int k = 0; k < D; ++k) {
    double low = differences[0][k];
    double high = low;
    for (const Point<D>& difference : differences) {
      low = std::min(low, difference[k]);
      high = std::max(high, difference[k]);
    }
    middle[k] = (low + high) / 2;
  }
  return middle;
}

template <int D>
Point<D> difference(const Point<D>& a, const Point<D>& b) {
  Point<D> difference;
  for (int k = 0; k < D; ++k) difference[k] = a[k] - b[k];
  return difference;
}

/// Adds to the periods of `lowest` those that `centre`, seen from it, lies beyond.
template <int D>
Periods<D> periods_of_centre(const Torus& torus, const Point<D>& lowest, const Point<D>& centre) {
  Periods<D> periods = torus.periods_of<D>(lowest);
  for (int k = 0; k < D; ++k) {
    if (!torus.periodic(k)) continue;
    const double inside = torus.moved(k, lowest[k], -periods[k]) - torus.low(k);
    const double beyond = std::floor((inside + centre[k]) / torus.period(k));
    periods[k] = static_cast<std::int8_t>(periods[k] + std::clamp(beyond, -100.0, 100.0));
  }
  return periods;
}

}  // namespace

template <int D>
SimplexPlace<D> place_simplex(const Torus& torus, const std::array<Point<D>, D + 1>& corners,
                              const SortedCorners<D>& sorted) {
  const Point<D>& lowest = corners[sorted.order[0]];
  std::array<Point<D>, D + 1> differences;
  for (int i = 0; i <= D; ++i) differences[i] = difference<D>(corners[sorted.order[i]], lowest);
  SimplexPlace<D> place;
  Point<D> centre = circumcentre<D>(differences);
  place.radius = std::sqrt(squared_length(centre)) * kRoundedUp;
  if (!(place.radius <= kLargestRadius * torus.shortest_period())) {
    centre = exact_circumcentre<D>(differences);
  }
  place.periods = periods_of_centre<D>(torus, lowest, centre);
  for (int k = 0; k < D; ++k) place.centre[k] = lowest[k] + centre[k];
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
  const Point<D>& lowest = *std::min_element(facet.begin(), facet.end());
  std::array<Point<D>, D> differences;
  for (int i = 0; i < D; ++i) differences[i] = difference<D>(facet[i], lowest);
  return periods_of_centre<D>(torus, lowest, middle_of<D>(differences)) == Periods<D>{};
}

void refuse_long_simplices(const Torus& torus, const std::array<double, 3>& reach) {
  for (int k = 0; k < torus.dimension(); ++k) {
    const double share = reach[k] / torus.period(k);
    if (share < 0.5) continue;
    throw Failure(
        fmt::format("too few points for a triangulation of the periodic box: a {} is {:.3g} of "
                    "the period long along {}, and all must be shorter than half of it; add "
                    "points there, or repeat points and box two or three times along that axis",
                    torus.dimension() == 2 ? "triangle" : "tetrahedron", share, "xyz"[k]),
        ErrorCode::kDegenerateInput);
  }
}

#define SPILLWAY_INSTANTIATE(D)                                                               \
  template SimplexPlace<D> place_simplex<D>(const Torus&, const std::array<Point<D>, D + 1>&, \
                                            const SortedCorners<D>&);                         \
  template bool is_along_periods<D>(const Torus&, const std::array<Point<D>, D>&);            \
  template bool is_chosen_hull_facet<D>(const Torus&, const std::array<Point<D>, D>&);
SPILLWAY_INSTANTIATE(2)
SPILLWAY_INSTANTIATE(3)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
