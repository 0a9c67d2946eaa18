#pragma once

#include <cstddef>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::stream {

/// How a memory limit is shared out. Of this only the number of batches depends on the number of
/// threads, and the order of the output does not depend on that.
struct MemoryPlan {
  std::size_t buffered_points = 0;  ///< waiting in memory to be spilled
  std::size_t tile_room = 0;        ///< points of a tile, if two are loaded at a time
  std::size_t tile_points = 0;      ///< points of a tile, unless there are very many
  std::size_t leaf_points = 0;      ///< largest number of points of a leaf
  std::uint64_t waiting_bytes = 0;  ///< of output that waits for its turn while tiles are begun
  std::uint64_t sketch_bytes = 0;   ///< of what tells where the points of other tiles lie
  std::size_t batches = 1;          ///< of points, on their way to their tiles
  unsigned threads = 1;             ///< that the scratch memory of leaves leaves room for
};

/// The plan for a limit in bytes. `wanted_threads` is cut down to what there is memory for. Throws
/// TooSmallLimit with the least that is enough if this one is too small: of `whole`, if the limit
/// is a part of that. If tiles are triangulated `early`, while points wait for others, both
/// get less. `record_size`: bytes of the attributes that each point carries.
MemoryPlan plan_memory(std::uint64_t limit, int dimension, unsigned wanted_threads,
                       std::uint64_t whole = 0, bool early = false, std::size_t record_size = 0);

/// How many of so many threads a plan has for a triangulation in the plane, beside a product that
/// takes `own` bytes of the limit. Throws likewise.
unsigned threads_beside(std::uint64_t own, std::uint64_t limit, unsigned wanted_threads);

/// The capacity of tiles for `points` points: the plan's, and larger where that would be very many
/// tiles, as far as there is room.
std::size_t tile_points_for(std::uint64_t points, const MemoryPlan& plan);

/// The size of leaves of `points` points: at most plan.leaf_points, and smaller where there are few
/// points, so that all threads have something to do.
std::size_t leaf_points_for(std::uint64_t points, int dimension, const MemoryPlan& plan);

}  // namespace spillway::stream
