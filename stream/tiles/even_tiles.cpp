// Tiles of which larger ones can be put together, whatever the order in which the points came.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "stream/tiles/tile_tree.h"

namespace spillway::detail {
namespace {

/// So many tiles are put together on trial ...
constexpr double kTilesTogether = 8;
/// ... and no more points may wait for others than so many of those have.
constexpr double kMostWaiting = 4;
/// How full tiles are meant to get.
constexpr double kEvenFill = 0.7;

}  // namespace

/// A plan for the tiles that there are, all of which are complete, in the order of cells.
RegionPlan TileTree::plan_anew(double most_points) const {
  std::vector<InputRegion> regions;
  for (const Tile& tile : tiles_) {
    const std::uint64_t points = std::min<std::uint64_t>(tile.points, capacity_);  // equal ones
    if (points > 0) regions.push_back({0, tile.box, points});
  }
  std::vector<InputRegion> in_order;
  for (const std::size_t r : nested_order(regions, options_.dimension)) {
    in_order.push_back(regions[r]);
  }
  return plan_regions(
      in_order, {.dimension = options_.dimension, .most_points = most_points, .any_order = false});
}

bool TileTree::nests() const {
  if (points_ == 0) return true;
  const double together = kTilesTogether * static_cast<double>(capacity_);
  return plan_anew(together).most_waiting <= kMostWaiting * together;
}

void TileTree::divide_evenly() {
  if (points_ == 0) return;
  RegionPlan plan = plan_anew(kEvenFill * static_cast<double>(capacity_));
  if (plan.cuts.tiles() == 1) return;
  std::vector<Tile> old = std::exchange(tiles_, {});
  cuts_ = std::move(plan.cuts);
  ++cuts_made_;
  tiles_.resize(cuts_.tiles());
  for (Tile& tile : tiles_) tile.cut_at = cuts_made_;
  for (Tile& tile : old) {
    for (TileSegment& segment : tile.segments) leave_over(cuts_.root(), std::move(segment));
    room_ -= tile.room();
    Batch batch;
    for (HeldPoints& held : tile.held) deal_held(std::move(held), batch);
    encode(batch);
    write(batch);
  }
}

}  // namespace spillway::detail
