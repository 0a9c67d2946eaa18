#include "stream/tiles/tile_divider.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "stream/points/encoded_points.h"
#include "stream/points/point_sample.h"
#include "stream/tiles/cuts/sample_division.h"
#include "stream/tiles/even_tiles.h"
#include "stream/tiles/storage/parted_points.h"
#include "stream/tiles/storage/segment_reader.h"

namespace spillway::stream {
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

void add_held(const std::vector<HeldPoints>& held, PointSample& sample) {
  for (const HeldPoints& some : held) {
    some.buffer.visit([&](std::span<const LatticePoint> points) { sample.add(points); });
  }
}

/// About every `stride`-th point of some buffers.
std::vector<LatticePoint> sample_of(const std::vector<HeldPoints>& held, std::size_t stride) {
  PointSample sample(stride);
  add_held(held, sample);
  return sample.take();
}

/// A sample of all points of a tile, also of those on the disk.
std::vector<LatticePoint> sample_of_all(const Tile& tile, std::size_t stride) {
  PointSample sample(stride);
  add_held(tile.held, sample);
  SegmentReader reader(tile.segments);
  StoredBlocks blocks;
  PointBlock points;
  while (reader.fetch(blocks)) {
    decode_all_points(blocks.bytes, blocks.where, points);
    sample.add(points.points);
  }
  return sample.take();
}

Box<3> box_with_expected(const Tile& tile) {
  Box<3> box = tile.box;
  box.expand(tile.expected_box);
  return box;
}

}  // namespace

bool TileDivider::stays_whole() {
  const TileTreeOptions& options = table_.options;
  if (table_.points > options.largest_undivided || options.plan != nullptr) return false;
  const std::vector<LatticePoint> sample = sample_of(table_.tiles[0].held, table_.sample_stride());
  if (!is_clearly_hollow(sample, options.dimension) || some_cut_pays(sample, options.dimension)) {
    return false;
  }
  table_.capacity = std::max<std::size_t>(table_.capacity, table_.points);
  return true;
}

std::vector<HeldPoints> TileDivider::divide_first() {
  TileTreeOptions& options = table_.options;
  const Box<3> box = table_.tiles[0].box;
  const std::uint64_t seen = table_.tiles[0].points;
  const std::uint64_t all = std::min(options.expected.value_or(0),
                                     std::numeric_limits<std::uint64_t>::max() / kExpectedShare);
  const bool tells = !table_.filled && options.extent && all > seen;
  table_.divided = true;
  const std::size_t known_tiles =
      tiles_for(static_cast<double>(all), table_.capacity, kRepresentativeFill);
  if (tells && is_telling(options.sample, known_tiles)) {
    return divide(0, std::exchange(options.sample, {}), known_tiles, true);
  }
  const bool everywhere = tells && spans_extent(box, *options.extent, options.dimension);
  std::size_t stride = table_.sample_stride();
  if (tells && !everywhere) {
    stride = std::max<std::size_t>(stride, kExpectedShare * all / options.buffered_points);
  }
  std::vector<LatticePoint> sample = sample_of(table_.tiles[0].held, stride);
  double points = static_cast<double>(seen);
  double fill = kKnownFill;
  if (tells) {
    points = static_cast<double>(all);
    fill = everywhere ? kRepresentativeFill : kExpectedFill;
  }
  const bool representative = !tells || everywhere;
  if (!representative) {
    append_expected_points(sample, box, *options.extent, options.dimension,
                           points / static_cast<double>(seen) - 1);
  }
  return divide(0, std::move(sample), tiles_for(points, table_.capacity, fill), representative);
}

std::vector<HeldPoints> TileDivider::divide(std::uint32_t number) {
  const Tile& tile = table_.tiles[number];
  return divide(number, sample_of_all(tile, table_.sample_stride()),
                tiles_for(static_cast<double>(tile.points), table_.capacity, kKnownFill), true);
}

