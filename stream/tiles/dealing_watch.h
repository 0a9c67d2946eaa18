#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/points/common/point_reader.h"
#include "stream/checkpoint/resting.h"

namespace spillway::stream {

/// Who looks on while a TileTree deals points. What it throws ends the dealing.
class DealingWatch : public Resting {
 public:
  /// Told of the points of each block before they are dealt; by many threads at a time.
  virtual void decoded(const PointBlock& /*points*/) {}

  /// The capacity of tiles once so many points have come, ascending; 0 to leave it as it is. What
  /// is known of tiles takes memory, so there must not be too many.
  [[nodiscard]] virtual std::size_t capacity_for(std::uint64_t /*points*/) { return 0; }

  /// Told how many tiles there are, or will be, when there are more.
  virtual void tiles_made(std::size_t /*tiles*/) {}

  /// Told of a cell of the plan that is complete: TileTree::take_cell() gives its tiles. One cell
  /// at a time, in an order that does not depend on threads, while other threads read on.
  virtual void cell_done(std::uint32_t /*cell*/) {}

  /// Told how many points have been dealt again, and what share that is of all for which this is
  /// known to be necessary, from 0 to 1.
  virtual void dealt_again(std::uint64_t /*points*/, double /*fraction*/) {}
};

}  // namespace spillway::stream
