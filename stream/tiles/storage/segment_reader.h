#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/error.h"
#include "stream/tiles/storage/tile_segment.h"

namespace spillway::stream {

/// Some blocks of points as they lay in a scratch file.
struct StoredBlocks {
  std::vector<std::byte> bytes;
  FileSpot where;             ///< of the first byte, for messages
  std::uint64_t arrival = 0;  ///< of the first point
  std::uint64_t run = 0;      ///< the same, from 1 on, for segments that follow each other
};

/// Reads segments one after the other, and lets go of each after that.
class SegmentReader {
 public:
  SegmentReader() = default;
  /// All of them have been written. Runs are counted after `last_run`.
  explicit SegmentReader(std::vector<TileSegment> segments, std::uint64_t last_run = 0)
      : segments_(std::move(segments)), run_(last_run) {}

  /// Replaces `blocks` by the next ones, at least one, all of one segment; false at the end. Throws
  /// Failure if they cannot be read.
  bool fetch(StoredBlocks& blocks);

  /// Of the blocks so far.
  [[nodiscard]] std::uint64_t points() const { return points_; }
  [[nodiscard]] std::uint64_t last_run() const { return run_; }

  template <typename State>
  void state(State& state) {
    state(segments_, segment_, done_, points_done_, run_, points_);
  }

 private:
  void read(const FileStretch& stretch, StoredBlocks& blocks);

  std::vector<TileSegment> segments_;
  std::size_t segment_ = 0;
  std::uint64_t done_ = 0;         ///< bytes of the segment
  std::uint64_t points_done_ = 0;  ///< of the segment
  std::uint64_t run_ = 0;
  std::uint64_t points_ = 0;
};

}  // namespace spillway::stream
