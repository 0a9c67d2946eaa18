#include "src/delaunay/border/point_search.h"

#include <algorithm>
#include <bit>

namespace spillway::detail {

template <int D>
bool PointSearch<D>::may_hold_a_point(const ConflictRegion<D>& region) {
  // Of what is not tight, boxes leave nothing out.
  if (!region.tight() || siblings_.most_boxes == 0 || boxes_seen_ >= boxes_allowed_) {
    return std::any_of(siblings_.parts.begin(), siblings_.parts.end(),
                       [&](const Part<D>* part) { return region.may_meet_leaf(*part); });
  }
  for (std::size_t f = 0; f < std::min(found_count_, found_.size()); ++f) {
    if (region.may_hold(found_[f])) return true;
  }
  last_box_ = boxes_seen_ + siblings_.most_boxes;
  return std::any_of(siblings_.parts.begin(), siblings_.parts.end(),
                     [&](const Part<D>* part) { return in_part(region, *part); });
}

template <int D>
std::uint64_t PointSearch<D>::may_hold_points(const RegionBatch<D>& regions, std::uint64_t asked) {
  std::uint64_t near = 0;
  for (const Part<D>* part : siblings_.parts) near |= regions.may_meet_leaf(*part, asked & ~near);
  if (siblings_.most_boxes == 0 || boxes_seen_ >= boxes_allowed_) return near;
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
    if (boxes_seen_ == last_box_) return true;
    ++boxes_seen_;
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
    if (!region.may_hold(siblings_.points[p])) continue;
    found_[found_count_++ % found_.size()] = siblings_.points[p];
    return true;
  }
  return false;
}

template <int D>
bool asking_for_points_pays(std::span<const std::array<VertexId, D + 1>> sample,
                            std::span<const Point<D>> points, const Siblings<D>& siblings) {
  constexpr std::size_t kMostBoxesOfOne = 4096;  // on average; others take none
  PointSearch<D> search(siblings);
  std::size_t held = 0;
  for (const auto& corners : sample) {
    held += search.may_hold_a_point(ConflictRegion<D>(corners, points)) ? 1 : 0;
    if (search.boxes_seen() > sample.size() * kMostBoxesOfOne) return false;
  }
  return held <= sample.size() / 2;
}

template bool asking_for_points_pays<2>(std::span<const std::array<VertexId, 3>>,
                                        std::span<const Point<2>>, const Siblings<2>&);
template bool asking_for_points_pays<3>(std::span<const std::array<VertexId, 4>>,
                                        std::span<const Point<3>>, const Siblings<3>&);
template class PointSearch<2>;
template class PointSearch<3>;

}  // namespace spillway::detail
