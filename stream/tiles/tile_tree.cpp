#include "stream/tiles/tile_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "src/delaunay/hash.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// Batches under way at a time.
constexpr std::size_t kSlots = 6;
/// How full the tiles of the first division are meant to get: where the points so far show how all
/// will lie, and where the density may turn out to be another.
constexpr double kRepresentativeFill = 0.6;
constexpr double kExpectedFill = 0.4;
/// How full the tiles are that a tile of known size is divided into.
constexpr double kKnownFill = 0.7;
/// Tiles of the first division where the number of points is not known.
constexpr std::size_t kUnknownTiles = 64;
/// Sampled points for each capacity of points, before the first division and later.
constexpr std::size_t kFirstSamples = 2048;
constexpr std::size_t kLaterSamples = 64;
/// Points that span so much of the expected extent on every axis show the whole distribution.
constexpr double kRepresentativeSpan = 0.9;
/// Most points that stand for those expected.
constexpr std::size_t kMostExpectedSamples = 1'000'000;
/// Full buffers are emptied by this share of them.
constexpr std::size_t kSpillShare = 8;

std::size_t tiles_for(double points, double capacity, double fill) {
  return static_cast<std::size_t>(std::ceil(points / (fill * capacity)));
}

}  // namespace

TileTree::TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times)
    : options_(options),
      folder_(folder),
      times_(times),
      cuts_(std::make_shared<CutTree>(options.dimension)),
      tiles_(1),
      sample_stride_(std::max<std::size_t>(1, options.capacity / kFirstSamples)) {}

void TileTree::fill(const PointFeed& source) {
  run_batches([&](Batch& batch) { return source.fetch(batch.piece); },
              [&](Batch& batch) {
                source.decode(batch.piece, batch.points);
                if (!options_.index) batch.points.index.clear();
              });
  for (const Tile& tile : tiles_) points_ += tile.points;
  if (!divided_ && points_ > options_.capacity) divide_first();
}

void TileTree::fill(const std::function<bool(PointBlock&)>& source) {
  fill({.fetch = [&](SourcePiece& piece) { return source(piece.raw.decoded); },
        .decode = [](SourcePiece& piece,
                     PointBlock& block) { std::swap(piece.raw.decoded, block); }});
}

void TileTree::run_batches(const std::function<bool(Batch&)>& fetch,
                           const std::function<void(Batch&)>& decode) {
  std::vector<Batch> batches(kSlots);
  const auto encode = [this](Batch& batch) {
    const StageTimer timer(times_, Stage::kSpill);
    for (Spill& spill : batch.spills) spill.blocks = encode_points(spill.points, spill.bytes);
  };
  const std::vector<PipelineStep> steps = {
      {.in_order = false,
       .work =
           [&](std::size_t slot) {
             decode(batches[slot]);
             deal(batches[slot]);
           }},
      {.in_order = true, .work = [&](std::size_t slot) { append(batches[slot]); }},
      {.in_order = false, .work = [&](std::size_t slot) { encode(batches[slot]); }},
      {.in_order = true, .work = [&](std::size_t slot) { write(batches[slot]); }}};
  run_pipeline(
      kSlots, [&](std::size_t slot) { return fetch(batches[slot]); }, steps);
}

/// Groups a batch's points by tile.
void TileTree::deal(Batch& batch) const {
  const StageTimer timer(times_, Stage::kDeal);
  {
    const std::lock_guard lock(cuts_mutex_);
    batch.dealt_by = cuts_;
  }
  batch.dealt.deal(*batch.dealt_by, batch.points);
}

/// Puts a batch into the tiles' buffers, and takes out what has to go to the disk.
void TileTree::append(Batch& batch) {
  if (batch.dealt_by != cuts_) deal(batch);  // the first division came in between
  const StageTimer timer(times_, Stage::kDeal);
  append_runs(batch);
  if (buffered_ <= options_.buffered_points) return;
  if (!divided_) divide_first();
  const std::size_t enough = options_.buffered_points - options_.buffered_points / kSpillShare;
  while (buffered_ > enough) spill_fullest(batch);
}

