#pragma once

#include <spillway/choices.h>

#include <cstdint>

#include "src/geometry/framed_point.h"
#include "stream/points/mean_height.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// Makes one point of any number of points that are one vertex: the same as choose_heights() (in
/// space keep_first()) would make of them, without having all in memory.
class EqualPoints {
 public:
  EqualPoints(int dimension, Heights choice);

  /// The next points, in the order in which they came. Their indices ascend in the order of the
  /// input; without these that is the order in which they come.
  void add(const PointsView& points);

  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// One point, with the index and attributes that points have. Of at least one point; to be called
  /// once.
  PointBlock choose();

 private:
  /// What is least is chosen.
  struct Rank {
    double height = 0;
    std::uint64_t place = 0;

    // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
    auto operator<=>(const Rank&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  [[nodiscard]] Rank rank_of(const LatticePoint& point, std::uint64_t place) const;

  double sign_ = 0;  ///< of heights in ranks: 1 for the lowest, -1 for the highest
  bool is_mean_;
  std::uint64_t count_ = 0;
  Rank least_{};
  PointBlock chosen_;
  MeanHeight mean_;
};

}  // namespace spillway::stream
