// Tiles of which larger ones can be put together, whatever the order in which the points came.

#include <algorithm>
#include <cstdint>
#include <optional>
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

void append_numbers(const CutTree& cuts, CutTree::NodeRef ref,
                    std::vector<std::uint32_t>& numbers) {
  if (CutTree::is_tile(ref)) return numbers.push_back(CutTree::tile_at(ref));
  for (const CutTree::NodeRef side : cuts.sides(ref)) append_numbers(cuts, side, numbers);
}

/// The tiles in the order of the tree: their numbers depend on threads.
std::vector<std::uint32_t> numbers_in_order(const CutTree& cuts) {
  std::vector<std::uint32_t> numbers;
  append_numbers(cuts, cuts.root(), numbers);
  return numbers;
}

}  // namespace

/// A plan for the tiles that there are, all of which are complete, in the order of cells.
RegionPlan TileTree::plan_anew(double most_points) const {
  std::vector<InputRegion> regions;
  for (const std::uint32_t number : numbers_in_order(cuts_)) {
    const Tile& tile = tiles_[number];
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
  CutTree cuts = plan_anew(kEvenFill * static_cast<double>(capacity_)).cuts;
  if (cuts.tiles() == 1) return;
  const std::vector<std::uint32_t> numbers = numbers_in_order(cuts_);
  std::vector<Tile> old = std::exchange(tiles_, std::vector<Tile>(cuts.tiles()));
  cuts_ = std::move(cuts);  // no batch is under way
  ++cuts_made_;
  std::optional<std::uint64_t> last;
  for (const std::uint32_t number : numbers) {
    for (TileSegment& segment : old[number].segments) {
      last = std::max(last, std::optional(segment.last_arrival()));
      leave_over(cuts_.root(), std::move(segment));
    }
  }
  for (Tile& tile : tiles_) {
    tile.cut_at = cuts_made_;
    tile.last_left_over = last;
  }
  for (const std::uint32_t number : numbers) {
    Batch batch;
    room_ -= old[number].room();
    for (HeldPoints& held : old[number].held) {
      if (held.arrival) held.run = ++runs_;  // points of other tiles may have had the same one
      deal_held(std::move(held), batch);
    }
    if (room_ > most_room()) spill_some(batch);
    encode(batch);
    write(batch);
  }
  if (left_over_points_ == 0) cut_long();
}

}  // namespace spillway::detail
