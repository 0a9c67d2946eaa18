// From one tile to many: the first division, tiles that have outgrown their share, and what is
// dealt once more when all points are in.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "stream/tiles/cuts/sample_division.h"
#include "stream/tiles/point_sample.h"
#include "stream/tiles/tile_cut.h"
#include "stream/tiles/tile_tree.h"

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
/// Points that go to the disk together are parted into segments if they are this share of it.
constexpr double kLeastPartedShare = 0.25;
/// All points lie below it.
constexpr TileCut kNoCut{.axis = 0, .value = std::numeric_limits<double>::infinity()};
/// Sampled points for each capacity of points, where many tiles are made at once; and for the cut
/// of one tile.
constexpr std::size_t kManySamples = 2048;
constexpr std::size_t kCutSamples = 256;
/// Points that stand for those to come are as many as a share of those that may wait in memory.
constexpr std::uint64_t kExpectedShare = 8;

std::size_t tiles_for(double points, std::size_t capacity, double fill) {
  const double tiles = points / (fill * static_cast<double>(capacity));
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(tiles)));
}

/// Whether a sample of so many points has enough of them for each of so many tiles.
bool is_telling(std::span<const LatticePoint> sample, std::size_t tiles) {
  constexpr std::size_t kPointsOfTile = 64;
  return sample.size() / kPointsOfTile >= tiles;
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

/// The points of a buffer on both sides of a cut, or of a second one on each side of the first.
std::vector<HeldPoints> part(HeldPoints held, const TileCut& first,
                             const std::array<TileCut, 2>& second) {
  constexpr std::size_t kParts = 4;
  std::vector<HeldPoints> parts(kParts);
  for (HeldPoints& part : parts) {
    part.arrival = held.arrival;
    part.run = held.run;
  }
  constexpr std::size_t kMost = PointBuffer::kPagePoints;
  PointBlock dealt;
  dealt.points.resize(kParts * kMost);
  held.buffer.drain([&](const PointsView& some) {
    const std::size_t record = some.record_size();
    if (!some.index.empty()) dealt.index.resize(dealt.size());
    dealt.attributes.resize(dealt.size() * record);
    std::array<std::size_t, kParts> counts{};
    for (std::size_t i = 0; i < some.size(); ++i) {
      const LatticePoint& point = some.points[i];
      const std::size_t side = point[first.axis] >= first.value ? 1 : 0;
      const TileCut& next = second[side];
      const std::size_t part = 2 * side + (point[next.axis] >= next.value ? 1 : 0);
      const std::size_t place = part * kMost + counts[part]++;
      dealt.points[place] = point;
      if (!some.index.empty()) dealt.index[place] = some.index[i];
      if (record > 0) {
        std::memcpy(&dealt.attributes[place * record], &some.attributes[i * record], record);
      }
    }
    for (std::size_t p = 0; p < kParts; ++p) {
      const PointsView of_part = PointsView::of(dealt).subview(p * kMost, counts[p]);
      for (const LatticePoint& point : of_part.points) parts[p].box.expand(point);
      parts[p].buffer.append(of_part);
    }
  });
  return parts;
}

/// A sample of all points of a tile, also of those on the disk.
std::vector<LatticePoint> sample_of_all(const Tile& tile, std::size_t stride) {
  PointSample sample(stride);
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

}  // namespace

/// Whether all points, which are in memory, had better be one tile; it may have so many then.
bool TileTree::stays_whole() {
  if (points_ > options_.largest_undivided || options_.plan != nullptr) return false;
  const std::vector<LatticePoint> sample = sample_of(tiles_[0].held, sample_stride());
  if (!is_clearly_hollow(sample, options_.dimension) || some_cut_pays(sample, options_.dimension)) {
    return false;
  }
  capacity_ = std::max<std::size_t>(capacity_, points_);
  return true;
}

/// Divides the one tile that there is at first, all of whose points are in memory, for those that
/// are to come, too, if it is known where they will lie.
void TileTree::divide_first(Batch& batch) {
  const Box<3> box = tiles_[0].box;
  const std::uint64_t seen = tiles_[0].points;
  const std::uint64_t all = std::min(options_.expected.value_or(0),
                                     std::numeric_limits<std::uint64_t>::max() / kExpectedShare);
  const bool tells = !filled_ && options_.extent && all > seen;
  divided_ = true;
  const std::size_t known_tiles =
      tiles_for(static_cast<double>(all), capacity_, kRepresentativeFill);
  if (tells && is_telling(options_.sample, known_tiles)) {
    divide(0, std::exchange(options_.sample, {}), known_tiles, batch);
    return;
  }
  const bool everywhere = tells && spans_extent(box, *options_.extent, options_.dimension);
  std::size_t stride = sample_stride();
  if (tells && !everywhere) {
    stride = std::max<std::size_t>(stride, kExpectedShare * all / options_.buffered_points);
  }
  std::vector<LatticePoint> sample = sample_of(tiles_[0].held, stride);
  double points = static_cast<double>(seen);
  double fill = kKnownFill;
  if (tells) {
    points = static_cast<double>(all);
    fill = everywhere ? kRepresentativeFill : kExpectedFill;
  }
  const bool representative = !tells || everywhere;
  if (!representative) {
    append_expected_points(sample, box, *options_.extent, options_.dimension,
                           points / static_cast<double>(seen) - 1);
  }
  divide(0, std::move(sample), tiles_for(points, capacity_, fill), batch, representative);
}

/// Divides a tile into many by a sample of its points; where that tells too little, by its box.
/// Only a representative sample tells whether they are hollow.
void TileTree::divide(std::uint32_t number, std::vector<LatticePoint> sample,
                      std::size_t tile_count, Batch& batch, bool representative) {
  if (options_.tiles_made) options_.tiles_made(tiles_.size() + tile_count - 1);
  Tile whole = std::exchange(tiles_[number], {});
  const CutTree::NodeRef first_cut = cuts_.cuts();
  const auto first_new = static_cast<std::ptrdiff_t>(tiles_.size());
  const bool hollow = representative && is_clearly_hollow(sample, options_.dimension);
  const std::vector<DivisionCut> judged =
      hollow ? divide_sample(sample, tile_count, options_.dimension) : std::vector<DivisionCut>{};
  {
    const std::unique_lock lock(cuts_mutex_);
    if (hollow) {
      cuts_.split(number, judged);
    } else {
      cuts_.split(number, sample, tile_count);
    }
    if (cuts_.tiles() == tiles_.size()) {
      const auto cut = choose_cut({.dimension = options_.dimension,
                                   .box = whole.box,
                                   .expected = whole.expected_box,
                                   .segments = whole.segments,
                                   .sample = sample});
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
  for (TileSegment& segment : whole.segments) {
    whole.last_left_over = std::max(whole.last_left_over, std::optional(segment.last_arrival()));
    leave_over(first_cut, std::move(segment));
  }
  const auto take_from_whole = [&](Tile& tile) {
    tile.cell = whole.cell;
    tile.last_left_over = whole.last_left_over;
  };
  take_from_whole(tiles_[number]);
  std::for_each(tiles_.begin() + first_new, tiles_.end(), take_from_whole);
  if (representative) judge_tiles(sample);
  room_ -= whole.room();
  for (HeldPoints& held : whole.held) deal_held(std::move(held), batch);
}

/// Tells which tiles are hollow, of those that have enough of a sample.
void TileTree::judge_tiles(std::span<const LatticePoint> sample) {
  std::vector<std::uint32_t> numbers(sample.size());
  cuts_.find_tiles(sample, numbers);
  std::vector<std::vector<LatticePoint>> samples(tiles_.size());
  for (std::size_t i = 0; i < sample.size(); ++i) samples[numbers[i]].push_back(sample[i]);
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (!samples[t].empty()) tiles_[t].hollow = is_clearly_hollow(samples[t], options_.dimension);
  }
}

/// Deals points that wait to the tiles there are now.
void TileTree::deal_held(HeldPoints held, Batch& batch) {
  Batch dealt;
  dealt.arrival = held.arrival;
  dealt.run = held.run;
  held.buffer.drain_in_chunks([&](const PointBlock& points) {
    deal(dealt, points);
    append_dealt(dealt.dealt, dealt);
  });
  std::ranges::move(dealt.spills, std::back_inserter(batch.spills));
}

/// A tile has been cut: if it was a whole cell, that is now what is below the cut.
void TileTree::set_cell_root(std::uint32_t tile, std::uint32_t cell, CutTree::NodeRef cut) {
  if (options_.plan != nullptr && cell_roots_[cell] == CutTree::ref_of(tile))
    cell_roots_[cell] = cut;
}

bool TileTree::too_large(const Tile& tile) const {
  return tile.points > capacity_ && can_be_cut(tile.box, options_.dimension);
}

/// Whether a tile is going to be, with the points still to come.
bool TileTree::will_be_too_large(const Tile& tile) const {
  return tile.points > 0 && can_be_cut(tile.box, options_.dimension) &&
         static_cast<double>(tile.points) + tile.expected > static_cast<double>(capacity_);
}

/// Whether a tile is to be cut in two now.
bool TileTree::outgrown(const Tile& tile) const {
  if (filled_) return too_large(tile);
  const auto capacity = static_cast<double>(capacity_);
  const double own = static_cast<double>(tile.points);
  if (own + tile.expected <= kMostFill * capacity || own < kLeastOwnShare * capacity) return false;
  return can_be_cut(tile.box, options_.dimension);
}

/// Whether a tile is, with the points still to come. A side is not short that no cut has made so. A
/// hollow tile may be as long as it likes: its points are few beside any side.
bool TileTree::is_too_long(std::uint32_t number) const {
  const Tile& tile = tiles_[number];
  if (tile.points == 0 || tile.hollow) return false;
  Box<3> box = tile.box;
  box.expand(tile.expected_box);
  return too_long(static_cast<double>(tile.points) + tile.expected,
                  aspect_by_cuts(box, cuts_.cell(number), options_.dimension), capacity_);
}

/// Cuts tiles across that are too long.
void TileTree::cut_long() {
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    if (is_too_long(t)) cut_in_two(t, true);
  }
}

/// Likewise below a node to which no more points come, but leaves nothing over.
void TileTree::cut_long_below(CutTree::NodeRef ref) {
  if (!CutTree::is_tile(ref)) {
    for (const CutTree::NodeRef side : cuts_.sides(ref)) cut_long_below(side);
    return;
  }
  const std::uint32_t number = CutTree::tile_at(ref);
  if (tiles_[number].segments.empty() && is_too_long(number)) cut_in_two(number, true);
}

/// Whether a tile is to be cut in two; `complete`: no points come but those that are expected.
bool TileTree::to_be_cut(std::uint32_t number, bool complete) const {
  const Tile& tile = tiles_[number];
  return outgrown(tile) || (complete && (will_be_too_large(tile) || is_too_long(number)));
}

/// Cuts a tile in two, and a half again that is to be cut. A place where many points are equal gets
/// a tile of its own at once: else they would be dealt again with each cut beside them.
void TileTree::cut_in_two(std::uint32_t number, bool complete) {
  Tile whole = std::exchange(tiles_[number], {});
  std::ranges::stable_sort(whole.segments, {}, &TileSegment::arrival);
  const std::size_t stride = std::max<std::size_t>(1, whole.waiting() / kCutSamples);
  const CrowdedTile crowded{.dimension = options_.dimension,
                            .box = whole.box,
                            .expected = whole.expected_box,
                            .segments = whole.segments,
                            .sample = sample_of(whole.held, stride),
                            .weight = static_cast<double>(stride),
                            .complete = complete,
                            .hollow = whole.hollow};
  const std::optional<LatticePoint> heavy = heavy_place(crowded);
  const auto cut_beside_heavy = [&](const Tile& tile) {
    Box<3> box = tile.box;
    box.expand(tile.expected_box);
    return heavy ? cut_beside(box, *heavy, options_.dimension) : std::nullopt;
  };
  std::optional<TileCut> chosen = cut_beside_heavy(whole);
  if (!chosen) chosen = choose_cut(crowded);
  if (!chosen) {  // all points so far are equal
    tiles_[number] = std::move(whole);
    return;
  }
  const TileCut cut = *chosen;
  CutTree::NodeRef ref = 0;
  {
    const std::unique_lock lock(cuts_mutex_);
    ref = cuts_.cut(number, cut.axis, cut.value);
    ++cuts_made_;
  }
  set_cell_root(number, whole.cell, ref);
  const std::array<std::uint32_t, 2> halves = {number, static_cast<std::uint32_t>(tiles_.size())};
  tiles_.emplace_back();
  const double below = share_below(whole.expected_box, cut);
  for (const int side : {0, 1}) {
    Tile& half = tiles_[halves[side]];
    half.expected = whole.expected * (side == 0 ? below : 1 - below);
    half.expected_box = part_of(whole.expected_box, cut, side);
    half.last_left_over = whole.last_left_over;
    half.used = whole.used;
    half.cut_at = cuts_made_;
    half.cell = whole.cell;
    half.hollow = whole.hollow;
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
          std::max(tiles_[half].last_left_over, std::optional(segment.last_arrival()));
    }
    const double low_share = share_below(segment.box, cut);
    const auto points = static_cast<double>(segment.points);
    tiles_[halves[0]].expected += points * low_share;
    tiles_[halves[1]].expected += points * (1 - low_share);
    for (const int side : {0, 1}) {
      tiles_[halves[side]].expected_box.expand(part_of(segment.box, cut, side));
    }
    leave_over(ref, std::move(segment));
  }
  room_ -= whole.room();
  for (HeldPoints& held : whole.held) deal_to_halves(std::move(held), cut, halves);
  for (const int side : {0, 1}) {
    const bool has_heavy = heavy && ((*heavy)[cut.axis] >= cut.value) == (side == 1);
    if ((has_heavy && cut_beside_heavy(tiles_[halves[side]])) ||
        to_be_cut(halves[side], complete)) {
      cut_in_two(halves[side], complete);
    }
  }
}

