#include "stream/tiles/tile_table.h"

#include <algorithm>

namespace spillway::stream {
namespace {

/// What a tile and a segment take in memory, in points that wait.
constexpr std::size_t kTileRoom = 40;
constexpr std::size_t kSegmentRoom = 12;
/// Sampled points for each capacity of points, where many tiles are made at once.
constexpr std::size_t kManySamples = 2048;

}  // namespace

TileTable::TileTable(const TileTreeOptions& of)
    : options(of), cuts(of.dimension), tiles(1), capacity(of.capacity) {
  if (options.plan == nullptr) return;
  cuts = options.plan->cuts;
  tiles.resize(cuts.tiles());
  for (std::uint32_t cell = 0; cell < tiles.size(); ++cell) {
    tiles[cell].cell = cell;
    cell_roots.push_back(CutTree::ref_of(cell));
  }
  runs = options.plan->order.regions.size();  // each is a run
  divided = true;
}

std::uint64_t TileTable::points_to_come() const {
  return std::max<std::uint64_t>({points, options.expected.value_or(0), 1});
}

std::size_t TileTable::most_room() const {
  const std::size_t taken =
      std::min(tiles.size() * kTileRoom + segments * kSegmentRoom, options.buffered_points / 2);
  return options.buffered_points - taken;
}

std::size_t TileTable::sample_stride() const {
  return std::max<std::size_t>(1, capacity / kManySamples);
}

void TileTable::put(HeldPoints& held, Tile& tile, const PointsView& some, const Box<3>& box) {
  tile.points += some.size();
  tile.box.expand(box);
  held.box.expand(box);
  room -= held.buffer.room();
  held.buffer.append(some);
  room += held.buffer.room();
}

void TileTable::set_cell_root(std::uint32_t tile, std::uint32_t cell, CutTree::NodeRef cut) {
  if (options.plan != nullptr && cell_roots[cell] == CutTree::ref_of(tile)) cell_roots[cell] = cut;
}

}  // namespace spillway::stream
