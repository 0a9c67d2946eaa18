#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/rooms.h"

namespace spillway::stream {

/// Cells that wait for units of the input.
struct WaitingCell {
  std::vector<std::size_t> units;  ///< that may have points of it, each once
  double points = 0;               ///< that all of them have of it
};

/// The order in which to read units, so that few points wait for others: the next cell to be
/// completed is one beside those that are begun for which the fewest points have to be read, less
/// those of all cells that are complete then. `points` has those of each unit; the cells come in
/// an order in which neighbours follow each other.
std::vector<std::size_t> reading_order(std::span<const WaitingCell> cells,
                                       std::span<const double> points);

}  // namespace spillway::stream
