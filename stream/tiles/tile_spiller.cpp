#include "stream/tiles/tile_spiller.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "src/parallel/parallel.h"
#include "stream/points/encoded_points.h"
#include "stream/points/point_sample.h"
#include "stream/tiles/cuts/tile_cut.h"
#include "stream/tiles/storage/parted_points.h"

namespace spillway::stream {
namespace {

/// Full buffers are emptied by this share of them.
constexpr std::size_t kSpillShare = 8;
/// Most segments of a tile that are told apart.
constexpr std::size_t kMostSegments = 6;
/// Points that go to the disk together are parted into segments if they are this share of the
/// capacity.
constexpr double kLeastPartedShare = 0.25;

}  // namespace

/// Tiles with larger weights go first: those that wait longest for points to come, and large ones.
double TileSpiller::weight(const Tile& tile) const {
  const RegionPlan* const plan = table_.options.plan;
  const std::uint64_t age =
      plan == nullptr ? table_.batches - tile.used
                      : plan->cells[tile.cell].done_after -
                            std::min(table_.regions_begun, plan->cells[tile.cell].done_after);
  return static_cast<double>(tile.waiting()) * static_cast<double>(1 + age);
}

void TileSpiller::spill_some(PointBatch& batch) {
  const std::size_t most = table_.most_room();
  if (table_.room <= most) return;
  struct Full {
    double weight;
    std::uint32_t tile;
  };
  std::vector<Full> full;
  const std::vector<Tile>& tiles = table_.tiles;
  for (std::uint32_t t = 0; t < tiles.size(); ++t) {
    if (!tiles[t].held.empty()) full.push_back({weight(tiles[t]), t});
  }
  std::ranges::sort(full, [&](const Full& a, const Full& b) {
    if (a.weight != b.weight) return a.weight > b.weight;
    return tiles[a.tile].box.lo < tiles[b.tile].box.lo;  // the numbers depend on threads
  });
  const std::size_t enough = most - most / kSpillShare;
  for (auto next = full.begin(); next != full.end() && table_.room > enough; ++next) {
    spill(next->tile, batch);
  }
}

void TileSpiller::spill(std::uint32_t number, PointBatch& batch) {
  Tile& tile = table_.tiles[number];
  const TileTreeOptions& options = table_.options;
  if (!tile.file) tile.file = folder_.create("tile");
  table_.room -= tile.room();
  std::vector<HeldPoints> parts = std::exchange(tile.held, {});
  const bool tiles_are_made = options.plan == nullptr && options.expected && options.extent;
  if (!table_.filled && !tiles_are_made) {  // it may be cut later
    std::vector<HeldPoints> whole = std::exchange(parts, {});
    for (HeldPoints& held : whole) append_segments_of(std::move(held), parts);
  }
  for (HeldPoints& held : parts) {
    auto stretch = std::make_shared<FileStretch>(tile.file);
    const std::uint64_t points = held.buffer.size();
    std::shared_ptr<CellSketch> sketch = sketches_.begin(tile, held, table_.points_to_come());
    tile.segments.push_back({.stretch = stretch,
                             .first_spill = tile.spills,
                             .end_spill = tile.spills + 1,
                             .points = points,
                             .arrival = held.arrival.value_or(arrivals_),
                             .box = held.box});
    if (sketch) tile.segments.back().sketches.push_back(sketch);
    if (!held.arrival) arrivals_ += points;
    ++tile.spills;
    ++table_.segments;
    batch.spills.push_back(
        {std::move(held.buffer), std::move(stretch), points, {}, std::move(sketch)});
  }
  if (tile.segments.size() <= kMostSegments || table_.filled || options.plan != nullptr) return;
  const std::size_t before = tile.segments.size();
  const std::lock_guard lock(table_.stretches_mutex);
  join_segments(tile.segments, kMostSegments, options.dimension);
  table_.segments -= before - tile.segments.size();
}

/// Appends parts of a buffer that are to be segments of their own, if it is a large one: they are
/// so small and compact that most will lie on one side of a cut, if the tile is cut later.
void TileSpiller::append_segments_of(HeldPoints held, std::vector<HeldPoints>& segments) const {
  const double points = static_cast<double>(held.buffer.size());
  if (points <= kLeastPartedShare * static_cast<double>(table_.capacity)) {
    segments.push_back(std::move(held));
    return;
  }
  const int dimension = table_.options.dimension;
  CrowdedTile crowded{.dimension = dimension, .box = held.box};
  PointSample sample(std::max<std::size_t>(1, held.buffer.size() / kCutSamples));
  held.buffer.visit([&](std::span<const LatticePoint> some) { sample.add(some); });
  crowded.sample = sample.take();
  const Cut first = choose_cut(crowded).value_or(kNoCut);
  std::array<Cut, 2> second = {kNoCut, kNoCut};
  for (const int side : {0, 1}) {
    CrowdedTile half{.dimension = dimension};
    for (const LatticePoint& p : crowded.sample) {
      if ((p[first.axis] >= first.value) == (side == 1)) half.sample.push_back(p);
    }
    for (const LatticePoint& p : half.sample) half.box.expand(p);
    if (!half.box.empty()) second[side] = choose_cut(half).value_or(kNoCut);
  }
  for (HeldPoints& some : part_points(std::move(held), first, second)) {
    if (some.buffer.size() > 0) segments.push_back(std::move(some));
  }
}

void TileSpiller::encode(PointBatch& batch) const {
  const StageTimer timer(times_, Stage::kSpill);
  for (Spill& spill : batch.spills) {
    if (spill.sketch) {
      spill.points.visit([&](std::span<const LatticePoint> some) { spill.sketch->gather(some); });
      spill.points.visit([&](std::span<const LatticePoint> some) { spill.sketch->measure(some); });
    }
    encode_points(spill.points, spill.bytes);
  }
}

void TileSpiller::write(PointBatch& batch) {
  StageTimer timer(times_, Stage::kSpill, StepOrder::kInOrder);
  for (const Spill& spill : batch.spills) {
    spill.stretch->append(spill.bytes, table_.stretches_mutex);
    timer.move_bytes(spill.bytes.size());
    bytes_written_ += spill.bytes.size();
    points_written_ += spill.count;
  }
  batch.spills.clear();
}

std::uint64_t TileSpiller::spill_complete(std::span<Tile* const> tiles) {
  constexpr std::size_t kTogether = 64;
  std::uint64_t memory = 0;
  std::shared_ptr<ScratchFile> file;
  PointBatch batch;
  const auto write_some = [&] {
    parallel_for(batch.spills.size(), 1, [&](std::size_t, std::size_t s, std::size_t) {
      encode_points(batch.spills[s].points, batch.spills[s].bytes);
    });
    write(batch);
  };
  for (Tile* const tile : tiles) {
    memory += tile->held_bytes();
    for (HeldPoints& held : std::exchange(tile->held, {})) {
      const std::uint64_t points = held.buffer.size();
      if (!file) file = folder_.create("complete");
      auto stretch = std::make_shared<FileStretch>(file);
      tile->segments.push_back({.stretch = stretch,
                                .first_spill = tile->spills,
                                .end_spill = tile->spills + 1,
                                .points = points,
                                .arrival = held.arrival_or_last(),
                                .box = held.box});
      ++tile->spills;
      batch.spills.push_back({std::move(held.buffer), std::move(stretch), points, {}, {}});
      if (batch.spills.size() == kTogether) write_some();
    }
  }
  write_some();
  return memory;
}

}  // namespace spillway::stream
