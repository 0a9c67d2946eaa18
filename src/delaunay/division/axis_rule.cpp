#include "src/delaunay/division/axis_rule.h"

#include "src/geometry/dimensions.h"

namespace spillway::delaunay {

template <int D>
std::optional<Cut> AxisRule<D>::choose(const PointsToCut<D>& points) const {
  const Box<D>& box = points.box;
  int axis = box.longest_axis();
  if (scheme_ == Division::kCyclingAxis) axis = static_cast<int>(points.depth % D);
  if (scheme_ == Division::kConstantAxis) axis = 0;
  if (!(box.lo[axis] < box.hi[axis])) axis = box.longest_axis();
  return Cut{axis, value_at<D>(points.sample, axis, points.share)};
}

#define SPILLWAY_INSTANTIATE(D) template class AxisRule<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
