#include "stream/tiles/cut_tree.h"

#include <algorithm>

namespace spillway::detail {
namespace {

/// The axis on which the points lie farthest apart.
int longest_axis(const Point<3>* begin, const Point<3>* end, int dimension, double& lowest) {
  int longest = 0;
  double most = -1;
  for (int k = 0; k < dimension; ++k) {
    const auto [lo, hi] = std::minmax_element(
        begin, end, [k](const Point<3>& a, const Point<3>& b) { return a[k] < b[k]; });
    if ((*hi)[k] - (*lo)[k] > most) {
      most = (*hi)[k] - (*lo)[k];
      longest = k;
      lowest = (*lo)[k];
    }
  }
  return longest;
}

}  // namespace

CutTree::Place CutTree::make_cut(std::uint32_t tile, int axis, double value) {
  const auto place = static_cast<Place>(cuts_.size());
  const Place above = parents_[tile];
  const std::uint32_t other = tiles_++;
  cuts_.push_back({value, axis, {place_of(tile), place_of(other)}});
  if (above < 0) {
    root_ = place;
  } else {
    auto& sides = cuts_[above].sides;
    sides[sides[0] == place_of(tile) ? 0 : 1] = place;
  }
  parents_[tile] = place;
  parents_.push_back(place);
  cuts_above_.push_back(++cuts_above_[tile]);
  most_cuts_ = std::max(most_cuts_, cuts_above_.back());
  return place;
}

void CutTree::find_tiles(std::span<const Point<3>> points, std::span<std::uint32_t> tiles) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    Place place = root_;
    for (int step = 0; step < most_cuts_; ++step) {
      const Cut& cut = cuts_[std::max(place, 0)];
      const Place next = cut.sides[points[i][cut.axis] >= cut.value ? 1 : 0];
      place = place >= 0 ? next : place;
    }
    tiles[i] = tile_at(place);
  }
}

void CutTree::cut(std::uint32_t tile, int axis, double value) { make_cut(tile, axis, value); }

void CutTree::split(std::uint32_t tile, std::vector<Point<3>>& sample, std::size_t parts) {
  split_sample(tile, sample.data(), sample.data() + sample.size(), parts);
}

void CutTree::split_sample(std::uint32_t tile, Point<3>* begin, Point<3>* end, std::size_t parts) {
  if (parts < 2 || end - begin < 2) return;
  double lowest = 0;
  const int axis = longest_axis(begin, end, dimension_, lowest);
  const std::size_t low_parts = parts / 2;
  Point<3>* const middle = begin + static_cast<std::ptrdiff_t>(
                                       static_cast<std::size_t>(end - begin) * low_parts / parts);
  const auto below = [axis](const Point<3>& a, const Point<3>& b) { return a[axis] < b[axis]; };
  std::nth_element(begin, middle, end, below);
  double value = (*middle)[axis];
  if (value == lowest) {  // the next value, if there is any
    Point<3>* const next =
        std::partition(begin, end, [=](const Point<3>& p) { return p[axis] == lowest; });
    if (next == end) return;
    value = (*std::min_element(next, end, below))[axis];
  }
  Point<3>* const high =
      std::partition(begin, end, [=](const Point<3>& p) { return p[axis] < value; });
  make_cut(tile, axis, value);
  const std::uint32_t other = tiles_ - 1;
  split_sample(tile, begin, high, low_parts);
  split_sample(other, high, end, parts - low_parts);
}

}  // namespace spillway::detail
