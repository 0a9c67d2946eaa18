#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/delaunay/base_case.h"
#include "src/delaunay/divide.h"
#include "src/delaunay/schedule.h"
#include "src/geometry/box.h"
#include "src/runtime/stage_times.h"
#include "stream/output/heights.h"

namespace spillway::detail {

/// How `triangulate_stream` does its work. Of these only max_edge and heights change the mesh; the
/// order of the stream depends on memory and the sizes, never on threads.
struct StreamOptions {
  unsigned threads = 1;
  std::size_t tile_capacity = 0;    ///< points of a tile; 0: chosen by the memory limit
  std::size_t buffered_points = 0;  ///< waiting in memory before any is spilled; 0: likewise
  std::size_t leaf_size = 0;        ///< points of a leaf; 0: chosen by D, n and the memory limit
  DivisionScheme division = DivisionScheme::kLongestExtent;
  unsigned children = 2;  ///< parts of a tile that are merged at a time
  BaseCaseKernel kernel = BaseCaseKernel::kOwn;
  HeightChoice heights = HeightChoice::kFirst;
  std::optional<double> max_edge{};  ///< leave out simplices with a longer edge, in output units
  bool input_index = false;
  /// Told the box around all points in x and y, in the coordinates in which the source gives them,
  /// and how many they are, before the first block is written.
  std::function<void(const Box<2>&, std::uint64_t points)> extent_known = [](const Box<2>&,
                                                                             std::uint64_t) {};
  /// Called when a phase begins: "read", "divide" if there are tiles to be divided again,
  /// "triangulate"; and when it has ended, with all points that have been through it.
  std::function<void(const char* phase)> begin_phase = [](const char*) {};
  std::function<void(std::uint64_t points)> end_phase = [](std::uint64_t) {};
  /// Told how many points have been through the phase; called by many threads.
  std::function<void(std::uint64_t points, std::optional<double> fraction)> progress =
      [](std::uint64_t, std::optional<double>) {};
};

/// What a run was like.
struct StreamFigures {
  MeshTotals totals;
  std::uint64_t left_out = 0;  ///< simplices with an edge longer than max_edge
  unsigned threads = 1;        ///< that were used
  std::uint64_t tiles = 0;
  std::uint64_t leaves = 0;
  std::size_t tile_capacity = 0;
  std::size_t leaf_size = 0;
  std::uint64_t spilled_points = 0;  ///< written to the disk, a point written twice counted twice
  std::uint64_t spilled_bytes = 0;
  std::uint64_t final_in_leaves = 0;          ///< simplices, infinite ones included
  std::uint64_t final_in_tiles = 0;           ///< by merges inside tiles
  std::vector<std::uint64_t> final_by_level;  ///< by merges of tiles, the lowest level first
  std::uint64_t retriangulated = 0;           ///< points in triangulations of borders
  std::uint64_t border_simplices = 0;         ///< most that were resident at a time
  std::uint64_t border_bytes = 0;
  std::uint64_t divided_points = 0;  ///< of tiles that were divided again, each time
  double read_seconds = 0;           ///< wall time of reading, dealing and spilling
  double divide_seconds = 0;         ///< wall time of dividing tiles again
  double triangulate_seconds = 0;    ///< wall time of all that follows
  /// Seconds of all threads together, by Stage.
  std::array<double, kStageNames.size()> stage_seconds{};
  Task tasks;
};

}  // namespace spillway::detail
