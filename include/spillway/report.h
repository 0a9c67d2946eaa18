#pragma once
// What runs count and time.

#include <spillway/point_counts.h>
#include <spillway/skipped_file.h>
#include <spillway/totals.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spillway {

/// A stage of the work, and the seconds that all threads together have spent in it.
struct StageSeconds {
  std::string_view stage;  ///< "read", "deal", "leaves", "merge", ...
  double seconds = 0;
};

/// Tiles by the longest side of the box around their points, compared with the shortest one.
struct TileShapes {
  std::uint64_t up_to_twice = 0;
  std::uint64_t up_to_4_times = 0;  ///< but more than twice
  std::uint64_t longer = 0;
};

/// What triangulating was like, of a run or of one of its processes.
struct RunStatistics {
  MeshTotals mesh;
  std::uint64_t left_out = 0;  ///< simplices with an edge longer than max_edge
  unsigned threads = 1;        ///< that were used
  std::uint64_t tiles = 0;
  std::uint64_t leaves = 0;
  std::size_t tile_points = 0;       ///< most points of a tile
  std::size_t leaf_points = 0;       ///< most points of a leaf
  std::uint64_t spilled_points = 0;  ///< written to scratch files, twice counted twice
  std::uint64_t spilled_bytes = 0;
  std::uint64_t final_in_leaves = 0;            ///< simplices, infinite ones included
  std::uint64_t final_in_tiles = 0;             ///< by merges inside tiles
  std::vector<std::uint64_t> final_by_level{};  ///< by merges of tiles, the lowest level first
  std::uint64_t retriangulated = 0;             ///< points in triangulations of borders
  std::uint64_t border_simplices = 0;           ///< most that were in memory at a time
  std::uint64_t border_bytes = 0;               ///< likewise
  std::uint64_t divided_points = 0;             ///< dealt once more after they were written
  std::uint64_t first_block_read_points = 0;    ///< read when the first block was written
  TileShapes tile_shapes;
  double read_seconds = 0;         ///< wall time of reading and dealing
  double divide_seconds = 0;       ///< wall time of dividing tiles again
  double triangulate_seconds = 0;  ///< likewise, with all writing but the last
  std::vector<StageSeconds> stages{};
};

/// What a run was like: over processes the sums of all of them, the longest of what is wall time.
struct Report : RunStatistics {
  int dimension = 2;
  PointCounts points;                  ///< of a run from points
  bool on_lattice = false;             ///< predicates saw integers
  std::string output_format{};         ///< of files: "spm", "tif", ...
  std::uint64_t output_bytes = 0;      ///< of files
  std::uint64_t output_files = 1;      ///< of tiles of a mesh: how many have simplices
  std::uint64_t outside_tiles = 0;     ///< simplices in no tile, which no file has
  std::uint64_t outside_vertices = 0;  ///< vertices of no simplex in a tile, likewise
  /// Files of other tiles of a mesh that an earlier run may have left beside these.
  std::vector<std::string> other_files{};
  double write_seconds = 0;  ///< wall time of completing the output
  /// Inputs that PointOptions::skip_broken left out. What was made is complete without them.
  std::vector<SkippedFile> skipped_files{};
  std::vector<std::string> lost{};  ///< attributes of vertices that the output does not hold
};

}  // namespace spillway
