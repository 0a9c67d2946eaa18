#include "stream/tiles/tile_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/parallel/parallel.h"
#include "stream/tiles/point_sample.h"
#include "stream/tiles/tile_cut.h"

namespace spillway::detail {
namespace {

/// How full tiles are meant to get that are made of a sample: of all points; where those so far
/// show how all will lie; and where the density may turn out to be another.
constexpr double kKnownFill = 0.7;
constexpr double kRepresentativeFill = 0.6;
constexpr double kExpectedFill = 0.4;
/// A tile is cut in two when it is so full, with what it still expects.
constexpr double kMostFill = 0.9;
/// ... and has this share of its capacity itself, so that there is something to go by.
constexpr double kLeastOwnShare = 0.1;
/// Sampled points for each capacity of points, where many tiles are made at once; and for the cut
/// of one tile.
constexpr std::size_t kManySamples = 2048;
constexpr std::size_t kCutSamples = 256;
/// Full buffers are emptied by this share of them.
constexpr std::size_t kSpillShare = 8;
/// Most segments of a tile that are told apart.
constexpr std::size_t kMostSegments = 6;
/// What a tile and a segment take in memory, in points that wait.
constexpr std::size_t kTileRoom = 28;
constexpr std::size_t kSegmentRoom = 7;

std::size_t tiles_for(double points, std::size_t capacity, double fill) {
  const double tiles = points / (fill * static_cast<double>(capacity));
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(tiles)));
}

/// Whether not all points of that box are equal.
bool can_be_cut(const Box<3>& box, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    if (box.lo[k] < box.hi[k]) return true;
  }
  return false;
}

/// About every `stride`-th point of some buffers.
template <typename Held>
std::vector<LatticePoint> sample_of(const std::vector<Held>& held, std::size_t stride) {
  PointSample sample(stride);
  for (const Held& some : held) {
    some.buffer.visit([&](std::span<const LatticePoint> points) { sample.add(points); });
  }
  return sample.take();
}

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

std::size_t TileTree::Tile::room() const {
  std::size_t room = 0;
  for (const HeldPoints& some : held) room += some.buffer.room();
  return room;
}

std::size_t TileTree::Tile::waiting() const {
  std::size_t waiting = 0;
  for (const HeldPoints& some : held) waiting += some.buffer.size();
  return waiting;
}