/// Divides a tile into many by a sample of its points; where that tells too little, by its box.
/// Only a representative sample tells whether they are hollow.
std::vector<HeldPoints> TileDivider::divide(std::uint32_t number, std::vector<LatticePoint> sample,
                                            std::size_t tile_count, bool representative) {
  std::vector<Tile>& tiles = table_.tiles;
  CutTree& cuts = table_.cuts;
  const int dimension = table_.options.dimension;
  watch_.tiles_made(tiles.size() + tile_count - 1);
  Tile whole = std::exchange(tiles[number], {});
  const CutTree::NodeRef first_cut = cuts.cuts();
  const auto first_new = static_cast<std::ptrdiff_t>(tiles.size());
  const bool hollow = representative && is_clearly_hollow(sample, dimension);
  const std::vector<DivisionCut> division =
      hollow ? divide_sample(sample, tile_count, dimension)
             : divide_sample_evenly(sample, tile_count, dimension);
  {
    const std::unique_lock lock(table_.cuts_mutex);
    cuts.split(number, division);
    if (cuts.tiles() == tiles.size()) {
      const auto cut = choose_cut({.dimension = dimension,
                                   .box = whole.box,
                                   .expected = whole.expected_box,
                                   .segments = whole.segments,
                                   .sample = sample});
      if (!cut) {  // all points are equal
        tiles[number] = std::move(whole);
        return {};
      }
      cuts.cut(number, cut->axis, cut->value);
    }
    tiles[number].cut_at = ++table_.cuts_made;
  }
  tiles.resize(cuts.tiles());
  table_.set_cell_root(number, whole.cell, first_cut);
  for (TileSegment& segment : whole.segments) {
    whole.last_left_over = std::max(whole.last_left_over, std::optional(segment.last_arrival()));
    leave_over(first_cut, std::move(segment));
  }
  const auto take_from_whole = [&](Tile& tile) {
    tile.cell = whole.cell;
    tile.last_left_over = whole.last_left_over;
  };
  take_from_whole(tiles[number]);
  std::for_each(tiles.begin() + first_new, tiles.end(), take_from_whole);
  if (representative) judge_tiles(sample);
  table_.room -= whole.room();
  return std::move(whole.held);
}

/// Tells which tiles are hollow, of those that have enough of a sample.
void TileDivider::judge_tiles(std::span<const LatticePoint> sample) {
  std::vector<std::uint32_t> numbers(sample.size());
  table_.cuts.find_tiles(sample, numbers);
  std::vector<std::vector<LatticePoint>> samples(table_.tiles.size());
  for (std::size_t i = 0; i < sample.size(); ++i) samples[numbers[i]].push_back(sample[i]);
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (samples[t].empty()) continue;
    table_.tiles[t].hollow = is_clearly_hollow(samples[t], table_.options.dimension);
  }
}

std::vector<Tile> TileDivider::replace_tiles(CutTree cuts) {
  std::vector<Tile> by_number = std::exchange(table_.tiles, std::vector<Tile>(cuts.tiles()));
  std::vector<Tile> old;
  for (const std::uint32_t number : numbers_in_order(table_.cuts)) {
    old.push_back(std::move(by_number[number]));
  }
  table_.cuts = std::move(cuts);  // no batch is under way
  ++table_.cuts_made;
  std::optional<std::uint64_t> last;
  for (Tile& tile : old) {
    for (TileSegment& segment : std::exchange(tile.segments, {})) {
      last = std::max(last, std::optional(segment.last_arrival()));
      leave_over(table_.cuts.root(), std::move(segment));
    }
  }
  for (Tile& tile : table_.tiles) {
    tile.cut_at = table_.cuts_made;
    tile.last_left_over = last;
  }
  return old;
}

bool TileDivider::too_large(const Tile& tile) const {
  return tile.points > table_.capacity && can_be_cut(tile.box, table_.options.dimension);
}

/// Whether a tile is going to be, with the points still to come.
bool TileDivider::will_be_too_large(const Tile& tile) const {
  return tile.points > 0 && can_be_cut(tile.box, table_.options.dimension) &&
         static_cast<double>(tile.points) + tile.expected > static_cast<double>(table_.capacity);
}

/// Whether a tile is to be cut in two now.
bool TileDivider::outgrown(const Tile& tile) const {
  if (table_.filled) return too_large(tile);
  const auto capacity = static_cast<double>(table_.capacity);
  const double own = static_cast<double>(tile.points);
  if (own + tile.expected <= kMostFill * capacity || own < kLeastOwnShare * capacity) return false;
  return can_be_cut(tile.box, table_.options.dimension);
}

