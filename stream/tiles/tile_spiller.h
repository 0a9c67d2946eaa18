#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/runtime/stage_times.h"
#include "stream/tiles/point_batch.h"
#include "stream/tiles/tile_sketches.h"
#include "stream/tiles/tile_table.h"

namespace spillway::stream {

/// Brings points that wait to the disk: decides whose, encodes and writes them.
class TileSpiller {
 public:
  /// All must outlive it.
  TileSpiller(TileTable& table, TileSketches& sketches, ScratchFolder& folder, StageTimes& times)
      : table_(table), sketches_(sketches), folder_(folder), times_(times) {}

  /// Puts buffers of tiles into `batch` until there is room again, if there is too little: of the
  /// tiles that have not been used for long, or by the plan will not be complete for long, and
  /// large ones first.
  void spill_some(PointBatch& batch);
  /// All that waits of one tile.
  void spill(std::uint32_t number, PointBatch& batch);

  /// Encodes what a batch has to spill; by many threads at a time, each with a batch of its own.
  void encode(PointBatch& batch) const;
  /// Writes it; one batch at a time, in order.
  void write(PointBatch& batch);

  /// What waits of tiles that get no more points goes to the disk, all to one file, while no other
  /// thread is at work. Returns the bytes of memory that it took.
  std::uint64_t spill_complete(std::span<Tile* const> tiles);

  /// How many points were written to the disk, those written twice counted twice.
  [[nodiscard]] std::uint64_t points_written() const { return points_written_; }
  [[nodiscard]] std::uint64_t bytes_written() const { return bytes_written_; }

  template <typename State>
  void state(State& state) {
    state(arrivals_, points_written_, bytes_written_);
  }

 private:
  [[nodiscard]] double weight(const Tile& tile) const;
  void append_segments_of(HeldPoints held, std::vector<HeldPoints>& segments) const;

  TileTable& table_;
  TileSketches& sketches_;
  ScratchFolder& folder_;
  StageTimes& times_;
  std::uint64_t arrivals_ = 0;  ///< handed out so far
  std::uint64_t points_written_ = 0;
  std::uint64_t bytes_written_ = 0;
};

}  // namespace spillway::stream