void TileTree::append_runs(Batch& batch) {
  for (const PointRun& run : batch.dealt.runs) {
    Tile& tile = tiles_[run.tile];
    const std::size_t count = run.end - run.begin;
    const auto points = std::span(batch.dealt.points.points).subspan(run.begin, count);
    const auto index =
        batch.dealt.points.index.empty()
            ? std::span<const std::uint64_t>()
            : std::span<const std::uint64_t>(batch.dealt.points.index).subspan(run.begin, count);
    for (; tile.next_sample < tile.points + count;) {
      tile.sample.push_back(points[tile.next_sample - tile.points]);
      // Jittered: rows of grids and scan lines have a period.
      tile.next_sample += 1 + mix64(tile.next_sample) % (2 * sample_stride_ - 1);
    }
    tile.points += count;
    tile.box.expand(run.box);
    buffered_ -= tile.buffer.room();
    tile.buffer.append(points, index);
    buffered_ += tile.buffer.room();
  }
}

void TileTree::spill_fullest(Batch& batch) {
  const auto fullest = std::max_element(
      tiles_.begin(), tiles_.end(),
      [](const Tile& a, const Tile& b) { return a.buffer.size() < b.buffer.size(); });
  buffered_ -= fullest->buffer.room();
  batch.spills.push_back({static_cast<std::uint32_t>(fullest - tiles_.begin()),
                          std::exchange(fullest->buffer, {}),
                          {},
                          {}});
}

void TileTree::write(Batch& batch) {
  const StageTimer timer(times_, Stage::kSpill);
  for (Spill& spill : batch.spills) {
    Tile& tile = tiles_[spill.tile];
    if (!tile.file) tile.file = folder_.create("tile");
    const std::uint64_t end = tile.file->size();
    tile.file->append(spill.bytes);
    bytes_written_ += spill.bytes.size();
    for (TileBlock& block : spill.blocks) {
      block.offset += end;
      points_written_ += block.points;
      tile.blocks.push_back(block);
    }
  }
  batch.spills.clear();
}

/// Whether the points so far lie all over the expected extent.
bool TileTree::sample_is_representative() const {
  if (!options_.expected || !options_.extent) return false;
  for (int k = 0; k < options_.dimension; ++k) {
    if (tiles_[0].box.extent(k) < kRepresentativeSpan * options_.extent->extent(k)) return false;
  }
  return true;
}

