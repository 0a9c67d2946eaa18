#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "stream/points/input_region.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::stream {

/// Which tiles to begin with, and in which order to read, so that tiles are complete early: decided
/// by the boxes of regions alone. A tile that is cut later on stays a *cell* of this plan.
struct RegionPlan {
  struct Cell {
    Box<3> box;  ///< has all points of the cell that any region may have; empty if none may
    double expected = 0;
    std::size_t done_after = 0;  ///< position of the last region that may have points of it
  };
  CutTree cuts;               ///< its tiles are the cells
  std::vector<Cell> cells{};  ///< by tile
  RegionOrder order{};        ///< in which to read
  /// By position in `order.regions`: the cells that are complete when that region has been read.
  std::vector<std::vector<std::uint32_t>> done_after{};
  double most_waiting = 0;  ///< points of cells that are not complete, at the most, as expected
  double done_early = 0;    ///< share of points in cells that are complete before the last points
};

struct RegionPlanOptions {
  int dimension = 2;       ///< only the first axes are looked at
  double most_points = 0;  ///< that a cell expects; more where that would be very many cells
  bool any_order = true;   ///< units may be read in any order
};

/// The plan for regions that are spread evenly over their boxes. Regions with an empty box have no
/// points.
RegionPlan plan_regions(std::span<const InputRegion> regions, const RegionPlanOptions& options);

/// The numbers of regions that have points, in an order in which every cell of a plan gets its
/// regions in one stretch, whatever its size, as far as the plan parts none. For boxes that hardly
/// overlap.
std::vector<std::size_t> nested_order(std::span<const InputRegion> regions, int dimension);

/// Whether enough tiles are complete early for a run that triangulates while it reads.
bool pays(const RegionPlan& plan);

}  // namespace spillway::stream
