#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "stream/points/point_feed.h"
#include "stream/tiles/cuts/dealt_points.h"
#include "stream/tiles/storage/segment_reader.h"
#include "stream/tiles/storage/tile.h"

namespace spillway::stream {

/// What goes through the pipeline of a TileTree at a time.
struct PointBatch {
  SourcePiece piece;                       ///< as it came from the source
  StoredBlocks stored;                     ///< or as read back from a file
  std::optional<std::uint64_t> arrival{};  ///< of the first point, if from a file
  std::uint64_t run = 0;                   ///< of points from a file or a region, else 0
  std::size_t region = 0;                  ///< by its position in the plan
  std::uint64_t cuts_made = 0;             ///< when it was dealt
  DealtPoints dealt;
  std::vector<Spill> spills;
  std::vector<std::uint32_t> cells_done;
};

}  // namespace spillway::stream
