#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::terrain {

/// What there is to say of heights that come from the lowest one up, so that it depends on them
/// alone. Sums are of distances from the lowest, with their roundings (D. Knuth, "The Art of
/// Computer Programming" 2, 4.2.2, theorem B): the variance is no small difference of large sums.
class HeightStatistics {
 public:
  /// Must not be below the one before.
  void add(double z) {
    if (count_++ == 0) lowest_ = z;
    highest_ = z;
    const double distance = z - lowest_;
    distances_.add(distance);
    squares_.add(distance * distance);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }

  // Of one height at least.

  [[nodiscard]] double lowest() const { return lowest_; }
  [[nodiscard]] double highest() const { return highest_; }
  [[nodiscard]] double mean() const { return lowest_ + distances_.value() / number(); }
  /// The root of the mean squared distance from the mean: of the whole population, 0 of one height.
  [[nodiscard]] double deviation() const {
    const double mean_distance = distances_.value() / number();
    return std::sqrt(std::max(0.0, squares_.value() / number() - mean_distance * mean_distance));
  }

 private:
  /// A sum, and what rounding has taken from it.
  class Sum {
   public:
    void add(double number) {
      const double sum = sum_ + number;
      const double added = sum - sum_;
      lost_ += (sum_ - (sum - added)) + (number - added);
      sum_ = sum;
    }
    [[nodiscard]] double value() const { return sum_ + lost_; }

   private:
    double sum_ = 0;
    double lost_ = 0;
  };

  [[nodiscard]] double number() const { return static_cast<double>(count_); }

  std::uint64_t count_ = 0;
  double lowest_ = 0;
  double highest_ = 0;
  Sum distances_;
  Sum squares_;
};

/// Where a percentile lies among `count` ascending numbers: that share of the way from the number
/// of this rank, counted from 0, to the next one (R. Hyndman, Y. Fan, "Sample Quantiles in
/// Statistical Packages", 1996, definition 7, that of R and NumPy).
struct PercentilePlace {
  PercentilePlace(double percent, std::uint64_t count) {
    const double place = static_cast<double>(count - 1) * (percent / 100);
    rank = std::min(static_cast<std::uint64_t>(place), count - 1);
    share = rank + 1 < count ? place - static_cast<double>(rank) : 0;
  }

  std::uint64_t rank;
  double share;
};

}  // namespace spillway::terrain
