#pragma once

#include <functional>

#include "stream/points/points_view.h"
#include "stream/tiles/storage/tile.h"

namespace spillway::stream {

/// Calls `take` for the points of a tile, some thousand at a time, in the order in which they came,
/// and lets go of them. Throws BadInput for a scratch file that is not what it was.
void drain_points(StoredTile& stored, const std::function<void(const PointsView&)>& take);

}  // namespace spillway::stream
