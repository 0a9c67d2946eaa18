#pragma once
// The raster that several processes paint together: tiles of pixels go to the one that writes it.

#include "stream/sinks/dem.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

/// Gives away all that has been painted, tile by tile in ascending order.
void give_tiles(Dem& dem, ShareSender& sender);

/// What other processes have painted, tile by tile in ascending order; null if there are none.
OtherTiles tiles_of_others(OtherShares& others);

}  // namespace spillway::stream
