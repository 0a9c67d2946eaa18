#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats::laz {

/// A running median of five: a new value pushes out the largest or the smallest in turn. Sorting is
/// a row of minima and maxima without a branch, as the values are noise to a branch predictor.
class StreamingMedian {
 public:
  [[nodiscard]] std::int32_t get() const { return sorted_[2]; }

  void add(std::int32_t value) {
    const std::int32_t median = sorted_[2];
    const std::int32_t* kept = sorted_.data() + (drop_largest_ ? 0 : 1);
    std::array<std::int32_t, 5> next;
    std::int32_t rest = value;
    for (int i = 0; i < 4; ++i) {
      next[i] = std::min(kept[i], rest);
      rest = std::max(kept[i], rest);
    }
    next[4] = rest;
    sorted_ = next;
    drop_largest_ = drop_largest_ ? value < median : value <= median;
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drop_largest_ = true;
};

}  // namespace spillway::formats::laz
