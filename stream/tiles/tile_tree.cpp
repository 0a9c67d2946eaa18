#include "stream/tiles/tile_tree.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/points/encoded_points.h"

namespace spillway::stream {
namespace {

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

/// Points that need no decoding.
class ReadyPoints final : public PointFeed {
 public:
  explicit ReadyPoints(const std::function<bool(PointBlock&)>& read) : read_(read) {}
  bool fetch(SourcePiece& piece) override { return read_(piece.raw.decoded); }
  void decode(SourcePiece& piece, PointBlock& block) override {
    std::swap(piece.raw.decoded, block);
  }

 private:
  const std::function<bool(PointBlock&)>& read_;
};

}  // namespace

/// The first steps of a batch whose points come from a feed.
class TileTree::FeedSteps {
 public:
  FeedSteps(TileTree& tree, PointFeed& feed) : tree_(tree), feed_(feed) {}

  bool fetch(PointBatch& batch) {
    if (!feed_.fetch(batch.piece)) return false;
    if (tree_.table_.options.plan != nullptr) {
      batch.arrival = batch.piece.arrival;
      batch.region = batch.piece.region;
      batch.run = batch.region + 1;
    }
    return true;
  }
  void decode(PointBatch& batch, PointBlock& points) {
    feed_.decode(batch.piece, points);
    if (!tree_.table_.options.index) points.index.clear();
    tree_.watch_.decoded(points);
  }

 private:
  TileTree& tree_;
  PointFeed& feed_;
};

/// Those of a batch that is read back from the disk.
class TileTree::StoredSteps {
 public:
  StoredSteps(SegmentReader& stored, StageTimes& times, const std::function<void()>& progress)
      : stored_(stored), times_(times), progress_(progress) {}

  bool fetch(PointBatch& batch) {
    progress_();
    if (!stored_.fetch(batch.stored)) return false;
    batch.arrival = batch.stored.arrival;
    batch.run = batch.stored.run;
    return true;
  }
  void decode(PointBatch& batch, PointBlock& points) const {
    const StageTimer timer(times_, Stage::kDeal);
    decode_all_points(batch.stored.bytes, batch.stored.where, points);
  }

 private:
  SegmentReader& stored_;
  StageTimes& times_;
  const std::function<void()>& progress_;
};

TileTree::TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times,
                   DealingWatch& watch)
    : times_(times),
      watch_(watch),
      table_(options),
      sketches_(options.dimension, options.sketch_bytes),
      spiller_(table_, sketches_, folder, times),
      divider_(table_, watch),
      dealer_(table_, divider_, spiller_, watch, times),
      loader_(table_, sketches_, times),
      cell_done_(table_.cell_roots.size()) {
  refuse_large_records(options.record_size);
}

void TileTree::fill(PointFeed& source) {
  run_to_rest(FeedSteps(*this, source));
  table_.filled = true;
  if (!table_.divided && table_.points > table_.capacity && !divider_.stays_whole()) {
    deal_waiting(divider_.divide_first());
  }
  if (table_.divided) divider_.cut_long();
}

void TileTree::fill(const std::function<bool(PointBlock&)>& source) {
  ReadyPoints points(source);
  fill(points);
}

/// Sends batches through the steps. Returns whether it came to an end since a checkpoint is due.
template <typename Steps>
bool TileTree::run_batches(Steps& steps) {
  std::vector<PointBatch> batches(table_.options.batches);
  SpareBlocks spare;
  bool is_first = true;
  bool at_rest = false;
  const std::vector<PipelineStep> pipeline = {
      {.in_order = false,
       .work =
           [&](std::size_t slot) {
             PointBlock& read = batches[slot].piece.raw.decoded;
             const bool is_decoded = read.size() > 0;  // then decode() only moves it
             PointBlock points = is_decoded ? PointBlock() : spare.take();
             steps.decode(batches[slot], points);
             dealer_.deal(batches[slot], points);
             if (is_decoded) {
               read = std::move(points);
             } else {
               spare.put_back(std::move(points));
             }
           }},
      {.in_order = true, .work = [&](std::size_t slot) { append(batches[slot]); }},
      {.in_order = false, .work = [&](std::size_t slot) { spiller_.encode(batches[slot]); }},
      {.in_order = true, .work = [&](std::size_t slot) {
         PointBatch& batch = batches[slot];
         spiller_.write(batch);
         // Only now everything of these cells is on the disk that has to go there.
         for (const std::uint32_t cell : std::exchange(batch.cells_done, {})) {
           watch_.cell_done(cell);
         }
       }}};
  run_pipeline(
      batches.size(),
      [&](std::size_t slot) {
        at_rest = !std::exchange(is_first, false) && watch_.rest_is_due();
        return !at_rest && steps.fetch(batches[slot]);
      },
      pipeline);
  return at_rest;
}

