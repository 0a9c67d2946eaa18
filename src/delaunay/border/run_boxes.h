#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Boxes over short runs of points that lie in the order of a Hilbert curve, boxes over a few of
/// those boxes that follow each other, and so on: a tree without pointers.
template <int D>
class RunBoxes {
 public:
  static constexpr std::size_t kRun = 8;     ///< points of a box of the lowest level
  static constexpr std::size_t kFanOut = 4;  ///< boxes of the level below in one of each other

  RunBoxes() = default;
  explicit RunBoxes(std::span<const Point<D>> points);
  /// Over boxes that are the lowest level.
  explicit RunBoxes(std::vector<Box<D>> boxes);

  /// Number of levels; 0 without points. The highest one has at most kFanOut boxes.
  [[nodiscard]] std::size_t levels() const { return levels_.size(); }
  [[nodiscard]] std::span<const Box<D>> level(std::size_t l) const { return levels_[l]; }

 private:
  void add_levels();

  std::vector<std::vector<Box<D>>> levels_;  ///< the lowest one first
};

}  // namespace spillway::delaunay
