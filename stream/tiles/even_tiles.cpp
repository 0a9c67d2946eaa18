#include "stream/tiles/even_tiles.h"

#include <algorithm>

#include "stream/tiles/regions/region_plan.h"

namespace spillway::stream {
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

/// A plan for the tiles that there are, all of which are complete, in the order of cells.
RegionPlan plan_of(const TileTable& table, double most_points) {
  const int dimension = table.options.dimension;
  std::vector<InputRegion> regions;
  for (const std::uint32_t number : numbers_in_order(table.cuts)) {
    const Tile& tile = table.tiles[number];
    const std::uint64_t points =
        std::min<std::uint64_t>(tile.points, table.capacity);  // equal ones
    if (points > 0) regions.push_back({0, tile.box, points});
  }
  std::vector<InputRegion> in_order;
  for (const std::size_t r : nested_order(regions, dimension)) in_order.push_back(regions[r]);
  return plan_regions(in_order,
                      {.dimension = dimension, .most_points = most_points, .any_order = false});
}

}  // namespace

std::vector<std::uint32_t> numbers_in_order(const CutTree& cuts) {
  std::vector<std::uint32_t> numbers;
  append_numbers(cuts, cuts.root(), numbers);
  return numbers;
}

bool tiles_nest(const TileTable& table) {
  const double together = kTilesTogether * static_cast<double>(table.capacity);
  return plan_of(table, together).most_waiting <= kMostWaiting * together;
}

CutTree even_cuts(const TileTable& table) {
  return plan_of(table, kEvenFill * static_cast<double>(table.capacity)).cuts;
}

}  // namespace spillway::stream
