#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "src/geometry/point.h"
#include "src/runtime/memory_budget.h"

namespace spillway::stream {

/// What a base case of all points would take, by a few of them: where a leaf of a tile makes far
/// more simplices than usual, it knows nothing of those that cross its sides. Used by many threads.
template <int D>
class SampleForecast {
 public:
  /// Keeps some points of a tile, if it is larger than those before.
  void note(std::span<const Point<D>> tile);

  /// Triangulates what was kept; takes some milliseconds. Of nothing it is nothing: a process that
  /// goes on with merges, or makes those of others, may have loaded no tile.
  [[nodiscard]] WorkForecast forecast() const;

 private:
  mutable std::mutex mutex_;  ///< guards all others
  std::size_t tile_points_ = 0;
  std::vector<Point<D>> sample_;
};

}  // namespace spillway::stream