/// Whether a tile is, with the points still to come. A side is not short that no cut has made so. A
/// hollow tile may be as long as it likes: its points are few beside any side.
bool TileDivider::is_too_long(std::uint32_t number) const {
  const Tile& tile = table_.tiles[number];
  if (tile.points == 0 || tile.hollow) return false;
  const double aspect =
      aspect_by_cuts(box_with_expected(tile), table_.cuts.cell(number), table_.options.dimension);
  return too_long(static_cast<double>(tile.points) + tile.expected, aspect, table_.capacity);
}

void TileDivider::cut_outgrown(std::uint32_t number) {
  if (outgrown(table_.tiles[number])) cut_in_two(number, table_.filled);
}

void TileDivider::cut_long() {
  for (std::uint32_t t = 0; t < table_.tiles.size(); ++t) {
    if (is_too_long(t)) cut_in_two(t, true);
  }
}

void TileDivider::cut_long_below(CutTree::NodeRef ref) {
  if (!CutTree::is_tile(ref)) {
    for (const CutTree::NodeRef side : table_.cuts.sides(ref)) cut_long_below(side);
    return;
  }
  const std::uint32_t number = CutTree::tile_at(ref);
  if (table_.tiles[number].segments.empty() && is_too_long(number)) cut_in_two(number, true);
}

/// Whether a tile is to be cut in two; `complete`: no points come but those that are expected.
bool TileDivider::to_be_cut(std::uint32_t number, bool complete) const {
  const Tile& tile = table_.tiles[number];
  return outgrown(tile) || (complete && (will_be_too_large(tile) || is_too_long(number)));
}

/// Cuts a tile in two, and a half again that is to be cut. A place where many points are equal gets
/// a tile of its own at once: else they would be dealt again with each cut beside them.
void TileDivider::cut_in_two(std::uint32_t number, bool complete) {
  std::vector<Tile>& tiles = table_.tiles;
  const int dimension = table_.options.dimension;
  Tile whole = std::exchange(tiles[number], {});
  std::ranges::stable_sort(whole.segments, {}, &TileSegment::arrival);
  const std::size_t stride = std::max<std::size_t>(1, whole.waiting() / kCutSamples);
  const CrowdedTile crowded{.dimension = dimension,
                            .box = whole.box,
                            .expected = whole.expected_box,
                            .segments = whole.segments,
                            .sample = sample_of(whole.held, stride),
                            .weight = static_cast<double>(stride),
                            .complete = complete,
                            .hollow = whole.hollow};
  const std::optional<LatticePoint> heavy = heavy_place(crowded);
  const auto cut_beside_heavy = [&](const Tile& tile) {
    return heavy ? cut_beside(box_with_expected(tile), *heavy, dimension) : std::nullopt;
  };
  std::optional<Cut> chosen = cut_beside_heavy(whole);
  if (!chosen) chosen = choose_cut(crowded);
  if (!chosen) {  // all points so far are equal
    tiles[number] = std::move(whole);
    return;
  }
  const Cut cut = *chosen;
  CutTree::NodeRef ref = 0;
  {
    const std::unique_lock lock(table_.cuts_mutex);
    ref = table_.cuts.cut(number, cut.axis, cut.value);
    ++table_.cuts_made;
  }
  table_.set_cell_root(number, whole.cell, ref);
  const std::array<std::uint32_t, 2> halves = {number, static_cast<std::uint32_t>(tiles.size())};
  tiles.emplace_back();
  const double below = share_below(whole.expected_box, cut);
  for (const int side : {0, 1}) {
    Tile& half = tiles[halves[side]];
    half.expected = whole.expected * (side == 0 ? below : 1 - below);
    half.expected_box = part_of(whole.expected_box, cut, side);
    half.last_left_over = whole.last_left_over;
    half.used = whole.used;
    half.cut_at = table_.cuts_made;
    half.cell = whole.cell;
    half.hollow = whole.hollow;
  }
  tiles[number].file = std::move(whole.file);
  tiles[number].spills = whole.spills;
  deal_segments(whole, ref, cut, halves);
  table_.room -= whole.room();
  for (HeldPoints& held : whole.held) deal_to_halves(std::move(held), cut, halves);
  for (const int side : {0, 1}) {
    const bool has_heavy = heavy && ((*heavy)[cut.axis] >= cut.value) == (side == 1);
    if ((has_heavy && cut_beside_heavy(tiles[halves[side]])) || to_be_cut(halves[side], complete)) {
      cut_in_two(halves[side], complete);
    }
  }
}

