#include "stream/tiles/tile_loader.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/points/encoded_points.h"
#include "stream/points/equal_points.h"
#include "stream/tiles/cuts/tile_cut.h"
#include "stream/tiles/storage/segment_reader.h"

namespace spillway::stream {
namespace {

/// Calls one of the two for each part of a tile, in the order in which they came.
template <typename OnDisk, typename InMemory>
void visit_parts(Tile tile, const OnDisk& on_disk, const InMemory& in_memory) {
  std::ranges::stable_sort(tile.segments, {}, &TileSegment::arrival);
  std::ranges::stable_sort(tile.held, {}, &HeldPoints::arrival_or_last);
  auto held = tile.held.begin();
  const auto visit_held_before = [&](std::uint64_t arrival) {
    for (; held != tile.held.end() && held->arrival_or_last() < arrival; ++held)
      in_memory(held->buffer);
  };
  for (TileSegment& segment : tile.segments) {
    visit_held_before(segment.arrival);
    on_disk(std::move(segment));
  }
  visit_held_before(HeldPoints::kAfterAll);
}

void append_stored(Tile tile, std::vector<StoredTile::Segment>& stored) {
  visit_parts(
      std::move(tile),
      [&](const TileSegment& segment) {
        const FileStretch& stretch = *segment.stretch;
        StoredTile::Segment& read = stored.emplace_back();
        read.where = {stretch.file().name(), at_byte(stretch.offset())};
        read.bytes.resize(stretch.size());
        stretch.file().read(stretch.offset(), read.bytes);
      },
      [&](PointBuffer& buffer) {
        stored.push_back({{}, {}, std::move(buffer)});
      });
}

/// Whether two tiles may become one: a compact one, or a thin one of two that are long.
template <int D>
bool fit_together(const TileNode<D>& a, const TileNode<D>& b, std::size_t capacity) {
  const std::uint64_t points = a.points + b.points;
  if (points > capacity) return false;
  Box<D> both = a.box;
  both.expand(b.box);
  const double times = aspect(both, cut_axes(D));
  if (times <= kMostAspect) return true;
  return std::min(aspect(a.box, cut_axes(D)), aspect(b.box, cut_axes(D))) > kMostAspect &&
         !too_long(static_cast<double>(points), times, capacity);
}

/// Makes one point of a tile of points that are one vertex, and tells of all of them.
StoredTile one_of(Tile tile, const TileTreeOptions& options) {
  EqualPoints all(options.dimension, *options.one_of_equal);
  const auto add = [&](const PointsView& points) {
    if (options.tell_equal) options.tell_equal(points);
    all.add(points);
  };
  visit_parts(
      std::move(tile),
      [&](TileSegment segment) {
        SegmentReader reader({std::move(segment)});
        StoredBlocks blocks;
        PointBlock points;
        while (reader.fetch(blocks)) {
          decode_all_points(blocks.bytes, blocks.where, points);
          add(PointsView::of(points));
        }
      },
      [&](PointBuffer& buffer) { buffer.drain([&](const PointsView& points) { add(points); }); });
  StoredTile stored;
  stored.points = 1;
  stored.left_out = all.count() - 1;
  stored.segments.emplace_back().buffer.append(PointsView::of(all.choose()));
  return stored;
}

using TakenTiles = std::unordered_map<std::uint32_t, Tile>;

void transfer_taken(StateReader& state, TakenTiles& taken) {
  std::vector<NumberedTile> tiles;
  state(tiles);
  taken.clear();
  for (NumberedTile& tile : tiles) taken.emplace(tile.number, std::move(tile.tile));
}

void transfer_taken(StateWriter& state, TakenTiles& taken) {
  std::uint64_t size = taken.size();
  state(size);
  for (auto& [tile_number, tile] : taken) {
    std::uint32_t number = tile_number;
    state(number, tile);
  }
}

}  // namespace

/// What is below a node: one tile that may be joined with its neighbour, or others.
template <int D>
struct TileLoader::Joinable {
  std::optional<TileNode<D>> tile{};
  bool others = false;
};

/// Appends all tiles below a node but the one that is returned.
template <int D>
TileLoader::Joinable<D> TileLoader::join_below(CutTree::NodeRef ref, const Box<D>& all,
                                               std::vector<TileNode<D>>& tiles) const {
  if (CutTree::is_tile(ref)) {
    const auto taken = taken_.find(CutTree::tile_at(ref));
    if (taken == taken_.end()) return {};
    const Tile& tile = taken->second;
    TileNode<D> node;
    node.box = all;
    std::copy_n(tile.box.lo.begin(), cut_axes(D), node.box.lo.begin());
    std::copy_n(tile.box.hi.begin(), cut_axes(D), node.box.hi.begin());
    node.points = tile.points;
    node.stored = {CutTree::tile_at(ref)};
    return {std::move(node)};
  }
  const auto refs = table_.cuts.sides(ref);
  std::array<Joinable<D>, 2> sides = {join_below<D>(refs[0], all, tiles),
                                      join_below<D>(refs[1], all, tiles)};
  auto& [below, above] = sides;
  if (!below.tile && !below.others) return std::move(above);
  if (!above.tile && !above.others) return std::move(below);
  if (below.tile && above.tile && fit_together(*below.tile, *above.tile, table_.capacity)) {
    TileNode<D>& joined = *below.tile;
    joined.box.expand(above.tile->box);
    joined.points += above.tile->points;
    joined.stored.insert(joined.stored.end(), above.tile->stored.begin(), above.tile->stored.end());
    return std::move(below);
  }
  for (Joinable<D>& side : sides) {
    if (side.tile) tiles.push_back(std::move(*side.tile));
  }
  return {.others = true};
}

template <int D>
void TileLoader::sketch(std::vector<TileNode<D>>& tiles) const {
  const auto stored = [this](std::uint32_t number) -> const Tile& { return taken_.at(number); };
  isolated([&] {
    parallel_for(tiles.size(), 1, [&](std::size_t, std::size_t t, std::size_t) {
      sketches_.sketch<D>(tiles[t], stored, table_.points_to_come());
    });
  });
}

template <int D>
std::optional<TileNode<D>> TileLoader::nodes_below(CutTree::NodeRef ref, const Box<D>& all) const {
  const std::shared_lock cuts_lock(table_.cuts_mutex);
  const std::lock_guard lock(taken_mutex_);
  std::vector<TileNode<D>> tiles;
  Joinable<D> last = join_below<D>(ref, all, tiles);
  if (last.tile) tiles.push_back(std::move(*last.tile));
  if (tiles.empty()) return std::nullopt;
  if (cut_axes(D) < D && all.empty()) {
    throw std::logic_error("nobody has told where points lie beyond z: a fault of the program");
  }
  if constexpr (cut_axes(D) == D) {
    if (tiles.size() > 1 || table_.options.plan != nullptr) sketch(tiles);
  }
  return tree_over(std::move(tiles));
}

void TileLoader::take_below(CutTree::NodeRef ref) {
  if (!CutTree::is_tile(ref)) {
    for (const CutTree::NodeRef side : table_.cuts.sides(ref)) take_below(side);
    return;
  }
  const std::uint32_t number = CutTree::tile_at(ref);
  Tile tile = std::exchange(table_.tiles[number], {});
  if (tile.points == 0) return;
  table_.room -= tile.room();
  table_.segments -= tile.segments.size();
  if (tile.segments.size() > 1) {
    std::ranges::stable_sort(tile.segments, {}, &TileSegment::arrival);
    const std::lock_guard lock(table_.stretches_mutex);
    join_all_segments(tile.segments, [&tile](std::uint64_t before, std::uint64_t after) {
      return std::ranges::any_of(tile.held, [=](const HeldPoints& held) {
        return held.arrival_or_last() >= before && held.arrival_or_last() < after;
      });
    });
  }
  const std::lock_guard lock(taken_mutex_);
  taken_.emplace(number, std::move(tile));
}

std::vector<Tile*> TileLoader::waiting() {
  std::vector<Tile*> tiles;
  for (auto& [number, tile] : taken_) tiles.push_back(&tile);
  return tiles;
}

std::uint64_t TileLoader::held_bytes() const {
  std::uint64_t bytes = 0;
  const std::lock_guard lock(taken_mutex_);
  for (const auto& [number, tile] : taken_) bytes += tile.held_bytes();
  return bytes;
}

template <int D>
bool TileLoader::on_disk(const TileNode<D>& node) const {
  const std::lock_guard lock(taken_mutex_);
  return std::ranges::any_of(node.stored, [this](std::uint32_t number) {
    const auto taken = taken_.find(number);
    return taken != taken_.end() && !taken->second.segments.empty();
  });
}

Tile TileLoader::take(std::uint32_t number) {
  const std::lock_guard lock(taken_mutex_);
  const auto taken = taken_.extract(number);
  return taken.empty() ? Tile{} : std::move(taken.mapped());
}

template <int D>
StoredTile TileLoader::read(const TileNode<D>& node) {
  StageTimer timer(times_, Stage::kLoad, StepOrder::kInOrder);
  if (table_.options.one_of_equal && node.points > table_.capacity && node.box.lo == node.box.hi) {
    return one_of(take(node.stored.front()), table_.options);
  }
  StoredTile stored;
  stored.points = node.points;
  for (const std::uint32_t number : node.stored) append_stored(take(number), stored.segments);
  for (const StoredTile::Segment& segment : stored.segments) timer.move_bytes(segment.bytes.size());
  return stored;
}

template <int D>
TilePoints<D> TileLoader::decode(StoredTile stored) const {
  TilePoints<D> result;
  result.left_out = stored.left_out;
  result.resize(stored.points, table_.options.index, table_.options.record_size);
  std::size_t position = 0;
  for (StoredTile::Segment& segment : stored.segments) {
    const std::vector<EncodedBlock> blocks = find_blocks(segment.bytes, segment.where);
    std::vector<std::size_t> first(blocks.size());
    for (std::size_t b = 0; b < first.size(); ++b) {
      first[b] = position;
      position += blocks[b].points;
    }
    parallel_for(blocks.size(), 16, [&](std::size_t, std::size_t begin, std::size_t end) {
      const StageTimer timer(times_, Stage::kLoad);
      PointBlock points;
      for (std::size_t b = begin; b < end; ++b) {
        decode_points(
            std::span<const std::byte>(segment.bytes).subspan(blocks[b].offset, blocks[b].size),
            segment.where, points);
        result.set(first[b], PointsView::of(points));
      }
    });
    segment.buffer.drain([&](const PointsView& points) {
      result.set(position, points);
      position += points.size();
    });
  }
  return result;
}

#define SPILLWAY_INSTANTIATE(D)                                                                   \
  template std::optional<TileNode<D>> TileLoader::nodes_below<D>(CutTree::NodeRef, const Box<D>&) \
      const;                                                                                      \
  template bool TileLoader::on_disk<D>(const TileNode<D>&) const;                                 \
  template StoredTile TileLoader::read<D>(const TileNode<D>&);                                    \
  template TilePoints<D> TileLoader::decode<D>(StoredTile) const;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

template <typename State>
void TileLoader::state(State& state) {
  transfer_taken(state, taken_);
}

template void TileLoader::state(StateReader&);
template void TileLoader::state(StateWriter&);

}  // namespace spillway::stream
