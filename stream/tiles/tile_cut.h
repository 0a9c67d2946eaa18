#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "stream/tiles/storage/tile_segment.h"

namespace spillway::detail {

/// A cut in two: below `value` on `axis`, and not below.
struct TileCut {
  int axis = 0;
  double value = 0;
};

/// What is known of a tile that has become too large.
struct CrowdedTile {
  int dimension = 2;
  Box<3> box{};                             ///< around all its points
  std::span<const TileSegment> segments{};  ///< those on the disk
  std::vector<LatticePoint> sample{};       ///< of those in memory
  double weight = 1;                        ///< points that each of the sample stands for
};

/// Where to cut it: into shares that are not too uneven, sides that are not too long, and so that
/// few segments lie on both sides. Nothing if all its points are equal. There are points on both
/// sides.
std::optional<TileCut> choose_cut(const CrowdedTile& tile);

/// The share of the points of `box` that lies below a cut, if they lie evenly. It may be 1 where a
/// few lie on the cut or above.
double share_below(const Box<3>& box, const TileCut& cut);

/// On which side of a cut all points of `box` lie: 0 is below. Nothing if that may be both; the box
/// is tight.
std::optional<int> side_of(const Box<3>& box, const TileCut& cut);

}  // namespace spillway::detail
