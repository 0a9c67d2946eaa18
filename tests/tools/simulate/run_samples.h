#pragma once
// Runs small enough to be played by hand.

#include <utility>
#include <vector>

#include "tools/simulate/run_model.h"

namespace spillway::test {

/// Limits that bound nothing.
inline RunLimits no_limits() {
  return {.batches = 1000,
          .tile_points = 10,
          .loaded_points = 1000000,
          .ready_points = 0,
          .waiting_bytes = 1ULL << 60,
          .threads = 1000};
}

/// A leaf that takes a second, and its block.
inline PartCost leaf(float write = 0, std::uint32_t bytes = 0) {
  return {.work = one_step(1), .write = write, .bytes = bytes};
}

/// A merge of two parts.
inline PartCost merge(double seconds) { return {.work = one_step(seconds), .children = 2}; }

/// Tiles of these parts, all of which are there when all points have been read.
inline RunModel tiles_of(std::uint32_t tiles, std::vector<PartCost> parts) {
  RunModel run;
  run.limits = no_limits();
  run.costs.push_back({.points = 10, .parts = std::move(parts)});
  run.nodes.assign(tiles, {.cost = 0});
  run.points = 100;
  return run;
}

/// A merge of the last two nodes without one.
inline void add_merge_of_tiles(RunModel& run, std::vector<std::uint32_t> children, double seconds) {
  const std::uint32_t after = run.nodes.back().after_batches;
  run.nodes.push_back({.cost = static_cast<std::uint32_t>(run.costs.size()),
                       .children = std::move(children),
                       .after_batches = after});
  run.costs.push_back({.parts = {{.work = one_step(seconds)}}});
}

}  // namespace spillway::test