/// Segments go to the half that they lie in, and are left over if they lie in both.
void TileDivider::deal_segments(Tile& whole, CutTree::NodeRef ref, const Cut& cut,
                                const std::array<std::uint32_t, 2>& halves) {
  bool follows = false;
  for (TileSegment& segment : whole.segments) {
    if (const std::optional<int> side = side_of(segment.box, cut)) {
      Tile& half = table_.tiles[halves[*side]];
      half.box.expand(segment.box);
      half.points += segment.points;
      half.segments.push_back(std::move(segment));
      follows = false;
      continue;
    }
    // Later than all that were left over above: then the next one follows at once.
    segment.follows =
        std::exchange(follows, !whole.last_left_over || segment.arrival > *whole.last_left_over);
    const double low_share = share_below(segment.box, cut);
    for (const int side : {0, 1}) {
      Tile& half = table_.tiles[halves[side]];
      half.last_left_over = std::max(half.last_left_over, std::optional(segment.last_arrival()));
      half.expected +=
          static_cast<double>(segment.points) * (side == 0 ? low_share : 1 - low_share);
      half.expected_box.expand(part_of(segment.box, cut, side));
    }
    leave_over(ref, std::move(segment));
  }
}

void TileDivider::deal_to_halves(HeldPoints held, const Cut& cut,
                                 const std::array<std::uint32_t, 2>& halves) {
  std::vector<HeldPoints> parts = part_points(std::move(held), cut, {kNoCut, kNoCut});
  for (const int side : {0, 1}) {
    HeldPoints& points = parts[2 * static_cast<std::size_t>(side)];
    if (points.buffer.size() == 0) continue;
    Tile& half = table_.tiles[halves[side]];
    half.points += points.buffer.size();
    half.box.expand(points.box);
    table_.room += points.buffer.room();
    half.held.push_back(std::move(points));
  }
}

/// Points of a segment on both sides of a cut are dealt once all are in.
void TileDivider::leave_over(CutTree::NodeRef cut, TileSegment segment) {
  if (left_over_.size() <= static_cast<std::size_t>(cut)) left_over_.resize(cut + 1);
  left_over_points_ += segment.points;
  left_over_[cut].push_back(std::move(segment));
}

std::uint64_t TileDivider::points_to_divide() const {
  std::uint64_t points = left_over_points_;
  for (const Tile& tile : table_.tiles) points += too_large(tile) ? tile.points : 0;
  return points;
}

bool TileDivider::left_over_below(CutTree::NodeRef ref) const {
  if (CutTree::is_tile(ref)) return false;
  const auto cut = static_cast<std::size_t>(ref);
  if (cut < left_over_.size() && !left_over_[cut].empty()) return true;
  return std::ranges::any_of(table_.cuts.sides(ref),
                             [this](CutTree::NodeRef side) { return left_over_below(side); });
}

std::vector<TileSegment> TileDivider::take_left_over() {
  std::vector<TileSegment> segments;
  append_left_over(table_.cuts.root(), segments);
  left_over_.clear();
  left_over_points_ = 0;
  table_.segments -= segments.size();
  return segments;
}

void TileDivider::append_left_over(CutTree::NodeRef ref, std::vector<TileSegment>& segments) {
  if (CutTree::is_tile(ref)) return;
  if (static_cast<std::size_t>(ref) < left_over_.size()) {
    std::ranges::move(left_over_[ref], std::back_inserter(segments));
  }
  for (const CutTree::NodeRef side : table_.cuts.sides(ref)) append_left_over(side, segments);
}

}  // namespace spillway::stream
