#include "src/geometry/constructions/circumcentre.h"

#include <cmath>

#include "src/geometry/constructions/circumsphere.h"
#include "src/geometry/determinants.h"
#include "src/geometry/dimensions.h"

namespace spillway::geometry {

template <int D>
Point<D> circumcentre(const std::array<Point<D>, D + 1>& simplex) {
  constexpr double kAccuracy = 0x1p-41;  // half of what is promised: the bound is rounded itself
  const CertifiedBall<D> ball = certified_ball<D>(simplex);
  // The anchor lies on the sphere, so the radius is at least the length of `centre` less its error.
  const double radius = std::sqrt(squared_length(ball.centre)) - 2 * ball.error;
  if (!(ball.error <= kAccuracy * radius)) return exact_circumcentre<D>(simplex);
  Point<D> centre;
  for (int k = 0; k < D; ++k) centre[k] = ball.anchor[k] + ball.centre[k];
  return centre;
}

#define SPILLWAY_INSTANTIATE(D) \
  template Point<D> circumcentre<D>(const std::array<Point<D>, D + 1>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry
