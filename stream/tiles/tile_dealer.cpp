#include "stream/tiles/tile_dealer.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <utility>

namespace spillway::stream {

void TileDealer::deal(PointBatch& batch, const PointBlock& points) const {
  const StageTimer timer(times_, Stage::kDeal);
  const std::shared_lock lock(table_.cuts_mutex);
  batch.cuts_made = table_.cuts_made;
  batch.dealt.deal(table_.cuts, points);
}

void TileDealer::append(PointBatch& batch) {
  ++table_.batches;
  if (!table_.filled) {
    table_.points += batch.dealt.points.size();
    if (const std::size_t grown = watch_.capacity_for(table_.points)) table_.capacity = grown;
  }
  const std::size_t tiles = table_.tiles.size();
  append_dealt(std::exchange(batch.dealt, {}), batch);
  if (table_.room > table_.most_room() && !table_.divided) {
    deal_waiting(divider_.divide_first(), batch);
  }
  if (table_.tiles.size() > tiles) watch_.tiles_made(table_.tiles.size());
  spiller_.spill_some(batch);
}

void TileDealer::append_dealt(const DealtPoints& dealt, PointBatch& batch) {
  for (const PointRun& run : dealt.runs) {
    const PointsView points = dealt.points_of(run);
    if (table_.tiles[run.tile].cut_at <= batch.cuts_made) {
      append_points(run.tile, points, run.box, batch);
      continue;
    }
    PointBlock block;  // the tile has been cut since
    points.append_to(block);
    DealtPoints again;
    again.deal(table_.cuts, block);
    PointBatch now;
    now.arrival = batch.arrival;
    now.run = batch.run;
    now.cuts_made = table_.cuts_made;
    append_dealt(again, now);
    std::ranges::move(now.spills, std::back_inserter(batch.spills));
  }
}

void TileDealer::append_points(std::uint32_t number, const PointsView& points, const Box<3>& box,
                               PointBatch& batch) {
  Tile& tile = table_.tiles[number];
  const bool other_run = !tile.held.empty() && tile.held.back().run != batch.run;
  if (other_run && table_.options.plan == nullptr) spiller_.spill(number, batch);
  if (other_run || tile.held.empty()) {
    tile.held.push_back({.arrival = batch.arrival, .run = batch.run});
  }
  tile.used = table_.batches;
  table_.put(tile.held.back(), tile, points, box);
  if (table_.filled) {
    tile.expected = std::max(0.0, tile.expected - static_cast<double>(points.size()));
  }
  if (table_.divided) divider_.cut_outgrown(number);
}

void TileDealer::deal_waiting(std::vector<HeldPoints> held, PointBatch& batch) {
  for (HeldPoints& some : held) {
    PointBatch dealt;
    dealt.arrival = some.arrival;
    dealt.run = some.run;
    some.buffer.drain_in_chunks([&](const PointBlock& points) {
      deal(dealt, points);
      append_dealt(dealt.dealt, dealt);
    });
    std::ranges::move(dealt.spills, std::back_inserter(batch.spills));
  }
}

}  // namespace spillway::stream
