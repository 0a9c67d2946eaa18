#include "src/delaunay/border/point_search.h"

#include <algorithm>

namespace spillway::detail {

template <int D>
bool PointSearch<D>::may_hold_a_point(const ConflictRegion<D>& region) {
  // Of what is not tight, boxes leave nothing out.
  if (!region.tight() || siblings_.most_boxes == 0) {
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

template class PointSearch<2>;
template class PointSearch<3>;

}  // namespace spillway::detail
