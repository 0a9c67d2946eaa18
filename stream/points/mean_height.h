#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/geometry/exact_sum.h"
#include "src/rooms.h"

namespace spillway::stream {

/// The mean of the heights of equal points. It depends neither on their order nor on where they
/// were collected, and any number of them takes little memory.
class MeanHeight {
 public:
  void add(double height);

  /// Of at least one height; afterwards there are none.
  [[nodiscard]] double take();

 private:
  static constexpr std::size_t kMostKept = 4096;

  std::vector<double> kept_;  ///< while they are few: sorted, their sum is the same in any order
  geometry::ExactSum sum_;    ///< of all, once they are more
  std::uint64_t count_ = 0;
};

}  // namespace spillway::stream