TileTree::TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times)
    : options_(options), folder_(folder), times_(times), cuts_(options.dimension), tiles_(1) {
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
  run_batches(
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
  if (divided_ || points_ <= options_.capacity) return;
  Batch batch;  // nothing is spilled
  divide_first(batch);
}

void TileTree::fill(const std::function<bool(PointBlock&)>& source) {
  fill({.fetch = [&](SourcePiece& piece) { return source(piece.raw.decoded); },
        .decode = [](SourcePiece& piece,
                     PointBlock& block) { std::swap(piece.raw.decoded, block); }});
}

void TileTree::run_batches(const std::function<bool(Batch&)>& fetch,
                           const std::function<void(Batch&, PointBlock&)>& decode,
                           const CellDone& done) {
  std::vector<Batch> batches(options_.batches);
  SpareBlocks spare;
  const auto encode = [this](Batch& batch) {
    const StageTimer timer(times_, Stage::kSpill);
    for (Spill& spill : batch.spills) encode_points(spill.points, spill.bytes);
  };
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

/// Groups a batch's points by tile.
void TileTree::deal(Batch& batch, const PointBlock& points) const {
  const StageTimer timer(times_, Stage::kDeal);
  const std::shared_lock lock(cuts_mutex_);
  batch.cuts_made = cuts_made_;
  batch.dealt.deal(cuts_, points);
}

/// Puts a batch into the tiles' buffers, and takes out what has to go to the disk.
void TileTree::append(Batch& batch) {
  const StageTimer timer(times_, Stage::kDeal);
  ++batches_;
  if (options_.plan != nullptr && !filled_) begin_region(batch.region, batch);
  if (!filled_) points_ += batch.dealt.points.size();
  append_dealt(std::exchange(batch.dealt, {}), batch);
  if (room_ <= most_room()) return;
  if (!divided_) divide_first(batch);
  if (room_ > most_room()) spill_some(batch);
}

void TileTree::append_dealt(const DealtPoints& dealt, Batch& batch) {
  for (const PointRun& run : dealt.runs) {
    const auto points = std::span(dealt.points.points).subspan(run.begin, run.end - run.begin);
    const auto index = dealt.points.index.empty()
                           ? std::span<const std::uint64_t>()
                           : std::span<const std::uint64_t>(dealt.points.index)
                                 .subspan(run.begin, run.end - run.begin);
    if (tiles_[run.tile].cut_at <= batch.cuts_made) {
      append_points(run.tile, points, index, run.box, batch);
      continue;
    }
    PointBlock block;  // the tile has been cut since
    block.points.assign(points.begin(), points.end());
    block.index.assign(index.begin(), index.end());
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

void TileTree::append_points(std::uint32_t number, std::span<const LatticePoint> points,
                             std::span<const std::uint64_t> index, const Box<3>& box,
                             Batch& batch) {
  Tile& tile = tiles_[number];
  const bool other_run = !tile.held.empty() && tile.held.back().run != batch.run;
  if (other_run && options_.plan == nullptr) spill(number, batch);
  if (other_run || tile.held.empty()) {
    tile.held.push_back({.arrival = batch.arrival, .run = batch.run});
  }
  tile.used = batches_;
  put(tile.held.back(), tile, points, index, box);
  if (divided_ && outgrown(tile)) cut_in_two(number);
}

/// Puts points of that box into a buffer of a tile.
void TileTree::put(HeldPoints& held, Tile& tile, std::span<const LatticePoint> points,
                   std::span<const std::uint64_t> index, const Box<3>& box) {
  tile.points += points.size();
  tile.box.expand(box);
  held.box.expand(box);
  room_ -= held.buffer.room();
  held.buffer.append(points, index);
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
  for (HeldPoints& held : std::exchange(tile.held, {})) {
    auto stretch = std::make_shared<FileStretch>(tile.file);
    const std::uint64_t points = held.buffer.size();
    tile.segments.push_back({.stretch = stretch,
                             .first_spill = tile.spills,
                             .end_spill = tile.spills + 1,
                             .points = points,
                             .arrival = held.arrival.value_or(arrivals_),
                             .box = held.box});
    if (!held.arrival) arrivals_ += points;
    ++tile.spills;
    ++segments_;
    batch.spills.push_back({std::move(held.buffer), std::move(stretch), points, {}});
  }
  if (tile.segments.size() <= kMostSegments || filled_ || options_.plan != nullptr) return;
  const std::size_t before = tile.segments.size();
  const std::lock_guard lock(stretches_mutex_);
  join_segments(tile.segments, kMostSegments, options_.dimension);
  segments_ -= before - tile.segments.size();
}

void TileTree::write(Batch& batch) {
  const StageTimer timer(times_, Stage::kSpill);
  for (const Spill& spill : batch.spills) {
    spill.stretch->append(spill.bytes, stretches_mutex_);
    bytes_written_ += spill.bytes.size();
    points_written_ += spill.count;
  }
  batch.spills.clear();
}

/// Divides the one tile that there is at first, all of whose points are in memory, for those that
/// are to come, too, if it is known where they will lie.
void TileTree::divide_first(Batch& batch) {
  const Box<3> box = tiles_[0].box;
  const auto seen = static_cast<double>(tiles_[0].points);
  std::vector<LatticePoint> sample = sample_of(tiles_[0].held, sample_stride());
  std::size_t tile_count = tiles_for(seen, options_.capacity, kKnownFill);
  if (!filled_ && options_.extent && options_.expected.value_or(0) > tiles_[0].points) {
    const auto expected = static_cast<double>(*options_.expected);
    const bool everywhere = spans_extent(box, *options_.extent, options_.dimension);
    tile_count =
        tiles_for(expected, options_.capacity, everywhere ? kRepresentativeFill : kExpectedFill);
    if (!everywhere) {
      append_expected_points(sample, box, *options_.extent, options_.dimension,
                             expected / seen - 1);
    }
  }
  divided_ = true;
  divide(0, std::move(sample), tile_count, batch);
}

/// Divides a tile into many by a sample of its points; where that tells too little, by its box.
void TileTree::divide(std::uint32_t number, std::vector<LatticePoint> sample,
                      std::size_t tile_count, Batch& batch) {
  Tile whole = std::exchange(tiles_[number], {});
  const CutTree::NodeRef first_cut = cuts_.cuts();
  const auto first_new = static_cast<std::ptrdiff_t>(tiles_.size());
  {
    const std::unique_lock lock(cuts_mutex_);
    cuts_.split(number, sample, tile_count);
    if (cuts_.tiles() == tiles_.size()) {
      const auto cut = choose_cut({options_.dimension, whole.box, whole.segments, sample});
      if (!cut) {  // all points are equal
        tiles_[number] = std::move(whole);
        return;
      }
      cuts_.cut(number, cut->axis, cut->value);
    }
    tiles_[number].cut_at = ++cuts_made_;
  }
  tiles_.resize(cuts_.tiles());
  set_cell_root(number, whole.cell, first_cut);
  tiles_[number].cell = whole.cell;
  for (auto tile = tiles_.begin() + first_new; tile != tiles_.end(); ++tile)
    tile->cell = whole.cell;
  for (TileSegment& segment : whole.segments) leave_over(first_cut, std::move(segment));
  room_ -= whole.room();
  for (HeldPoints& held : whole.held) {
    Batch dealt;
    dealt.arrival = held.arrival;
    dealt.run = held.run;
    PointBlock points;
    held.buffer.drain(
        [&](std::span<const LatticePoint> chunk, std::span<const std::uint64_t> index) {
          points.points.assign(chunk.begin(), chunk.end());
          points.index.assign(index.begin(), index.end());
          deal(dealt, points);
          append_dealt(dealt.dealt, dealt);
        });
    std::ranges::move(dealt.spills, std::back_inserter(batch.spills));
  }
}

/// A tile has been cut: if it was a whole cell, that is now what is below the cut.
void TileTree::set_cell_root(std::uint32_t tile, std::uint32_t cell, CutTree::NodeRef cut) {
  if (options_.plan != nullptr && cell_roots_[cell] == CutTree::ref_of(tile))
    cell_roots_[cell] = cut;
}

bool TileTree::too_large(const Tile& tile) const {
  return tile.points > options_.capacity && can_be_cut(tile.box, options_.dimension);
}

/// Whether a tile is to be cut in two now.
bool TileTree::outgrown(const Tile& tile) const {
  if (filled_) return too_large(tile);
  const double capacity = static_cast<double>(options_.capacity);
  const double own = static_cast<double>(tile.points);
  if (own + tile.expected <= kMostFill * capacity || own < kLeastOwnShare * capacity) return false;
  return can_be_cut(tile.box, options_.dimension);
}

/// Cuts a tile in two, and a half again that is still too large.
void TileTree::cut_in_two(std::uint32_t number) {
  Tile whole = std::exchange(tiles_[number], {});
  std::ranges::stable_sort(whole.segments, {}, &TileSegment::arrival);
  const std::size_t stride = std::max<std::size_t>(1, whole.waiting() / kCutSamples);
  const CrowdedTile crowded{.dimension = options_.dimension,
                            .box = whole.box,
                            .segments = whole.segments,
                            .sample = sample_of(whole.held, stride),
                            .weight = static_cast<double>(stride)};
  const TileCut cut = *choose_cut(crowded);
  CutTree::NodeRef ref = 0;
  {
    const std::unique_lock lock(cuts_mutex_);
    ref = cuts_.cut(number, cut.axis, cut.value);
    ++cuts_made_;
  }
  set_cell_root(number, whole.cell, ref);
  const std::array<std::uint32_t, 2> halves = {number, static_cast<std::uint32_t>(tiles_.size())};
  tiles_.emplace_back();
  const double below = share_below(whole.box, cut);
  for (const int side : {0, 1}) {
    Tile& half = tiles_[halves[side]];
    half.expected = whole.expected * (side == 0 ? below : 1 - below);
    half.last_left_over = whole.last_left_over;
    half.used = whole.used;
    half.cut_at = cuts_made_;
    half.cell = whole.cell;
  }
  tiles_[number].file = std::move(whole.file);
  tiles_[number].spills = whole.spills;
  bool follows = false;
  for (TileSegment& segment : whole.segments) {
    if (const std::optional<int> side = side_of(segment.box, cut)) {
      Tile& half = tiles_[halves[*side]];
      half.box.expand(segment.box);
      half.points += segment.points;
      half.segments.push_back(std::move(segment));
      follows = false;
      continue;
    }
    // Later than all that were left over above: then the next one follows at once.
    segment.follows =
        std::exchange(follows, !whole.last_left_over || segment.arrival > *whole.last_left_over);
    for (const std::uint32_t half : halves) {
      tiles_[half].last_left_over =
          std::max(tiles_[half].last_left_over, std::optional(segment.arrival));
    }
    const double low_share = share_below(segment.box, cut);
    const auto points = static_cast<double>(segment.points);
    tiles_[halves[0]].expected += points * low_share;
    tiles_[halves[1]].expected += points * (1 - low_share);
    leave_over(ref, std::move(segment));
  }
  room_ -= whole.room();
  for (HeldPoints& held : whole.held) deal_to_halves(std::move(held), cut, halves);
  for (const std::uint32_t half : halves) {
    if (outgrown(tiles_[half])) cut_in_two(half);
  }
}

void TileTree::deal_to_halves(HeldPoints held, const TileCut& cut,
                              const std::array<std::uint32_t, 2>& halves) {
  std::array<PointBlock, 2> dealt;
  std::array<HeldPoints, 2> parts;
  for (HeldPoints& part : parts) {
    part.arrival = held.arrival;
    part.run = held.run;
  }
  held.buffer.drain([&](std::span<const LatticePoint> points,
                        std::span<const std::uint64_t> index) {
    std::array<Box<3>, 2> boxes;
    for (PointBlock& some : dealt) some.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int side = points[i][cut.axis] >= cut.value ? 1 : 0;
      dealt[side].points.push_back(points[i]);
      if (!index.empty()) dealt[side].index.push_back(index[i]);
      boxes[side].expand(points[i]);
    }
    for (const int side : {0, 1}) {
      if (dealt[side].size() == 0) continue;
      put(parts[side], tiles_[halves[side]], dealt[side].points, dealt[side].index, boxes[side]);
    }
  });
  for (const int side : {0, 1}) {
    if (parts[side].buffer.size() == 0) continue;
    tiles_[halves[side]].held.push_back(std::move(parts[side]));
  }
}

/// Points of a segment on both sides of a cut are dealt once all are in.
void TileTree::leave_over(CutTree::NodeRef cut, TileSegment segment) {
  if (left_over_.size() <= static_cast<std::size_t>(cut)) left_over_.resize(cut + 1);
  left_over_points_ += segment.points;
  left_over_[cut].push_back(std::move(segment));
}

std::uint64_t TileTree::points_to_divide() const {
  std::uint64_t points = left_over_points_;
  for (const Tile& tile : tiles_) points += too_large(tile) ? tile.points : 0;
  return points;
}

std::uint64_t TileTree::divide_large(const DivisionProgress& progress) {
  std::uint64_t all = points_to_divide();
  std::uint64_t done = 0;
  double fraction = 0;  // what is found to be too large again does not take it back
  while (points_to_divide() > 0) {
    Batch batch;
    for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
      if (!too_large(tiles_[t])) continue;
      std::vector<LatticePoint> sample = sample_of_all(tiles_[t]);
      divide(t, std::move(sample),
             tiles_for(static_cast<double>(tiles_[t].points), options_.capacity, kKnownFill),
             batch);
    }
    const std::uint64_t points = left_over_points_;
    deal_again(take_left_over(), [&](std::uint64_t some) {
      fraction = std::max(fraction, static_cast<double>(done + some) / static_cast<double>(all));
      progress(done + some, std::min(1.0, fraction));
    });
    done += points;
    all += points_to_divide();
  }
  return done;
}

/// Those of a cut before those of the cuts below it, so that what is dealt after each other goes to
/// tiles near each other.
std::vector<TileSegment> TileTree::take_left_over() {
  std::vector<TileSegment> segments;
  append_left_over(cuts_.root(), segments);
  left_over_.clear();
  left_over_points_ = 0;
  segments_ -= segments.size();
  return segments;
}

void TileTree::append_left_over(CutTree::NodeRef ref, std::vector<TileSegment>& segments) {
  if (CutTree::is_tile(ref)) return;
  if (static_cast<std::size_t>(ref) < left_over_.size()) {
    std::ranges::move(left_over_[ref], std::back_inserter(segments));
  }
  for (const CutTree::NodeRef side : cuts_.sides(ref)) append_left_over(side, segments);
}

/// A sample of all points of a tile, also of those on the disk.
std::vector<LatticePoint> TileTree::sample_of_all(const Tile& tile) const {
  PointSample sample(sample_stride());
  for (const HeldPoints& held : tile.held) {
    held.buffer.visit([&](std::span<const LatticePoint> points) { sample.add(points); });
  }
  SegmentReader reader(tile.segments);
  StoredBlocks blocks;
  PointBlock points;
  while (reader.fetch(blocks)) {
    decode_all_points(blocks.bytes, blocks.where, points);
    sample.add(points.points);
  }
  return sample.take();
}

/// Of samples by which many tiles are made at once.
std::size_t TileTree::sample_stride() const {
  return std::max<std::size_t>(1, options_.capacity / kManySamples);
}

void TileTree::deal_again(std::vector<TileSegment> segments,
                          const std::function<void(std::uint64_t points)>& progress) {
  SegmentReader reader(std::move(segments), runs_);
  run_batches(
      [&](Batch& batch) {
        progress(reader.points());
        if (!reader.fetch(batch.stored)) return false;
        batch.arrival = batch.stored.arrival;
        batch.run = batch.stored.run;
        return true;
      },
      [this](Batch& batch, PointBlock& points) {
        const StageTimer timer(times_, Stage::kDeal);
        decode_all_points(batch.stored.bytes, batch.stored.where, points);
      },
      {});
  runs_ = reader.last_run();
}

}  // namespace spillway::detail
