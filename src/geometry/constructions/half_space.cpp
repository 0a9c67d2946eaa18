#include "src/geometry/constructions/half_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/geometry/determinants.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/predicates.h"

namespace spillway::geometry {
namespace {

constexpr double kLongestEdge = 0x1p40;

}  // namespace

template <int D>
requires Dimension<D> HalfSpace<D>::HalfSpace(const std::array<Point<D>, D>& facet)
    : facet_(facet) {
  if constexpr (D == 2) {
    normal_ = {facet[0][1] - facet[1][1], facet[1][0] - facet[0][0]};
    magnitude_ = {std::abs(normal_[0]), std::abs(normal_[1])};
  } else if constexpr (D > 3) {
    // The cofactors of the row that a point beyond the facet would be.
    Vectors<D, D - 1, double> edges;
    Vectors<D, D - 1, double> sizes;
    double longest = 0;
    for (int i = 0; i < D - 1; ++i) {
      for (int k = 0; k < D; ++k) {
        edges[i][k] = facet[i + 1][k] - facet[0][k];
        sizes[i][k] = std::abs(edges[i][k]);
        longest = std::max(longest, sizes[i][k]);
      }
    }
    const auto cofactors = minors(edges);
    const auto magnitudes = minors<false>(sizes);
    constexpr unsigned kAll = (1U << D) - 1;
    for (int k = 0; k < D; ++k) {
      const unsigned others = kAll ^ 1U << k;
      normal_[k] = (D - 1 + k) % 2 == 0 ? cofactors[others] : -cofactors[others];
      magnitude_[k] = magnitudes[others];
    }
    // Beyond, underflow could lose more than place_of() allows for: nothing is certain.
    if (!(longest <= kLongestEdge)) magnitude_.fill(std::numeric_limits<double>::infinity());
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
  } else if constexpr (D > 3) {
    std::array<bool, D> upwards{};
    for (int k = 0; k < D; ++k) {
      std::array<Point<D - 1>, D> shadow;
      for (int i = 0; i < D; ++i) {
        for (int j = 0, n = 0; j < D; ++j) {
          if (j != k) shadow[i][n++] = facet[i][j];
        }
      }
      const int sign = orientation<D - 1>(shadow);
      upwards[k] = ((D - 1 + k) % 2 == 0 ? sign : -sign) > 0;
    }
    return upwards;
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
requires Dimension<D>
bool HalfSpace<D>::meets_exactly(const Box<D>& box) const {
  if (box.empty()) return false;
  std::array<Point<D>, D + 1> simplex;
  std::copy(facet_.begin(), facet_.end(), simplex.begin());
  // An affine function is largest over a box at a corner, and the normal's signs tell at which.
  const std::array<bool, D> up = upwards<D>(facet_);
  for (int k = 0; k < D; ++k) simplex[D][k] = up[k] ? box.hi[k] : box.lo[k];
  return orientation<D>(simplex) >= 0;
}

#define SPILLWAY_INSTANTIATE(D) template class HalfSpace<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
