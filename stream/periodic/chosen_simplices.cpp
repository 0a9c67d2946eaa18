#include "stream/periodic/chosen_simplices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <spillway/detail/probing_table.h>
#include "src/geometry/torus_simplex.h"

namespace spillway::stream {
namespace {

/// The periods of an offset along each axis, so far apart that differences of offsets are those of
/// all axes.
std::uint32_t apart(std::uint32_t offset) {
  const auto bits = static_cast<CornerOffset>(offset);
  return static_cast<std::uint32_t>(periods_along(bits, 0) + 256 * periods_along(bits, 1) +
                                    65536 * periods_along(bits, 2));
}

/// The least periods along each axis of some offsets.
template <std::size_t Count>
std::uint32_t least_of(const std::array<std::uint8_t, Count>& offsets) {
  std::array<int, 3> least{2, 2, 2};
  for (const std::uint8_t offset : offsets) {
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], periods_along(static_cast<CornerOffset>(offset), k));
    }
  }
  return static_cast<std::uint8_t>(corner_offset(least));
}

/// Whether an odd number of swaps sorts them.
template <std::size_t Count>
bool sorts_oddly(const std::array<std::uint64_t, Count>& numbers) {
  bool odd = false;
  for (std::size_t i = 0; i < Count; ++i) {
    for (std::size_t j = i + 1; j < Count; ++j) odd ^= numbers[i] > numbers[j];
  }
  return odd;
}

}  // namespace

template <int D>
ChosenSimplices<D>::ChosenSimplices(const PeriodicDomain& domain, std::vector<Point<D>> points)
    : domain_(domain),
      points_(std::move(points)),
      offsets_(points_.size()),
      prints_(points_.size()),
      deep_(points_.size()) {
  const Torus& torus = domain_.torus();
  Point<D> low{};
  Point<D> high{};
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const Point<D>& point = points_[v];
    for (int k = 0; k < D; ++k) {
      low[k] = v == 0 ? point[k] : std::min(low[k], point[k]);
      high[k] = v == 0 ? point[k] : std::max(high[k], point[k]);
    }
    offsets_[v] = static_cast<std::uint8_t>(corner_offset(torus.template periods_of<D>(point)));
    deep_[v] = is_deep(point) ? 1 : 0;
    all_deep_ &= deep_[v] != 0;
  }
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
std::uint64_t ChosenSimplices<D>::fingerprint(const Point<D>& point) const {
  std::uint64_t print = 0;
  for (const double coordinate : in_box(point)) {
    // Zero has two signs.
    print = scatter(print ^ std::bit_cast<std::uint64_t>(coordinate + 0.0));
  }
  return print;
}

template <int D>
Choice ChosenSimplices<D>::choose(const Corners& corners) {
  std::array<Point<D>, D + 1> points;
  std::uint8_t offsets = 0;
  int deep = 0;
  for (int i = 0; i <= D; ++i) {
    points[i] = points_[corners[i]];
    offsets |= offsets_[corners[i]];
    deep += deep_[corners[i]];
  }
  if (deep <= D) {
    const SimplexPlace<D> place = place_simplex<D>(domain_.torus(), points);
    const bool chosen = place.stands_for_all();
    if ((chosen || deep == D) && !domain_.has_sphere(place)) ++proof_.beyond_margin;
    if (!chosen) return Choice::kLeftOut;
    add_facets(corners);
  }
  if (!all_near_) note_reach(points);
  return offsets == 0 ? Choice::kInside : Choice::kAcross;
}

/// Of the point in the box.
template <int D>
std::uint64_t ChosenSimplices<D>::print_of(VertexId v) {
  if (prints_[v] == 0) prints_[v] = fingerprint(points_[v]);
  return prints_[v];
}

/// Those that are not all deep: both sides of others are chosen, or reach beyond the margin.
template <int D>
void ChosenSimplices<D>::add_facets(const Corners& corners) {
  for (int i = 0; i <= D; ++i) {
    std::array<VertexId, D> facet;
    unsigned deep = 1;
    for (int j = 0, n = 0; j <= D; ++j) {
      if (j == i) continue;
      facet[n++] = corners[j];
      deep &= deep_[corners[j]];
    }
    if (deep == 0) add_facet(facet, i % 2 != 0);
  }
}

template <int D>
bool ChosenSimplices<D>::choose_infinite(const Corners& corners) {
  std::array<VertexId, D> facet;
  std::array<Point<D>, D> points;
  int infinite = 0;
  for (int i = 0, n = 0; i <= D; ++i) {
    if (corners[i] == kInfiniteVertex) {
      infinite = i;
      continue;
    }
    points[n] = points_[corners[i]];
    facet[n++] = corners[i];
  }
  if (domain_.torus().closed()) {
    // A closed torus has no hull. Facets that are deep are not told of by their simplices.
    const auto is_deep = [this](VertexId v) { return deep_[v] != 0; };
    proof_.beyond_margin += std::all_of(facet.begin(), facet.end(), is_deep) ? 1 : 0;
    return false;
  }
  if (!is_chosen_hull_facet<D>(domain_.torus(), points)) return false;
  add_facet(facet, infinite % 2 != 0);
  return true;
}

template <int D>
std::array<VertexId, D + 1> ChosenSimplices<D>::ordered(Corners corners) const {
  int lowest = 0;
  for (int i = 1; i <= D; ++i) {
    if (points_[corners[i]] < points_[corners[lowest]]) lowest = i;
  }
  if (lowest == 0) return corners;
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

/// A facet, and on which side of it the simplex lies: `odd` is that of the place of the corner
/// opposite. The fingerprint is made of the points in the box that the corners are copies of, and
/// of the periods between them; the side is told by the order of the corners' own fingerprints.
template <int D>
void ChosenSimplices<D>::add_facet(const std::array<VertexId, D>& facet, bool odd) {
  std::array<std::uint8_t, D> offsets;
  std::uint8_t different = 0;
  for (int i = 0; i < D; ++i) {
    offsets[i] = offsets_[facet[i]];
    different |= offsets[i] ^ offsets[0];
  }
  const std::uint32_t least = apart(different == 0 ? offsets[0] : least_of(offsets));
  std::array<std::uint64_t, D> prints;
  std::uint64_t sum = 0;
  for (int i = 0; i < D; ++i) {
    const std::uint32_t difference = different == 0 ? 0 : apart(offsets[i]) - least;
    prints[i] = scatter(print_of(facet[i]) + difference);
    sum += prints[i];
  }
  const std::uint64_t print = scatter(sum);
  proof_.open_facets += odd != sorts_oddly(prints) ? -print : print;
}

template class ChosenSimplices<2>;
template class ChosenSimplices<3>;

}  // namespace spillway::stream
