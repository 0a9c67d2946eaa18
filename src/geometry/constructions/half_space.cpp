#include "src/geometry/constructions/half_space.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/predicates.h"

namespace spillway::detail {

template <int D>
requires SupportedDimension<D> HalfSpace<D>::HalfSpace(const std::array<Point<D>, D>& facet)
    : facet_(facet) {
  // The signs of the normal's components are orientations of the facet's shadows.
  if constexpr (D == 2) {
    upwards_ = {facet[1][1]<facet[0][1], facet[1][0]> facet[0][0]};
    normal_ = {facet[0][1] - facet[1][1], facet[1][0] - facet[0][0]};
    magnitude_ = {std::abs(normal_[0]), std::abs(normal_[1])};
  } else {
    for (int k = 0; k < D; ++k) {
      const int second = (k + 1) % D;
      const int third = (k + 2) % D;
      std::array<Point<2>, 3> shadow;
      for (int i = 0; i < D; ++i) shadow[i] = {facet[i][second], facet[i][third]};
      upwards_[k] = orientation<2>(shadow) > 0;
      const double a = (facet[1][second] - facet[0][second]) * (facet[2][third] - facet[0][third]);
      const double b = (facet[1][third] - facet[0][third]) * (facet[2][second] - facet[0][second]);
      normal_[k] = a - b;
      magnitude_[k] = std::abs(a) + std::abs(b);
    }
  }
}

// A difference of two coordinates errs by half an ulp of itself, so a component of the normal by
// less than 3 ulp of its magnitude, and the sum by less than 8 ulp of `scale`; by what underflows
// it errs by much less than the rest of the bound.
template <int D>
requires SupportedDimension<D>
auto HalfSpace<D>::place_of(const Point<D>& point) const -> Place {
  constexpr double kError = 0x1p-49;
  constexpr double kSmallest = 0x1p-900;
  Place place;
  double scale = 0;
  double reach = 0;
  for (int k = 0; k < D; ++k) {
    const double difference = point[k] - facet_[0][k];
    place.beyond += normal_[k] * difference;
    scale += magnitude_[k] * std::abs(difference);
    reach += std::abs(difference);
  }
  place.error = kError * scale + kSmallest * (1 + reach);
  return place;
}

template <int D>
requires SupportedDimension<D> std::optional<bool> HalfSpace<D>::quickly_has(const Point<D>& point)
const {
  const Place place = place_of(point);
  if (!(std::abs(place.beyond) > place.error)) return std::nullopt;
  return place.beyond > 0;
}

template <int D>
requires SupportedDimension<D>
bool HalfSpace<D>::meets(const Box<D>& box) const {
  if (box.empty()) return false;
  std::array<Point<D>, D + 1> simplex;
  std::copy(facet_.begin(), facet_.end(), simplex.begin());
  // An affine function is largest over a box at a corner, and the normal's signs tell at which.
  for (int k = 0; k < D; ++k) simplex[D][k] = upwards_[k] ? box.hi[k] : box.lo[k];
  if (const std::optional<bool> has = quickly_has(simplex[D])) return *has;
  return orientation<D>(simplex) >= 0;
}

template class HalfSpace<2>;
template class HalfSpace<3>;

}  // namespace spillway::detail
