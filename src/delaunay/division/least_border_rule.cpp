#include "src/delaunay/division/least_border_rule.h"

#include <vector>

#include "src/delaunay/division/axis_rule.h"
#include "src/delaunay/division/cut_judgement.h"
#include "src/delaunay/division/filled_share.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// A cut may be moved by one of so many points of the sample.
constexpr std::size_t kRoomShare = 8;

}  // namespace

template <int D>
std::optional<Cut> LeastBorderRule<D>::choose(const PointsToCut<D>& points) const {
  const AxisRule<D> longest_axis;
  if (points.count < options_.smallest_judged) return longest_axis.choose(points);
  const std::vector<Point<D>> judged = judged_sample<D>(points.sample);
  if (!is_hollow<D>(judged, points.box)) return longest_axis.choose(points);
  const CutJudgement<D> judgement(judged);
  if (!judgement.known()) return longest_axis.choose(points);
  const std::size_t room = options_.movable ? judged.size() / kRoomShare : 0;
  const JudgedCut best =
      judgement.best_cut(points.box.longest_axis(), points.share.of(judged.size()), room);
  if (best.share > kLargestCrossing && points.count <= options_.largest_undivided) {
    return std::nullopt;
  }
  const CutShare share = options_.movable ? CutShare{best.below, judged.size()} : points.share;
  return Cut{best.axis, value_at<D>(points.sample, best.axis, share)};
}

#define SPILLWAY_INSTANTIATE(D) template class LeastBorderRule<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