/// The same, which comes to an end each time that a checkpoint is due, and is begun again.
template <typename Steps>
void TileTree::run_to_rest(Steps steps) {
  while (run_batches(steps)) watch_.save();
}

void TileTree::append(PointBatch& batch) {
  const StageTimer timer(times_, Stage::kDeal, StepOrder::kInOrder);
  if (table_.options.plan != nullptr && !table_.filled) begin_region(batch.region, batch);
  dealer_.append(batch);
}

/// The regions before this one, by its position in the plan, have been read: their last cells are
/// complete.
void TileTree::begin_region(std::size_t region, PointBatch& batch) {
  const RegionPlan& plan = *table_.options.plan;
  for (std::size_t& begun = table_.regions_begun; begun < region; ++begun) {
    for (const std::uint32_t cell : plan.done_after[begun]) finish_cell(cell, batch);
  }
}

void TileTree::finish_cell(std::uint32_t cell, PointBatch& batch) {
  if (divider_.left_over_below(table_.cell_roots[cell])) return;
  divider_.cut_long_below(table_.cell_roots[cell]);
  loader_.take_below(table_.cell_roots[cell]);
  cell_done_[cell] = true;
  batch.cells_done.push_back(cell);
}

std::vector<std::uint32_t> TileTree::finish() {
  PointBatch last;
  for (const std::vector<std::uint32_t>& cells : table_.options.plan->done_after) {
    for (const std::uint32_t cell : cells) {
      if (!cell_done_[cell]) finish_cell(cell, last);
    }
  }
  return std::move(last.cells_done);
}

std::uint64_t TileTree::divide_large() {
  std::uint64_t all = dealt_again_ + points_to_divide();
  double fraction = 0;  // what is found to be too large again does not take it back
  const std::function<void()> progress = [&] {
    const std::uint64_t done = dealt_again_ + dealing_again_->points();
    all = std::max(all, done);
    fraction = std::max(fraction, static_cast<double>(done) / static_cast<double>(all));
    watch_.dealt_again(done, std::min(1.0, fraction));
  };
  while (is_to_divide()) {
    if (!dealing_again_) begin_dealing_again();
    run_to_rest(StoredSteps(*dealing_again_, times_, progress));
    table_.runs = dealing_again_->last_run();
    dealt_again_ += dealing_again_->points();
    dealing_again_.reset();
    for (Tile& tile : table_.tiles) {
      tile.expected = 0;
      tile.expected_box = {};
    }
    divider_.cut_long();
    all += points_to_divide();
  }
  return std::exchange(dealt_again_, 0);
}

/// Divides tiles that are too large; what is on the disk of them is left over, too.
void TileTree::begin_dealing_again() {
  for (std::uint32_t t = 0; t < table_.tiles.size(); ++t) {
    if (divider_.too_large(table_.tiles[t])) deal_waiting(divider_.divide(t));
  }
  dealing_again_.emplace(divider_.take_left_over(), table_.runs);
}

void TileTree::divide_evenly() {
  if (points() == 0) return;
  CutTree cuts = even_cuts(table_);
  if (cuts.tiles() == 1) return;
  for (Tile& tile : divider_.replace_tiles(std::move(cuts))) {
    table_.room -= tile.room();
    for (HeldPoints& held : tile.held) {
      if (held.arrival)
        held.run = ++table_.runs;  // points of other tiles may have had the same one
    }
    deal_waiting(std::move(tile.held));
    PointBatch batch;
    spiller_.spill_some(batch);
    spill(batch);
  }
  if (divider_.left_over_points() == 0) divider_.cut_long();
}

void TileTree::deal_waiting(std::vector<HeldPoints> held) {
  PointBatch batch;
  dealer_.deal_waiting(std::move(held), batch);
  spill(batch);
}

/// No batch is under way.
void TileTree::spill(PointBatch& batch) {
  if (batch.spills.empty()) return;
  spiller_.encode(batch);
  spiller_.write(batch);
}

template <int D>
std::optional<TileNode<D>> TileTree::take_nodes(const Box<D>& all) {
  loader_.take_below(table_.cuts.root());
  std::optional<TileNode<D>> root = loader_.nodes_below<D>(table_.cuts.root(), all);
  // What was known of tiles that were filled would take memory from those that are read.
  std::vector<Tile>(1).swap(table_.tiles);
  table_.cuts = CutTree(table_.options.dimension);
  return root;
}

std::uint64_t TileTree::held_bytes() const {
  std::uint64_t bytes = loader_.held_bytes();
  for (const Tile& tile : table_.tiles) bytes += tile.held_bytes();
  return bytes;
}

#define SPILLWAY_INSTANTIATE(D) \
  template std::optional<TileNode<D>> TileTree::take_nodes<D>(const Box<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
