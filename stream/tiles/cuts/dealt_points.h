#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "stream/points/points_view.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::stream {

/// Points of one tile, side by side.
struct PointRun {
  std::uint32_t tile = 0;
  std::size_t begin = 0;  ///< of DealtPoints::points
  std::size_t end = 0;
  Box<3> box;
};

/// Points grouped by tile, in each tile in the order in which they came.
struct DealtPoints {
  PointBlock points;
  std::vector<PointRun> runs;  ///< those with any points, by tile

  [[nodiscard]] PointsView points_of(const PointRun& run) const {
    return PointsView::of(points).subview(run.begin, run.end - run.begin);
  }

  /// Replaces all by the points of `block`.
  void deal(const CutTree& cuts, const PointBlock& block);

 private:
  std::vector<std::uint32_t> tile_;  ///< by point of the block
};

}  // namespace spillway::stream
