// Where the points of hollow tiles lie, as others ask that are triangulated before or after them.

#include <algorithm>
#include <memory>

#include "src/parallel/parallel.h"
#include "stream/tiles/point_sample.h"
#include "stream/tiles/tile_cut.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::detail {
namespace {

/// So many points for each box, and boxes of a tile: more tell little more.
constexpr std::uint64_t kPointsOfBox = 64;
constexpr std::size_t kMostBoxes = 4096;
constexpr std::size_t kFewestBoxes = 16;
/// Points by which it is judged how others lie.
constexpr std::size_t kSample = 1024;

}  // namespace

/// As many as there are for a tile of so many points if others take as many.
std::size_t TileTree::boxes_for_sketch(std::uint64_t points) const {
  const std::uint64_t all = std::max<std::uint64_t>({points_, options_.expected.value_or(0), 1});
  const double share = static_cast<double>(points) / static_cast<double>(all);
  const double room =
      share * static_cast<double>(options_.sketch_bytes) / double{CellSketch::kBoxBytes};
  return std::clamp<std::size_t>(
      static_cast<std::size_t>(std::min(room, static_cast<double>(points / kPointsOfBox))),
      kFewestBoxes, kMostBoxes);
}

/// In the plane strips of flight lines are thin, too, by themselves: only the whole tells there.
bool TileTree::is_known_hollow(const Tile& tile, const HeldPoints& held) const {
  if (tile.hollow || options_.dimension == 2) return tile.hollow;
  PointSample sample(std::max<std::size_t>(1, held.buffer.size() / kSample));
  held.buffer.visit([&](std::span<const LatticePoint> points) { sample.add(points); });
  return is_hollow(sample.take(), options_.dimension);
}

/// Of points that go to the disk, where that pays.
std::shared_ptr<CellSketch> TileTree::begin_sketch(const Tile& tile, const HeldPoints& held) {
  if (!is_known_hollow(tile, held)) return nullptr;
  return std::make_shared<CellSketch>(options_.dimension, boxes_for_sketch(held.buffer.size()));
}

/// Of tiles that have been taken.
template <int D>
void TileTree::sketch_tiles(std::span<TileNode<D>> tiles) const {
  if (tiles.size() == 1 && options_.plan == nullptr) return;  // there is no other
  isolated([&] {
    parallel_for(tiles.size(), 1, [&](std::size_t, std::size_t t, std::size_t) {
      const CellSketch sketch = sketch_of<D>(tiles[t]);
      if (sketch.size() <= 1) return;
      tiles[t].sketch = std::make_shared<RunBoxes<D>>(sketch.template boxes<D>());
    });
  });
}

template <int D>
CellSketch TileTree::sketch_of(const TileNode<D>& node) const {
  CellSketch sketch(options_.dimension, boxes_for_sketch(node.points));
  for (const std::uint32_t number : node.stored) {
    const Tile& tile = taken_.at(number);
    for (const TileSegment& segment : tile.segments) {
      if (segment.sketches.empty()) sketch.add(segment.box);
      for (const auto& part : segment.sketches) sketch.add(*part);
    }
    for (const HeldPoints& held : tile.held) {
      if (is_known_hollow(tile, held)) {
        held.buffer.visit([&](std::span<const LatticePoint> points) { sketch.add(points); });
      } else if (held.buffer.size() > 0) {
        sketch.add(held.box);
      }
    }
  }
  return sketch;
}

template void TileTree::sketch_tiles<2>(std::span<TileNode<2>>) const;
template void TileTree::sketch_tiles<3>(std::span<TileNode<3>>) const;

}  // namespace spillway::detail
