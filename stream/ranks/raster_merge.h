#pragma once

#include <cstdint>
#include <functional>

#include "formats/gdal/raster.h"
#include "src/distributed/ranks.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/sinks/dem.h"

namespace spillway::detail {

/// Paints what a merge between ranks made final.
void paint_merged(Dem& dem, const MergedSection& section);

/// Rank 0: writes the raster of what all ranks have painted, tile by tile, with what the others
/// send, some MiB at a time.
void write_raster_of_ranks(Dem& dem, Raster& raster,
                           const std::function<void(std::uint64_t pixels)>& progress,
                           const distributed::Ranks& ranks);

/// The other ranks: send all they have painted to rank 0.
void send_raster(Dem& dem, const distributed::Ranks& ranks);

}  // namespace spillway::detail
