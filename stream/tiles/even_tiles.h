#pragma once

#include <cstdint>
#include <vector>

#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/tile_table.h"

namespace spillway::stream {

/// The tiles in the order of the tree: their numbers depend on threads.
std::vector<std::uint32_t> numbers_in_order(const CutTree& cuts);

/// Whether larger tiles can be put together of these in their order, so that few are begun and not
/// complete at a time. So it is where tiles have been cut in halves of all points, but not where
/// they were cut as the points came, across a flight line first. All of them are complete.
bool tiles_nest(const TileTable& table);

/// Cuts by which all points are divided into tiles that nest.
CutTree even_cuts(const TileTable& table);

}  // namespace spillway::stream
