#pragma once
// The steps of a run one by one, for programs that play it again.

#include <cstdint>
#include <string_view>

namespace spillway {

/// A stretch of the work of one thread, as the sums of StageSeconds are made of.
struct StageStep {
  std::string_view stage;     ///< as in StageSeconds
  bool in_order = false;      ///< of a kind that one thread at a time does, in order
  double seconds = 0;         ///< wall time
  double processor_time = 0;  ///< of the thread, in seconds
  std::uint64_t bytes = 0;    ///< that were read or written; 0: none, or not known
};

/// What bounds how much of a run can go on at the same time.
struct RunLimits {
  std::uint64_t batches = 0;        ///< of points, on their way to their tiles
  std::uint64_t tile_points = 0;    ///< that a tile counts for at most among the next
  std::uint64_t loaded_points = 0;  ///< of tiles that are worked on at a time, or one tile
  std::uint64_t ready_points = 0;   ///< of tiles, beyond one, before who reads lends a hand
  std::uint64_t waiting_bytes = 0;  ///< of output that waits for its turn while tiles are begun
  unsigned threads = 0;             ///< for which there is memory
};

}  // namespace spillway
