#include "stream/tiles/tile_node.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "src/geometry/dimensions.h"
#include "stream/tiles/cuts/tile_cut.h"

namespace spillway::stream {
namespace {

/// An axis may be halved whose extent is at least this share of the longest one.
constexpr double kLeastExtent = 0.5;
/// The smaller side has at least this share of the points, if that can be.
constexpr double kLeastShare = 0.3;
/// What uneven sides cost, and a shorter axis, against boxes that overlap all along the axis.
constexpr double kImbalanceCost = 0.3;
constexpr double kShortAxisCost = 0.2;

template <int D>
void sort_along(std::span<TileNode<D>> tiles, int axis) {
  std::stable_sort(tiles.begin(), tiles.end(), [axis](const TileNode<D>& a, const TileNode<D>& b) {
    return a.box.lo[axis] + a.box.hi[axis] < b.box.lo[axis] + b.box.hi[axis];
  });
}

/// Where to part tiles that are sorted along an axis.
struct Parting {
  int axis = 0;
  std::size_t first_above = 1;
  double cost = std::numeric_limits<double>::infinity();
};

template <int D>
Parting best_parting(std::span<const TileNode<D>> tiles, int axis, double extent,
                     std::uint64_t points) {
  const std::size_t count = tiles.size();
  std::vector<double> lowest(count);  // of this tile and those after it
  double low = std::numeric_limits<double>::infinity();
  for (std::size_t i = count; i-- > 0;) lowest[i] = low = std::min(low, tiles[i].box.lo[axis]);
  Parting best;
  double highest = -std::numeric_limits<double>::infinity();
  std::uint64_t below = 0;
  for (std::size_t i = 1; i < count; ++i) {
    highest = std::max(highest, tiles[i - 1].box.hi[axis]);
    below += tiles[i - 1].points;
    const double uneven = std::abs(static_cast<double>(below) / static_cast<double>(points) - 0.5);
    const double overlap = extent > 0 ? std::max(0.0, highest - lowest[i]) / extent : 1;
    const double cost =
        overlap + kImbalanceCost * uneven + 10 * std::max(0.0, uneven - (0.5 - kLeastShare));
    if (cost < best.cost) best = {axis, i, cost};
  }
  return best;
}

template <int D>
TileNode<D> tree_of(std::span<TileNode<D>> tiles) {
  if (tiles.size() == 1) return std::move(tiles[0]);
  TileNode<D> node;
  for (const TileNode<D>& tile : tiles) {
    node.box.expand(tile.box);
    node.points += tile.points;
  }
  double longest = 0;
  for (int k = 0; k < cut_axes(D); ++k) longest = std::max(longest, node.box.extent(k));
  Parting best;
  int sorted_along = -1;
  for (int k = 0; k < cut_axes(D); ++k) {
    const double extent = node.box.extent(k);
    if (extent < kLeastExtent * longest) continue;
    sort_along(tiles, k);
    sorted_along = k;
    Parting parting = best_parting<D>(tiles, k, extent, node.points);
    if (longest > 0) parting.cost += kShortAxisCost * (1 - extent / longest);
    if (parting.cost < best.cost) best = parting;
  }
  if (sorted_along != best.axis) sort_along(tiles, best.axis);
  node.children.push_back(tree_of(tiles.first(best.first_above)));
  node.children.push_back(tree_of(tiles.subspan(best.first_above)));
  return node;
}

}  // namespace

template <int D>
TileNode<D> tree_over(std::vector<TileNode<D>> tiles) {
  return tree_of(std::span(tiles));
}

#define SPILLWAY_INSTANTIATE(D) template TileNode<D> tree_over(std::vector<TileNode<D>>);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
