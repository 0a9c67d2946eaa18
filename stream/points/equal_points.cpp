#include "stream/points/equal_points.h"

#include <utility>

namespace spillway::stream {

EqualPoints::EqualPoints(int dimension, Heights choice)
    : is_mean_(dimension == 2 && choice == Heights::kMean) {
  if (dimension != 2) return;
  if (choice == Heights::kLowest) sign_ = 1;
  if (choice == Heights::kHighest) sign_ = -1;
}

EqualPoints::Rank EqualPoints::rank_of(const LatticePoint& point, std::uint64_t place) const {
  return {sign_ == 0 ? 0 : sign_ * point[2], place};
}

void EqualPoints::add(const PointsView& points) {
  for (std::size_t i = 0; i < points.size(); ++i, ++count_) {
    const LatticePoint& point = points.points[i];
    const Rank rank = rank_of(point, points.index.empty() ? count_ : points.index[i]);
    if (count_ == 0 || rank < least_) {
      least_ = rank;
      chosen_.clear();
      points.subview(i, 1).append_to(chosen_);
    }
    if (is_mean_) mean_.add(point[2]);
  }
}

PointBlock EqualPoints::choose() {
  if (is_mean_) chosen_.points.front()[2] = mean_.take();
  return std::move(chosen_);
}

}  // namespace spillway::stream
