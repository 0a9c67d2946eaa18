#include "src/geometry/constructions/half_space.h"

#include <algorithm>

#include "src/geometry/predicates.h"

namespace spillway::detail {

template <int D>
requires SupportedDimension<D> HalfSpace<D>::HalfSpace(const std::array<Point<D>, D>& facet)
    : facet_(facet) {
  // The signs of the normal's components are orientations of the facet's shadows.
  if constexpr (D == 2) {
    upwards_ = {facet[1][1]<facet[0][1], facet[1][0]> facet[0][0]};
  } else {
    for (int k = 0; k < D; ++k) {
      const int second = (k + 1) % D;
      const int third = (k + 2) % D;
      std::array<Point<2>, 3> shadow;
      for (int i = 0; i < D; ++i) shadow[i] = {facet[i][second], facet[i][third]};
      upwards_[k] = orientation<2>(shadow) > 0;
    }
  }
}

template <int D>
requires SupportedDimension<D>
bool HalfSpace<D>::meets(const Box<D>& box) const {
  if (box.empty()) return false;
  std::array<Point<D>, D + 1> simplex;
  std::copy(facet_.begin(), facet_.end(), simplex.begin());
  // An affine function is largest over a box at a corner, and the normal's signs tell at which.
  for (int k = 0; k < D; ++k) simplex[D][k] = upwards_[k] ? box.hi[k] : box.lo[k];
  return orientation<D>(simplex) >= 0;
}

template class HalfSpace<2>;
template class HalfSpace<3>;

}  // namespace spillway::detail