/// The points that are still to come lie, for all one knows, evenly where none have come so far.
void TileTree::add_expected_points(std::vector<LatticePoint>& sample) const {
  const auto seen = static_cast<double>(tiles_[0].points);
  const double more = static_cast<double>(*options_.expected) / seen - 1;
  const auto wanted = static_cast<std::size_t>(
      std::min<double>(kMostExpectedSamples, more * static_cast<double>(sample.size())));
  // Steps of a Kronecker sequence: M. Roberts, "The unreasonable effectiveness of quasirandom
  // sequences" (2018); the powers of the plastic number and of its equivalent in space.
  const std::array<double, 3> step =
      options_.dimension == 2
          ? std::array{0.7548776662466927, 0.5698402909980532, 0.0}
          : std::array{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const Box<3>& seen_box = tiles_[0].box;
  std::size_t added = 0;
  for (std::size_t i = 1; added < wanted && i <= 4 * wanted; ++i) {
    LatticePoint point{};
    bool inside = true;
    for (int k = 0; k < options_.dimension; ++k) {
      const double turns = step[k] * static_cast<double>(i);
      point[k] = options_.extent->lo[k] + (turns - std::floor(turns)) * options_.extent->extent(k);
      inside = inside && point[k] >= seen_box.lo[k] && point[k] <= seen_box.hi[k];
    }
    if (inside) continue;
    sample.push_back(point);
    ++added;
  }
}

/// Divides the one tile that there is at first, of what is known by now.
void TileTree::divide_first() {
  const auto capacity = static_cast<double>(options_.capacity);
  const std::uint64_t seen = tiles_[0].points;
  std::vector<LatticePoint> sample = std::move(tiles_[0].sample);
  const bool complete = buffered_ <= options_.buffered_points;
  std::size_t tile_count = kUnknownTiles;
  if (complete) {
    tile_count = tiles_for(static_cast<double>(seen), capacity, kKnownFill);
  } else if (options_.expected && *options_.expected > seen) {
    const bool representative = sample_is_representative();
    tile_count = tiles_for(static_cast<double>(*options_.expected), capacity,
                           representative ? kRepresentativeFill : kExpectedFill);
    if (!representative && options_.extent) add_expected_points(sample);
  }
  divided_ = true;
  sample_stride_ = std::max<std::size_t>(1, options_.capacity / kLaterSamples);
  auto cuts = std::make_shared<CutTree>(*cuts_);
  split(*cuts, 0, std::move(sample), std::max<std::size_t>(2, tile_count));
  PointBuffer points = std::exchange(tiles_[0].buffer, {});
  tiles_[0] = {};
  tiles_.resize(cuts->tiles());
  buffered_ = 0;
  {
    const std::lock_guard lock(cuts_mutex_);
    cuts_ = std::move(cuts);
  }
  deal_from_memory(std::move(points));
}

bool TileTree::too_large(const Tile& tile) const {
  if (tile.points <= options_.capacity) return false;
  for (int k = 0; k < options_.dimension; ++k) {
    if (tile.box.lo[k] < tile.box.hi[k]) return true;
  }
  return false;
}

/// Splits a tile by its sample; where that tells too little, by its box.
void TileTree::split(CutTree& cuts, std::uint32_t number, std::vector<LatticePoint> sample,
                     std::size_t tile_count) const {
  const std::uint32_t before = cuts.tiles();
  cuts.split(number, sample, tile_count);
  if (cuts.tiles() > before) return;
  const Box<3>& box = tiles_[number].box;
  int axis = 0;
  for (int k = 1; k < options_.dimension; ++k) {
    if (box.extent(k) > box.extent(axis) || box.lo[axis] == box.hi[axis]) axis = k;
  }
  const double sampled = sample.empty() ? box.hi[axis] : sample.front()[axis];
  const double value = sampled > box.lo[axis]
                           ? sampled
                           : std::nextafter(box.lo[axis], std::numeric_limits<double>::infinity());
  cuts.cut(number, axis, value);
}

std::uint64_t TileTree::points_to_divide() const {
  std::uint64_t points = 0;
  for (const Tile& tile : tiles_) points += too_large(tile) ? tile.points : 0;
  return points;
}

std::uint64_t TileTree::divide_large(const DivisionProgress& progress) {
  std::uint64_t all = points_to_divide();
  std::uint64_t done = 0;
  double fraction = 0;  // what is found to be too large again does not take it back
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    while (too_large(tiles_[t])) {
      const std::uint64_t points = tiles_[t].points;
      const std::size_t before = tiles_.size();
      divide(t, [&](std::uint64_t of_tile) {
        fraction =
            std::max(fraction, static_cast<double>(done + of_tile) / static_cast<double>(all));
        progress(done + of_tile, fraction);
      });
      done += points;
      if (too_large(tiles_[t])) all += tiles_[t].points;
      for (std::size_t n = before; n < tiles_.size(); ++n) {
        if (too_large(tiles_[n])) all += tiles_[n].points;
      }
    }
  }
  return done;
}

/// Divides a tile that has too many points, all of which are in. Tells how many of them have been
/// taken out of it.
void TileTree::divide(std::uint32_t number,
                      const std::function<void(std::uint64_t points)>& progress) {
  Tile whole = std::exchange(tiles_[number], {});
  tiles_[number].box = whole.box;  // split() looks at it
  auto cuts = std::make_shared<CutTree>(*cuts_);
  split(*cuts, number, std::move(whole.sample),
        std::max<std::size_t>(2, tiles_for(static_cast<double>(whole.points),
                                           static_cast<double>(options_.capacity), kKnownFill)));
  tiles_[number].box = {};
  tiles_.resize(cuts->tiles());
  cuts_ = std::move(cuts);
  buffered_ -= whole.buffer.room();
  std::uint64_t taken = 0;
  auto block = whole.blocks.begin();
  const auto fetch = [&](Batch& batch) {
    progress(taken);
    if (block == whole.blocks.end()) return false;
    taken += block->points;
    batch.stored.resize(block->size);
    whole.file->read(block->offset, batch.stored);
    batch.where = {whole.file->name(), at_byte(block->offset)};
    ++block;
    return true;
  };
  run_batches(fetch, [this](Batch& batch) {
    const StageTimer timer(times_, Stage::kDeal);
    decode_points(batch.stored, batch.where, batch.points);
  });
  deal_from_memory(std::move(whole.buffer));
}