void TileTree::deal_to_halves(HeldPoints held, const TileCut& cut,
                              const std::array<std::uint32_t, 2>& halves) {
  std::vector<HeldPoints> parts = part(std::move(held), cut, {kNoCut, kNoCut});
  for (const int side : {0, 1}) {
    HeldPoints& points = parts[2 * static_cast<std::size_t>(side)];
    if (points.buffer.size() == 0) continue;
    Tile& half = tiles_[halves[side]];
    half.points += points.buffer.size();
    half.box.expand(points.box);
    room_ += points.buffer.room();
    half.held.push_back(std::move(points));
  }
}

/// Appends parts of a buffer that are to be segments of their own, if it is a large one: they are
/// so small and compact that most will lie on one side of a cut, if the tile is cut later.
void TileTree::append_segments_of(HeldPoints held, std::vector<HeldPoints>& segments) const {
  const double points = static_cast<double>(held.buffer.size());
  if (points <= kLeastPartedShare * static_cast<double>(capacity_)) {
    segments.push_back(std::move(held));
    return;
  }
  CrowdedTile crowded{.dimension = options_.dimension, .box = held.box};
  PointSample sample(std::max<std::size_t>(1, held.buffer.size() / kCutSamples));
  held.buffer.visit([&](std::span<const LatticePoint> some) { sample.add(some); });
  crowded.sample = sample.take();
  const TileCut first = choose_cut(crowded).value_or(kNoCut);
  std::array<TileCut, 2> second = {kNoCut, kNoCut};
  for (const int side : {0, 1}) {
    CrowdedTile half{.dimension = options_.dimension};
    for (const LatticePoint& p : crowded.sample) {
      if ((p[first.axis] >= first.value) == (side == 1)) half.sample.push_back(p);
    }
    for (const LatticePoint& p : half.sample) half.box.expand(p);
    if (!half.box.empty()) second[side] = choose_cut(half).value_or(kNoCut);
  }
  for (HeldPoints& some : part(std::move(held), first, second)) {
    if (some.buffer.size() > 0) segments.push_back(std::move(some));
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
  std::uint64_t all = dealt_again_ + points_to_divide();
  double fraction = 0;  // what is found to be too large again does not take it back
  while (dealing_again_ || points_to_divide() > 0) {
    if (!dealing_again_) {
      Batch batch;
      for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
        if (!too_large(tiles_[t])) continue;
        std::vector<LatticePoint> sample = sample_of_all(tiles_[t], sample_stride());
        divide(t, std::move(sample),
               tiles_for(static_cast<double>(tiles_[t].points), capacity_, kKnownFill), batch);
      }
      dealing_again_.emplace(take_left_over(), runs_);
    }
    deal_again([&](std::uint64_t some) {
      const std::uint64_t done = dealt_again_ + some;
      all = std::max(all, done);
      fraction = std::max(fraction, static_cast<double>(done) / static_cast<double>(all));
      progress(done, std::min(1.0, fraction));
    });
    for (Tile& tile : tiles_) {
      tile.expected = 0;
      tile.expected_box = {};
    }
    cut_long();
    all += points_to_divide();
  }
  return std::exchange(dealt_again_, 0);
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

/// Of samples by which many tiles are made at once.
std::size_t TileTree::sample_stride() const {
  return std::max<std::size_t>(1, capacity_ / kManySamples);
}

void TileTree::deal_again(const std::function<void(std::uint64_t points)>& progress) {
  run_to_rest(
      [&](Batch& batch) {
        progress(dealing_again_->points());
        if (!dealing_again_->fetch(batch.stored)) return false;
        batch.arrival = batch.stored.arrival;
        batch.run = batch.stored.run;
        return true;
      },
      [this](Batch& batch, PointBlock& points) {
        const StageTimer timer(times_, Stage::kDeal);
        decode_all_points(batch.stored.bytes, batch.stored.where, points);
      },
      {});
  runs_ = dealing_again_->last_run();
  dealt_again_ += dealing_again_->points();
  dealing_again_.reset();
}

}  // namespace spillway::detail
