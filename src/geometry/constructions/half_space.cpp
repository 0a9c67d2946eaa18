#include "src/geometry/constructions/half_space.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/predicates.h"

namespace spillway::geometry {

template <int D>
requires SupportedDimension<D> HalfSpace<D>::HalfSpace(const std::array<Point<D>, D>& facet)
    : facet_(facet) {
  if constexpr (D == 2) {
    normal_ = {facet[0][1] - facet[1][1], facet[1][0] - facet[0][0]};
    magnitude_ = {std::abs(normal_[0]), std::abs(normal_[1])};
  } else {
    for (int k = 0; k < D; ++k) {
      const int second = (k + 1) % D;
      const int third = (k + 2) % D;
      const double a = (facet[1][second] - facet[0][second]) * (facet[2][third] - facet[0][third]);
      const double b = (facet[1][third] - facet[0][third]) * (facet[2][second] - facet[0][second]);
      normal_[k] = a - b;
      magnitude_[k] = std::abs(a) + std::abs(b);
    }
  }
}

/// By axis, whether larger coordinates lie farther beyond: the signs of the normal's components are
/// orientations of the facet's shadows.
template <int D>
std::array<bool, D> upwards(const std::array<Point<D>, D>& facet) {
  if constexpr (D == 2) {
    return {facet[1][1]<facet[0][1], facet[1][0]> facet[0][0]};
  } else {
    std::array<bool, D> upwards{};
    for (int k = 0; k < D; ++k) {
      std::array<Point<2>, D> shadow;
      for (int i = 0; i < D; ++i) shadow[i] = {facet[i][(k + 1) % D], facet[i][(k + 2) % D]};
      upwards[k] = orientation<2>(shadow) > 0;
    }
    return upwards;
  }
}

template <int D>
requires SupportedDimension<D>
bool HalfSpace<D>::meets_exactly(const Box<D>& box) const {
  if (box.empty()) return false;
  std::array<Point<D>, D + 1> simplex;
  std::copy(facet_.begin(), facet_.end(), simplex.begin());
  // An affine function is largest over a box at a corner, and the normal's signs tell at which.
  const std::array<bool, D> up = upwards<D>(facet_);
  for (int k = 0; k < D; ++k) simplex[D][k] = up[k] ? box.hi[k] : box.lo[k];
  return orientation<D>(simplex) >= 0;
}

template class HalfSpace<2>;
template class HalfSpace<3>;

}  // namespace spillway::geometry
