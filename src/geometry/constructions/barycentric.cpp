#include "src/geometry/constructions/barycentric.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::geometry {

template <int D>
std::array<double, D + 1> barycentric_coordinates(const std::array<Point<D>, D + 1>& simplex,
                                                  const Point<D>& place) {
  // Each determinant is off by less than error_bound(), for D = 3 less than 2^-47 of the product of
  // the extents: so a sum of at least 2^-8 of that gives shares to 2^-36. Where D > 3 the bound is
  // larger, and the sum has to be.
  constexpr double kFlat = 0x1p-8;
  constexpr double kLeastOverBound = D <= 3 ? 0 : 0x1p40;
  Vectors<D, D + 1, double> v;
  std::array<double, D> largest{};
  for (int i = 0; i <= D; ++i) {
    for (int k = 0; k < D; ++k) {
      v[i][k] = simplex[i][k] - place[k];
      largest[k] = std::max(largest[k], std::abs(v[i][k]));
    }
  }
  double extents = 1;
  bool safe = true;
  for (int k = 0; k < D; ++k) {
    extents *= largest[k];
    safe = safe && largest[k] >= stages::kSmallestSafe<D> && largest[k] <= stages::kLargestSafe<D>;
  }
  auto weights = barycentric_determinants<D>(v);
  const double bound = stages::Orientation<D>::error_bound(largest);
  double sum = 0;
  for (double& weight : weights) {
    // Its sign is not sure: it may be on a facet, where the coordinate has to be 0.
    safe = safe && std::abs(weight) > bound;
    sum += weight;
  }
  if (!safe || !(sum >= std::max(kFlat * extents, kLeastOverBound * bound))) {
    return exact_barycentric_coordinates<D>(simplex, place);
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

#define SPILLWAY_INSTANTIATE(D)                                  \
  template std::array<double, D + 1> barycentric_coordinates<D>( \
      const std::array<Point<D>, D + 1>&, const Point<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
