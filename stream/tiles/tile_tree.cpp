#include "stream/tiles/tile_tree.h"

#include <algorithm>
#include <utility>

#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// Full buffers are emptied by this share of them.
constexpr std::size_t kSpillShare = 8;
/// Most segments of a tile that are told apart.
constexpr std::size_t kMostSegments = 6;
/// What a tile and a segment take in memory, in points that wait.
constexpr std::size_t kTileRoom = 40;
constexpr std::size_t kSegmentRoom = 12;

/// Blocks that points are decoded into before they are dealt: as many as are decoded at a time.
class SpareBlocks {
 public:
  PointBlock take() {
    const std::lock_guard lock(mutex_);
    if (blocks_.empty()) return {};
    PointBlock block = std::move(blocks_.back());
    blocks_.pop_back();
    return block;
  }
  void put_back(PointBlock block) {
    const std::lock_guard lock(mutex_);
    blocks_.push_back(std::move(block));
  }

 private:
  std::mutex mutex_;
  std::vector<PointBlock> blocks_;  // guarded by mutex_
};

}  // namespace

TileTree::TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times)
    : options_(options),
      folder_(folder),
      times_(times),
      sketches_(options.dimension, options.sketch_bytes),
      cuts_(options.dimension),
      tiles_(1),
      capacity_(options.capacity) {
  refuse_large_records(options.record_size);
  if (options.plan == nullptr) return;
  cuts_ = options.plan->cuts;
  tiles_.resize(cuts_.tiles());
  for (std::uint32_t cell = 0; cell < tiles_.size(); ++cell) {
    tiles_[cell].cell = cell;
    cell_roots_.push_back(CutTree::ref_of(cell));
  }
  cell_done_.resize(tiles_.size());
  runs_ = options.plan->regions.size();  // each is a run
  divided_ = true;
}

void TileTree::fill(const PointFeed& source, const CellDone& done) {
  run_to_rest(
      [&](Batch& batch) {
        if (!source.fetch(batch.piece)) return false;
        if (options_.plan != nullptr) {
          batch.arrival = batch.piece.arrival;
          batch.region = batch.piece.region;
          batch.run = batch.region + 1;
        }
        return true;
      },
      [&](Batch& batch, PointBlock& points) {
        source.decode(batch.piece, points);
        if (!options_.index) points.index.clear();
      },
      done);
  filled_ = true;
  if (!divided_ && points_ > capacity_ && !stays_whole()) {
    Batch batch;  // nothing is spilled
    divide_first(batch);
  }
  if (divided_) cut_long();
}

void TileTree::fill(const std::function<bool(PointBlock&)>& source) {
  fill({.fetch = [&](SourcePiece& piece) { return source(piece.raw.decoded); },
        .decode = [](SourcePiece& piece,
                     PointBlock& block) { std::swap(piece.raw.decoded, block); }});
}

void TileTree::run_batches(const Fetch& fetch, const Decode& decode, const CellDone& done) {
  std::vector<Batch> batches(options_.batches);
  SpareBlocks spare;
  const std::vector<PipelineStep> steps = {
      {.in_order = false,
       .work =
           [&](std::size_t slot) {
             PointBlock& read = batches[slot].piece.raw.decoded;
             const bool is_decoded = read.size() > 0;  // then decode() only moves it
             PointBlock points = is_decoded ? PointBlock() : spare.take();
             decode(batches[slot], points);
             deal(batches[slot], points);
             if (is_decoded) {
               read = std::move(points);
             } else {
               spare.put_back(std::move(points));
             }
           }},
      {.in_order = true, .work = [&](std::size_t slot) { append(batches[slot]); }},
      {.in_order = false, .work = [&](std::size_t slot) { encode(batches[slot]); }},
      {.in_order = true, .work = [&](std::size_t slot) {
         Batch& batch = batches[slot];
         write(batch);
         // Only now everything of these cells is on the disk that has to go there.
         for (const std::uint32_t cell : std::exchange(batch.cells_done, {})) done(cell);
       }}};
  run_pipeline(
      batches.size(), [&](std::size_t slot) { return fetch(batches[slot]); }, steps);
}

/// As run_batches(), which comes to an end each time that a checkpoint is due, and is begun again.
void TileTree::run_to_rest(const Fetch& fetch, const Decode& decode, const CellDone& done) {
  for (bool at_rest = true; at_rest;) {
    at_rest = false;
    bool is_first = true;
    run_batches(
        [&](Batch& batch) {
          at_rest = !is_first && checkpointing_.due();
          is_first = false;
          return !at_rest && fetch(batch);
        },
        decode, done);
    if (at_rest) checkpointing_.save();
  }
}

