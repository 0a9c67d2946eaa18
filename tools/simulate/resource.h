#pragma once

#include <span>
#include <string_view>

#include "tools/simulate/run_model.h"
#include "tools/simulate/run_player.h"

namespace spillway::command {

/// What a run may have to wait for.
enum class Resource : std::uint8_t {
  kCores,
  kMemory,  ///< for more threads
  kFetch,   ///< of batches of points, one at a time
  kAppend,  ///< of batches to tiles, one at a time
  kSpill,   ///< writing points to the disk, one batch at a time
  kWrite,   ///< of the output, one block at a time
  kDisk,
  kBatches,    ///< under way at a time
  kTiles,      ///< memory for more of them at a time
  kRoom,       ///< for output that waits for its turn
  kLoading,    ///< of tiles: reading, decoding, dividing
  kTopMerges,  ///< merges of tiles
  kEnds,       ///< what is before the first batch and after the last block
};

[[nodiscard]] std::span<const Resource> all_resources();

/// As tables and statistics call it.
[[nodiscard]] std::string_view name_of(Resource resource);

/// The run, and what it is played on, as if there were as much of the resource as can be used, or
/// as if it took no time.
void make_free(Resource resource, RunModel& run);
[[nodiscard]] SimulatedCores make_free(Resource resource, SimulatedCores on, const RunModel& run);

}  // namespace spillway::command
