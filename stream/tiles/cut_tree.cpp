#include "stream/tiles/cut_tree.h"

#include <algorithm>

namespace spillway::detail {
namespace {

/// The axis on which the points lie farthest apart.
int longest_axis(const LatticePoint* begin, const LatticePoint* end, int dimension,
                 double& lowest) {
  int longest = 0;
  double most = -1;
  for (int k = 0; k < dimension; ++k) {
    const auto [lo, hi] = std::minmax_element(
        begin, end, [k](const LatticePoint& a, const LatticePoint& b) { return a[k] < b[k]; });
    if ((*hi)[k] - (*lo)[k] > most) {
      most = (*hi)[k] - (*lo)[k];
      longest = k;
      lowest = (*lo)[k];
    }
  }
  return longest;
}

}  // namespace

CutTree::NodeRef CutTree::make_cut(std::uint32_t tile, int axis, double value) {
  const auto ref = static_cast<NodeRef>(cuts_.size());
  const NodeRef above = parents_[tile];
  const std::uint32_t other = tiles_++;
  cuts_.push_back({value, axis, {ref_of(tile), ref_of(other)}});
  if (above < 0) {
    root_ = ref;
  } else {
    auto& sides = cuts_[above].sides;
    sides[sides[0] == ref_of(tile) ? 0 : 1] = ref;
  }
  parents_[tile] = ref;
  parents_.push_back(ref);
  cuts_above_.push_back(++cuts_above_[tile]);
  most_cuts_ = std::max(most_cuts_, cuts_above_.back());
  return ref;
}

void CutTree::find_tiles(std::span<const LatticePoint> points,
                         std::span<std::uint32_t> tiles) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    NodeRef ref = root_;
    for (int step = 0; step < most_cuts_; ++step) {
      const Cut& cut = cuts_[std::max(ref, 0)];
      const NodeRef next = cut.sides[points[i][cut.axis] >= cut.value ? 1 : 0];
      ref = ref >= 0 ? next : ref;
    }
    tiles[i] = tile_at(ref);
  }
}

void CutTree::cut(std::uint32_t tile, int axis, double value) { make_cut(tile, axis, value); }

void CutTree::split(std::uint32_t tile, std::vector<LatticePoint>& sample, std::size_t parts) {
  split_sample(tile, sample.data(), sample.data() + sample.size(), parts);
}

void CutTree::split_sample(std::uint32_t tile, LatticePoint* begin, LatticePoint* end,
                           std::size_t parts) {
  if (parts < 2 || end - begin < 2) return;
  double lowest = 0;
  const int axis = longest_axis(begin, end, dimension_, lowest);
  const std::size_t low_parts = parts / 2;
  LatticePoint* const middle =
      begin +
      static_cast<std::ptrdiff_t>(static_cast<std::size_t>(end - begin) * low_parts / parts);
  const auto below = [axis](const LatticePoint& a, const LatticePoint& b) {
    return a[axis] < b[axis];
  };
  std::nth_element(begin, middle, end, below);
  double value = (*middle)[axis];
  if (value == lowest) {  // the next value, if there is any
    LatticePoint* const next =
        std::partition(begin, end, [=](const LatticePoint& p) { return p[axis] == lowest; });
    if (next == end) return;
    value = (*std::min_element(next, end, below))[axis];
  }
  LatticePoint* const high =
      std::partition(begin, end, [=](const LatticePoint& p) { return p[axis] < value; });
  make_cut(tile, axis, value);
  const std::uint32_t other = tiles_ - 1;
  split_sample(tile, begin, high, low_parts);
  split_sample(other, high, end, parts - low_parts);
}

}  // namespace spillway::detail