/// Groups a batch's points by tile.
void TileTree::deal(Batch& batch, const PointBlock& points) const {
  const StageTimer timer(times_, Stage::kDeal);
  const std::shared_lock lock(cuts_mutex_);
  batch.cuts_made = cuts_made_;
  batch.dealt.deal(cuts_, points);
}

/// Puts a batch into the tiles' buffers, and takes out what has to go to the disk.
void TileTree::append(Batch& batch) {
  const StageTimer timer(times_, Stage::kDeal, StepOrder::kInOrder);
  ++batches_;
  if (options_.plan != nullptr && !filled_) begin_region(batch.region, batch);
  if (!filled_) {
    points_ += batch.dealt.points.size();
    if (options_.grown_capacity) capacity_ = options_.grown_capacity(points_);
  }
  const std::size_t tiles = tiles_.size();
  append_dealt(std::exchange(batch.dealt, {}), batch);
  if (room_ > most_room() && !divided_) divide_first(batch);
  if (tiles_.size() > tiles && options_.tiles_made) options_.tiles_made(tiles_.size());
  if (room_ > most_room()) spill_some(batch);
}

void TileTree::append_dealt(const DealtPoints& dealt, Batch& batch) {
  for (const PointRun& run : dealt.runs) {
    const PointsView points = dealt.points_of(run);
    if (tiles_[run.tile].cut_at <= batch.cuts_made) {
      append_points(run.tile, points, run.box, batch);
      continue;
    }
    PointBlock block;  // the tile has been cut since
    points.append_to(block);
    DealtPoints again;
    again.deal(cuts_, block);
    Batch now;
    now.arrival = batch.arrival;
    now.run = batch.run;
    now.cuts_made = cuts_made_;
    append_dealt(again, now);
    std::ranges::move(now.spills, std::back_inserter(batch.spills));
  }
}

void TileTree::append_points(std::uint32_t number, const PointsView& points, const Box<3>& box,
                             Batch& batch) {
  Tile& tile = tiles_[number];
  const bool other_run = !tile.held.empty() && tile.held.back().run != batch.run;
  if (other_run && options_.plan == nullptr) spill(number, batch);
  if (other_run || tile.held.empty()) {
    tile.held.push_back({.arrival = batch.arrival, .run = batch.run});
  }
  tile.used = batches_;
  put(tile.held.back(), tile, points, box);
  if (filled_) tile.expected = std::max(0.0, tile.expected - static_cast<double>(points.size()));
  if (divided_ && outgrown(tile)) cut_in_two(number, filled_);
}

/// Puts points of that box into a buffer of a tile.
void TileTree::put(HeldPoints& held, Tile& tile, const PointsView& points, const Box<3>& box) {
  tile.points += points.size();
  tile.box.expand(box);
  held.box.expand(box);
  room_ -= held.buffer.room();
  held.buffer.append(points);
  room_ += held.buffer.room();
}

/// The regions before this one, by its position in the plan, have been read: their last cells are
/// complete.
void TileTree::begin_region(std::size_t region, Batch& batch) {
  const RegionPlan& plan = *options_.plan;
  for (; regions_begun_ < region; ++regions_begun_) {
    for (const std::uint32_t cell : plan.done_after[regions_begun_]) finish_cell(cell, batch);
  }
}

void TileTree::finish_cell(std::uint32_t cell, Batch& batch) {
  if (left_over_below(cell_roots_[cell])) return;
  cut_long_below(cell_roots_[cell]);
  take_below(cell_roots_[cell]);
  cell_done_[cell] = true;
  batch.cells_done.push_back(cell);
}

bool TileTree::left_over_below(CutTree::NodeRef ref) const {
  if (CutTree::is_tile(ref)) return false;
  const auto cut = static_cast<std::size_t>(ref);
  if (cut < left_over_.size() && !left_over_[cut].empty()) return true;
  return std::ranges::any_of(cuts_.sides(ref),
                             [this](CutTree::NodeRef side) { return left_over_below(side); });
}

std::vector<std::uint32_t> TileTree::finish() {
  Batch last;
  for (const std::vector<std::uint32_t>& cells : options_.plan->done_after) {
    for (const std::uint32_t cell : cells) {
      if (!cell_done_[cell]) finish_cell(cell, last);
    }
  }
  return std::move(last.cells_done);
}

