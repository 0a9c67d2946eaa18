#include "stream/periodic/chosen_simplices.h"

#include <bit>
#include <utility>

#include <spillway/detail/probing_table.h>

namespace spillway::stream {

template <int D>
ChosenSimplices<D>::ChosenSimplices(const PeriodicDomain& domain, std::vector<Point<D>> points)
    : domain_(domain), points_(std::move(points)), deep_(points_.size()) {
  Point<D> low{};
  Point<D> high{};
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const Point<D>& point = points_[v];
    deep_[v] = is_deep(point) ? 1 : 0;
    all_deep_ &= deep_[v] != 0;
    for (int k = 0; k < D; ++k) {
      low[k] = v == 0 ? point[k] : std::min(low[k], point[k]);
      high[k] = v == 0 ? point[k] : std::max(high[k], point[k]);
    }
  }
  const Torus& torus = domain_.torus();
  for (int k = 0; k < D; ++k) {
    if (torus.periodic(k) && 2 * (high[k] - low[k]) >= torus.period(k)) all_near_ = false;
  }
}

template <int D>
bool ChosenSimplices<D>::is_deep(const Point<D>& point) const {
  const Torus& torus = domain_.torus();
  for (int k = 0; k < D; ++k) {
    if (!torus.periodic(k)) continue;
    const double margin = domain_.margin(k);
    if (!(point[k] >= torus.low(k) + margin && point[k] <= torus.high(k) - margin)) return false;
  }
  return true;
}

template <int D>
bool ChosenSimplices<D>::choose(const Corners& corners) {
  int deep = 0;
  for (const VertexId v : corners) deep += deep_[v];
  if (deep == D + 1 && all_near_) return true;
  std::array<Point<D>, D + 1> points;
  for (int i = 0; i <= D; ++i) points[i] = points_[corners[i]];
  if (deep == D + 1) {
    note_reach(points);
    return true;
  }
  const SortedCorners<D> sorted(points);
  const SimplexPlace<D> place = place_simplex<D>(domain_.torus(), points, sorted);
  const bool chosen = place.stands_for_all();
  if ((chosen || deep > 0) && !domain_.has_sphere(place)) ++proof_.beyond_margin;
  if (!chosen) return false;
  if (!all_near_) note_reach(points);
  for (int left_out = 0; left_out <= D; ++left_out) {
    std::array<VertexId, D> facet;
    int deep_here = 0;
    for (int i = 0, n = 0; i <= D; ++i) {
      if (i == left_out) continue;
      facet[n++] = corners[sorted.order[i]];
      deep_here += deep_[corners[sorted.order[i]]];
    }
    // Both sides of such a facet are chosen, or reach beyond the margin.
    if (deep_here == D) continue;
    add_facet(facet, sorted.odd != (left_out % 2 != 0));
  }
  return true;
}

template <int D>
bool ChosenSimplices<D>::choose_infinite(const Corners& corners) {
  // Sorted, with the infinite vertex behind all others.
  std::array<VertexId, D> facet;
  std::array<Point<D>, D> points;
  bool odd = false;
  for (int i = 0, n = 0; i <= D; ++i) {
    if (corners[i] == kInfiniteVertex) {
      odd ^= (D - i) % 2 != 0;
    } else {
      facet[n++] = corners[i];
    }
  }
  for (int last = D - 1; last > 0; --last) {
    for (int i = 0; i < last; ++i) {
      if (!(points_[facet[i + 1]] < points_[facet[i]])) continue;
      std::swap(facet[i], facet[i + 1]);
      odd = !odd;
    }
  }
  for (int i = 0; i < D; ++i) points[i] = points_[facet[i]];
  if (!is_chosen_hull_facet<D>(domain_.torus(), points)) return false;
  add_facet(facet, odd != (D % 2 != 0));
  return true;
}

template <int D>
std::array<VertexId, D + 1> ChosenSimplices<D>::ordered(Corners corners) const {
  const Torus& torus = domain_.torus();
  bool all_inside = true;
  int lowest = 0;
  for (int i = 0; i <= D; ++i) {
    const Point<D>& point = points_[corners[i]];
    all_inside &= torus.template periods_of<D>(point) == Periods<D>{};
    if (point < points_[corners[lowest]]) lowest = i;
  }
  if (all_inside || lowest == 0) return corners;
  std::swap(corners[0], corners[lowest]);
  const int other = lowest == D ? D - 1 : D;
  std::swap(corners[other], corners[lowest]);  // the second swap restores the orientation
  return corners;
}

template <int D>
Point<D> ChosenSimplices<D>::in_box(const Point<D>& point) const {
  Periods<D> back = domain_.torus().template periods_of<D>(point);
  for (std::int8_t& periods : back) periods = static_cast<std::int8_t>(-periods);
  return domain_.torus().template moved<D>(point, back);
}

template <int D>
void ChosenSimplices<D>::note_reach(const std::array<Point<D>, D + 1>& corners) {
  for (int k = 0; k < D; ++k) {
    if (!domain_.torus().periodic(k)) continue;
    proof_.reach[k] = std::max(proof_.reach[k], geometry::reach<D>(corners, k));
  }
}

/// By the facet's corners in their order, each by the point of the box that it is a copy of, and by
/// the periods between it and the first corner's.
template <int D>
void ChosenSimplices<D>::add_facet(const std::array<VertexId, D>& facet, bool odd) {
  const Torus& torus = domain_.torus();
  const Periods<D> first = torus.template periods_of<D>(points_[facet[0]]);
  std::array<std::uint64_t, 2> print{0x9E3779B97F4A7C15U, 0xD1B54A32D192ED03U};
  const auto mix = [&print](std::uint64_t value) {
    print[0] = scatter(print[0] ^ value);
    print[1] = scatter(print[1] + std::rotl(value, 23));
  };
  for (const VertexId v : facet) {
    const Point<D>& point = points_[v];
    const Periods<D> periods = torus.template periods_of<D>(point);
    for (int k = 0; k < D; ++k) {
      // Zero has two signs.
      mix(std::bit_cast<std::uint64_t>(torus.moved(k, point[k], -periods[k]) + 0.0));
      mix(static_cast<std::uint64_t>(periods[k] - first[k]));
    }
  }
  for (int i = 0; i < 2; ++i) proof_.open_facets[i] += odd ? -print[i] : print[i];
}

template class ChosenSimplices<2>;
template class ChosenSimplices<3>;

}  // namespace spillway::stream
