#pragma once
// The raster that several processes paint together: tiles of pixels go to the one that writes it.

#include <cstdint>
#include <functional>

#include "formats/gdal/raster.h"
#include "stream/sinks/dem.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

/// Gives away all that has been painted, tile by tile in ascending order.
void give_tiles(Dem& dem, ShareSender& sender);

/// Writes the raster of what all processes have painted, as Dem::write().
void write_with_others(Dem& dem, OtherShares& others, Raster& raster,
                       const std::function<void(std::uint64_t pixels)>& progress);

}  // namespace spillway::stream
