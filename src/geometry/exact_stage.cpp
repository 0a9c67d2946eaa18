// The last stage of the predicates, apart from the others because big integers compile slowly.

#include "src/geometry/big_integer.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::geometry::stages {
template <typename P>
int exact(const Points<P>& points) {
  constexpr int D = P::kDimension;
  // All coordinates times one power of two are integers, and the sign stays the same.
  CommonScale scale;
  for (const auto& point : points) scale.include_point(point);
  Vectors<D, P::kVectors, BigInt> v;
  for (int k = 0; k < D; ++k) {
    const BigInt origin = scale.integer(points[P::kOrigin][k]);
    for (int i = 0; i < P::kVectors; ++i) v[i][k] = scale.integer(points[source<P>(i)][k]) - origin;
  }
  return sign(P::determinant(v));
}

#define SPILLWAY_INSTANTIATE(D)                                      \
  template int exact<Orientation<D>>(const Points<Orientation<D>>&); \
  template int exact<InSphere<D>>(const Points<InSphere<D>>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry::stages
