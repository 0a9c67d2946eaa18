#include "stream/tiles/tile_sketches.h"

#include <algorithm>

#include "src/geometry/dimensions.h"
#include "stream/points/point_sample.h"
#include "stream/tiles/cuts/tile_cut.h"

namespace spillway::stream {
namespace {

/// So many points for each cell, and cells of a tile: more tell little more.
constexpr double kPointsOfCell = 128;
constexpr std::size_t kMostCells = 4096;
/// Fewer cells tell no more than a box around them.
constexpr std::size_t kFewestCells = 8;
/// What goes to the disk gets at most one of so many cells that are left.
constexpr std::size_t kLeftShare = 4;
/// Points by which it is judged how others lie.
constexpr std::size_t kSample = 4096;

}  // namespace

/// As many as there are for so many points if others take as many.
std::size_t TileSketches::cells_for(std::uint64_t points, std::uint64_t all_points) const {
  const double share = static_cast<double>(points) / static_cast<double>(all_points);
  const double room = share * static_cast<double>(bytes_) / double{CellSketch::kCellBytes};
  const double useful = static_cast<double>(points) / kPointsOfCell;
  return std::min(static_cast<std::size_t>(std::min(room, useful)), kMostCells);
}

/// In the plane strips of flight lines are thin, too, by themselves: only the whole tells there.
bool TileSketches::is_known_hollow(const Tile& tile, const HeldPoints& held) const {
  if (tile.hollow || dimension_ == 2) return tile.hollow;
  PointSample sample(std::max<std::size_t>(1, held.buffer.size() / kSample));
  held.buffer.visit([&](std::span<const LatticePoint> points) { sample.add(points); });
  return is_clearly_hollow(sample.take(), dimension_);
}

std::shared_ptr<CellSketch> TileSketches::begin(const Tile& tile, const HeldPoints& held,
                                                std::uint64_t all_points) {
  const std::size_t all = bytes_ / CellSketch::kCellBytes;
  const std::size_t left = all - std::min(all, cells_begun_);
  const std::size_t cells = std::min(cells_for(held.buffer.size(), all_points), left / kLeftShare);
  if (cells < kFewestCells || !is_known_hollow(tile, held)) return nullptr;
  cells_begun_ += cells;
  return std::make_shared<CellSketch>(dimension_, cells, held.box);
}

template <int D>
void TileSketches::sketch(TileNode<D>& node,
                          const std::function<const Tile&(std::uint32_t)>& stored,
                          std::uint64_t all_points) const {
  Box<3> box;
  std::vector<Box<3>> loose;  // of points of which no more is known
  std::vector<const CellSketch*> sketched;
  std::vector<const PointBuffer*> held_points;
  for (const std::uint32_t number : node.stored) {
    const Tile& tile = stored(number);
    box.expand(tile.box);
    for (const TileSegment& segment : tile.segments) {
      if (segment.sketches.empty()) loose.push_back(segment.box);
      for (const auto& part : segment.sketches) sketched.push_back(part.get());
    }
    for (const HeldPoints& held : tile.held) {
      if (is_known_hollow(tile, held)) {
        held_points.push_back(&held.buffer);
      } else if (held.buffer.size() > 0) {
        loose.push_back(held.box);
      }
    }
  }
  if (sketched.empty() && held_points.empty()) return;
  const auto visit = [&](const auto& visit_part) {
    for (const Box<3>& some : loose) visit_part(some);
    for (const CellSketch* some : sketched) visit_part(*some);
    for (const PointBuffer* some : held_points) {
      some->visit([&](std::span<const LatticePoint> points) { visit_part(points); });
    }
  };
  CellSketch sketch(dimension_, cells_for(node.points, all_points), box);
  visit([&](const auto& part) { sketch.gather(part); });
  if (sketch.size() == 1) return;
  visit([&](const auto& part) { sketch.measure(part); });
  node.sketch = std::make_shared<PointSketch<D>>(sketch.template sketch<D>());
}

#define SPILLWAY_INSTANTIATE(D)          \
  template void TileSketches::sketch<D>( \
      TileNode<D>&, const std::function<const Tile&(std::uint32_t)>&, std::uint64_t) const;
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