std::uint64_t TileTree::held_bytes() const {
  std::uint64_t bytes = 0;
  for (const Tile& tile : tiles_) bytes += tile.held_bytes();
  const std::lock_guard lock(taken_mutex_);
  for (const auto& [number, tile] : taken_) bytes += tile.held_bytes();
  return bytes;
}

/// All points, as far as is known.
std::uint64_t TileTree::points_to_come() const {
  return std::max<std::uint64_t>({points_, options_.expected.value_or(0), 1});
}

/// Room for points that wait, besides what the tiles themselves take.
std::size_t TileTree::most_room() const {
  const std::size_t taken =
      std::min(tiles_.size() * kTileRoom + segments_ * kSegmentRoom, options_.buffered_points / 2);
  return options_.buffered_points - taken;
}

/// Tiles with larger weights go first: those that wait longest for points to come, and large ones.
double TileTree::spill_weight(const Tile& tile) const {
  const std::uint64_t age =
      options_.plan == nullptr
          ? batches_ - tile.used
          : options_.plan->cells[tile.cell].done_after -
                std::min(regions_begun_, options_.plan->cells[tile.cell].done_after);
  return static_cast<double>(tile.waiting()) * static_cast<double>(1 + age);
}

/// Spills the buffers of the tiles that have not been used for long, or by the plan will not be
/// complete for long, and large ones first.
void TileTree::spill_some(Batch& batch) {
  struct Full {
    double weight;
    std::uint32_t tile;
  };
  std::vector<Full> full;
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    if (!tiles_[t].held.empty()) full.push_back({spill_weight(tiles_[t]), t});
  }
  std::ranges::sort(full, [this](const Full& a, const Full& b) {
    if (a.weight != b.weight) return a.weight > b.weight;
    return tiles_[a.tile].box.lo < tiles_[b.tile].box.lo;  // the numbers depend on threads
  });
  const std::size_t enough = most_room() - most_room() / kSpillShare;
  for (auto next = full.begin(); next != full.end() && room_ > enough; ++next) {
    spill(next->tile, batch);
  }
}

void TileTree::spill(std::uint32_t number, Batch& batch) {
  Tile& tile = tiles_[number];
  if (!tile.file) tile.file = folder_.create("tile");
  room_ -= tile.room();
  std::vector<HeldPoints> parts = std::exchange(tile.held, {});
  const bool tiles_are_made = options_.plan == nullptr && options_.expected && options_.extent;
  if (!filled_ && !tiles_are_made) {  // it may be cut later
    std::vector<HeldPoints> whole = std::exchange(parts, {});
    for (HeldPoints& held : whole) {
      append_segments_of(std::move(held), parts);
    }
  }
  for (HeldPoints& held : parts) {
    auto stretch = std::make_shared<FileStretch>(tile.file);
    const std::uint64_t points = held.buffer.size();
    std::shared_ptr<CellSketch> sketch = sketches_.begin(tile, held, points_to_come());
    tile.segments.push_back({.stretch = stretch,
                             .first_spill = tile.spills,
                             .end_spill = tile.spills + 1,
                             .points = points,
                             .arrival = held.arrival.value_or(arrivals_),
                             .box = held.box});
    if (sketch) tile.segments.back().sketches.push_back(sketch);
    if (!held.arrival) arrivals_ += points;
    ++tile.spills;
    ++segments_;
    batch.spills.push_back(
        {std::move(held.buffer), std::move(stretch), points, {}, std::move(sketch)});
  }
  if (tile.segments.size() <= kMostSegments || filled_ || options_.plan != nullptr) return;
  const std::size_t before = tile.segments.size();
  const std::lock_guard lock(stretches_mutex_);
  join_segments(tile.segments, kMostSegments, options_.dimension);
  segments_ -= before - tile.segments.size();
}

void TileTree::encode(Batch& batch) {
  const StageTimer timer(times_, Stage::kSpill);
  for (Spill& spill : batch.spills) {
    if (spill.sketch) {
      spill.points.visit([&](std::span<const LatticePoint> some) { spill.sketch->gather(some); });
      spill.points.visit([&](std::span<const LatticePoint> some) { spill.sketch->measure(some); });
    }
    encode_points(spill.points, spill.bytes);
  }
}

void TileTree::write(Batch& batch) {
  StageTimer timer(times_, Stage::kSpill, StepOrder::kInOrder);
  for (const Spill& spill : batch.spills) {
    spill.stretch->append(spill.bytes, stretches_mutex_);
    timer.move_bytes(spill.bytes.size());
    bytes_written_ += spill.bytes.size();
    points_written_ += spill.count;
  }
  batch.spills.clear();
}

}  // namespace spillway::detail
