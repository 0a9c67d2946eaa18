// From one tile to many: the first division, tiles that have outgrown their share, and what is
// dealt once more when all points are in.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

}  // namespace

/// Divides the one tile that there is at first, all of whose points are in memory, for those that
/// are to come, too, if it is known where they will lie.
void TileTree::divide_first(Batch& batch) {
  const Box<3> box = tiles_[0].box;
  const std::uint64_t seen = tiles_[0].points;
  const std::uint64_t all = options_.expected.value_or(0);
  const bool tells = !filled_ && options_.extent && all > seen;
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
  if (tells && !everywhere) {
    append_expected_points(sample, box, *options_.extent, options_.dimension,
                           points / static_cast<double>(seen) - 1);
  }
  divided_ = true;
  divide(0, std::move(sample), tiles_for(points, options_.capacity, fill), batch);
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
