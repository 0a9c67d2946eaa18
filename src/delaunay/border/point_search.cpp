#include "src/delaunay/border/point_search.h"

#include <algorithm>
#include <bit>

#include "src/delaunay/common/tuning.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// What a point takes beside a box, about.
constexpr std::size_t kStepsOfPoint = 4;

}  // namespace

template <int D>
bool PointSearch<D>::may_hold_a_point(const ConflictRegion<D>& region) {
  // Of what is not tight, boxes leave nothing out.
  if (!region.tight() || siblings_.most_boxes == 0 || !may_ask()) {
    return std::any_of(siblings_.parts.begin(), siblings_.parts.end(),
                       [&](const Part<D>* part) { return region.may_meet_leaf(*part); });
  }
  for (std::size_t f = 0; f < std::min(found_count_, found_.size()); ++f) {
    if (region.may_hold(found_[f])) return true;
  }
  boxes_left_ = siblings_.most_boxes;
  const bool held = std::any_of(siblings_.parts.begin(), siblings_.parts.end(),
                                [&](const Part<D>* part) { return in_part(region, *part); });
  steps_earned_ += held ? 0 : Tuning<D>::kStepsOfNo;
  return held;
}

template <int D>
std::uint64_t PointSearch<D>::may_hold_points(const ConflictRegionBatch<D>& regions,
                                              std::uint64_t asked) {
  std::uint64_t near = 0;
  for (const Part<D>* part : siblings_.parts) near |= regions.may_meet_leaf(*part, asked & ~near);
  if (siblings_.most_boxes == 0 || !may_ask()) return near;
  std::uint64_t held = 0;
  for (; near != 0; near &= near - 1) {
    const int s = std::countr_zero(near);
    if (may_hold_a_point(regions.region(s))) held |= std::uint64_t{1} << s;
  }
  return held;
}

template <int D>
bool PointSearch<D>::in_part(const ConflictRegion<D>& region, const Part<D>& part) {
  if (!region.may_meet(part.box)) return false;
  if (part.leaf()) {
    const std::size_t levels = siblings_.boxes[part.list].levels();
    return levels == 0 || in_boxes(region, part, levels - 1, 0);
  }
  return std::any_of(part.children.begin(), part.children.end(),
                     [&](const Part<D>& child) { return in_part(region, child); });
}

/// Looks into kFanOut boxes of a level from `begin` on.
template <int D>
bool PointSearch<D>::in_boxes(const ConflictRegion<D>& region, const Part<D>& leaf,
                              std::size_t level, std::size_t begin) {
  const std::span<const Box<D>> boxes = siblings_.boxes[leaf.list].level(level);
  const std::size_t end = std::min(begin + RunBoxes<D>::kFanOut, boxes.size());
  for (std::size_t b = begin; b < end; ++b) {
    if (boxes_left_ == 0) return true;
    --boxes_left_;
    ++steps_;
    if (!region.may_meet(boxes[b])) continue;
    if (level > 0) {
      if (in_boxes(region, leaf, level - 1, b * RunBoxes<D>::kFanOut)) return true;
      continue;
    }
    const std::size_t first = leaf.begin + b * RunBoxes<D>::kRun;
    if (in_run(region, first, std::min<std::size_t>(first + RunBoxes<D>::kRun, leaf.end))) {
      return true;
    }
  }
  return false;
}

template <int D>
bool PointSearch<D>::in_run(const ConflictRegion<D>& region, std::size_t begin, std::size_t end) {
  for (std::size_t p = begin; p < end; ++p) {
    steps_ += kStepsOfPoint;
    if (!region.may_hold(siblings_.points[p])) continue;
    found_[found_count_++ % found_.size()] = siblings_.points[p];
    return true;
  }
  return false;
}

template <int D>
bool asking_for_points_pays(std::span<const std::array<VertexId, D + 1>> sample,
                            std::span<const Point<D>> points, const Siblings<D>& siblings) {
  constexpr std::size_t kMostStepsOfOne = 16'384;  // on average; others take none
  PointSearch<D> search(siblings);
  std::size_t held = 0;
  for (const auto& corners : sample) {
    held += search.may_hold_a_point(ConflictRegion<D>(corners, points)) ? 1 : 0;
    if (search.steps() > sample.size() * kMostStepsOfOne) return false;
  }
  return held <= sample.size() / 2;
}

#define SPILLWAY_INSTANTIATE(D)                                                           \
  template bool asking_for_points_pays<D>(std::span<const std::array<VertexId, D + 1>>,   \
                                          std::span<const Point<D>>, const Siblings<D>&); \
  template class PointSearch<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
