#pragma once

#include <cstdint>
#include <vector>

#include "src/runtime/stage_times.h"
#include "stream/tiles/dealing_watch.h"
#include "stream/tiles/point_batch.h"
#include "stream/tiles/tile_divider.h"
#include "stream/tiles/tile_spiller.h"
#include "stream/tiles/tile_table.h"

namespace spillway::stream {

/// Deals points into the tiles' buffers, where they wait. A tile that has become too large is cut
/// in two at once.
class TileDealer {
 public:
  /// All must outlive it.
  TileDealer(TileTable& table, TileDivider& divider, TileSpiller& spiller, DealingWatch& watch,
             StageTimes& times)
      : table_(table), divider_(divider), spiller_(spiller), watch_(watch), times_(times) {}

  /// Groups the points of a batch by tile; by many threads at a time, each with a batch of its own.
  void deal(PointBatch& batch, const PointBlock& points) const;

  /// Puts them into the tiles' buffers, and takes out what has to go to the disk; one batch at a
  /// time, in order.
  void append(PointBatch& batch);

  /// Deals points that wait to the tiles there are now. What has to go to the disk is put into
  /// `batch`.
  void deal_waiting(std::vector<HeldPoints> held, PointBatch& batch);

 private:
  void append_dealt(const DealtPoints& dealt, PointBatch& batch);
  void append_points(std::uint32_t number, const PointsView& points, const Box<3>& box,
                     PointBatch& batch);

  TileTable& table_;
  TileDivider& divider_;
  TileSpiller& spiller_;
  DealingWatch& watch_;
  StageTimes& times_;
};

}  // namespace spillway::stream
