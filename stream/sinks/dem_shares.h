#pragma once
// The raster that several processes paint together: points and tiles of pixels go to the one that
// writes it.

#include "stream/sinks/dem.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

/// Gives away the points in pixels, then all that has been painted, tile by tile in ascending
/// order.
void give_share(Dem& dem, ShareSender& sender);

/// Takes the points of other processes; returns what they have painted, tile by tile in ascending
/// order, or null if there are none.
OtherTiles take_shares(OtherShares& others, Dem& dem);

}  // namespace spillway::stream
