#include "src/geometry/constructions/barycentric.h"

#include <algorithm>
#include <cmath>

#include "src/geometry/predicate_stages.h"

namespace spillway::geometry {

template <int D>
std::array<double, D + 1> barycentric_coordinates(const std::array<Point<D>, D + 1>& simplex,
                                                  const Point<D>& place) {
  // Each determinant is off by less than error_bound(), less than 2^-47 of the product of the
  // extents: so a sum of at least 2^-8 of that gives shares to 2^-36.
  constexpr double kFlat = 0x1p-8;
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
    safe = safe && largest[k] >= stages::kSmallestSafe && largest[k] <= stages::kLargestSafe;
  }
  auto weights = barycentric_determinants<D>(v);
  const double bound = stages::Orientation<D>::error_bound(largest);
  double sum = 0;
  for (double& weight : weights) {
    // Its sign is not sure: it may be on a facet, where the coordinate has to be 0.
    safe = safe && std::abs(weight) > bound;
    sum += weight;
  }
  if (!safe || !(sum >= kFlat * extents)) return exact_barycentric_coordinates<D>(simplex, place);
  for (double& weight : weights) weight /= sum;
  return weights;
}

template std::array<double, 3> barycentric_coordinates<2>(const std::array<Point<2>, 3>&,
                                                          const Point<2>&);
template std::array<double, 4> barycentric_coordinates<3>(const std::array<Point<3>, 4>&,
                                                          const Point<3>&);

}  // namespace spillway::geometry