void TileTree::deal_from_memory(PointBuffer points) {
  Batch batch;
  points.drain([&](std::span<const LatticePoint> chunk, std::span<const std::uint64_t> index) {
    batch.points.points.assign(chunk.begin(), chunk.end());
    batch.points.index.assign(index.begin(), index.end());
    deal(batch);
    append_runs(batch);
  });
}

template <int D>
std::optional<TileNode<D>> TileTree::nodes() const {
  return node_at<D>(cuts_->root());
}

template <int D>
std::optional<TileNode<D>> TileTree::node_at(CutTree::NodeRef ref) const {
  TileNode<D> node;
  if (CutTree::is_tile(ref)) {
    const Tile& tile = tiles_[CutTree::tile_at(ref)];
    if (tile.points == 0) return std::nullopt;
    std::copy_n(tile.box.lo.begin(), D, node.box.lo.begin());
    std::copy_n(tile.box.hi.begin(), D, node.box.hi.begin());
    node.points = tile.points;
    node.stored = {CutTree::tile_at(ref)};
    return node;
  }
  const auto sides = cuts_->sides(ref);
  auto below = node_at<D>(sides[0]);
  auto above = node_at<D>(sides[1]);
  if (!below || !above) return below ? std::move(below) : std::move(above);
  node.box = below->box;
  node.box.expand(above->box);
  node.points = below->points + above->points;
  if (node.points <= options_.capacity) {
    node.stored = std::move(below->stored);
    node.stored.insert(node.stored.end(), above->stored.begin(), above->stored.end());
  } else {
    node.children.push_back(std::move(*below));
    node.children.push_back(std::move(*above));
  }
  return node;
}

template <int D>
StoredTile TileTree::read(const TileNode<D>& node) {
  const StageTimer timer(times_, Stage::kLoad);
  StoredTile stored;
  stored.points = node.points;
  for (const std::uint32_t number : node.stored) {
    Tile tile = std::exchange(tiles_[number], {});
    StoredTile::Segment& segment = stored.segments.emplace_back();
    segment.blocks = std::move(tile.blocks);
    segment.buffer = std::move(tile.buffer);
    if (!tile.file) continue;
    segment.file = tile.file->name();
    segment.bytes.resize(tile.file->size());
    tile.file->read(0, segment.bytes);
  }
  return stored;
}

template <int D>
TilePoints<D> TileTree::decode(StoredTile stored) const {
  TilePoints<D> result;
  result.resize(stored.points, options_.index);
  std::size_t position = 0;
  const auto put = [&](std::size_t first, std::span<const LatticePoint> points,
                       std::span<const std::uint64_t> index) {
    for (std::size_t i = 0; i < points.size(); ++i) result.set(first + i, points[i]);
    std::copy(index.begin(), index.end(),
              result.index.begin() + static_cast<std::ptrdiff_t>(index.empty() ? 0 : first));
  };
  for (StoredTile::Segment& segment : stored.segments) {
    std::vector<std::size_t> first(segment.blocks.size());
    for (std::size_t b = 0; b < first.size(); ++b) {
      first[b] = position;
      position += segment.blocks[b].points;
    }
    parallel_for(segment.blocks.size(), 16, [&](std::size_t, std::size_t begin, std::size_t end) {
      const StageTimer timer(times_, Stage::kLoad);
      PointBlock points;
      for (std::size_t b = begin; b < end; ++b) {
        const TileBlock& block = segment.blocks[b];
        decode_points(std::span<const std::byte>(segment.bytes).subspan(block.offset, block.size),
                      {segment.file, at_byte(block.offset)}, points);
        put(first[b], points.points, points.index);
      }
    });
    segment.buffer.drain(
        [&](std::span<const LatticePoint> points, std::span<const std::uint64_t> index) {
          put(position, points, index);
          position += points.size();
        });
  }
  return result;
}

template std::optional<TileNode<2>> TileTree::nodes<2>() const;
template std::optional<TileNode<3>> TileTree::nodes<3>() const;
template StoredTile TileTree::read<2>(const TileNode<2>&);
template StoredTile TileTree::read<3>(const TileNode<3>&);
template TilePoints<2> TileTree::decode<2>(StoredTile) const;
template TilePoints<3> TileTree::decode<3>(StoredTile) const;

}  // namespace spillway::detail
