#include "src/geometry/torus_simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/geometry/constructions/circumcentre.h"
#include "src/geometry/determinants.h"

namespace spillway::geometry {
namespace {

/// Centres of spheres up to this many periods are known to far less than a period.
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
    centre = middle_of<D>(differences);
    place.radius = std::numeric_limits<double>::infinity();
  }
  place.periods = periods_of_centre<D>(torus, lowest, centre);
  for (int k = 0; k < D; ++k) place.centre[k] = lowest[k] + centre[k];
  return place;
}

template <int D>
bool has_middle_inside(const Torus& torus, const std::array<Point<D>, D>& facet) {
  const Point<D>& lowest = *std::min_element(facet.begin(), facet.end());
  std::array<Point<D>, D> differences;
  for (int i = 0; i < D; ++i) differences[i] = difference<D>(facet[i], lowest);
  return periods_of_centre<D>(torus, lowest, middle_of<D>(differences)) == Periods<D>{};
}

#define SPILLWAY_INSTANTIATE(D)                                                              \
  template SimplexPlace<D> place_simplex<D>(                                                 \
      const Torus&, const std::array<Point<D>, D + 1>&, const SortedCorners<D>&);            \
  template bool has_middle_inside<D>(const Torus&, const std::array<Point<D>, D>&);
SPILLWAY_INSTANTIATE(2)
SPILLWAY_INSTANTIATE(3)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
