#pragma once
// What runs count and time.

#include <spillway/export.h>

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spillway {

/// What is known of a mesh after its last block.
struct MeshTotals {
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t hull_facets = 0;  ///< facets of one simplex only
  std::uint64_t points = 0;       ///< of the input
  std::uint64_t duplicates = 0;   ///< points that equal another one (in the plane: in x and y)
  /// A number that depends on nothing but the set of simplices, each the set of its vertices'
  /// coordinates; the command prints it as 16 hexadecimal digits.
  std::uint64_t canonical_hash = 0;

  bool operator==(const MeshTotals&) const = default;
};

/// What became of the points of a source. A point is counted where it is dropped first.
struct PointCounts {
  std::uint64_t read = 0;      ///< records
  std::uint64_t invalid = 0;   ///< dropped by PointOptions::skip_invalid
  std::uint64_t withheld = 0;  ///< dropped since flagged so
  std::uint64_t skipped = 0;   ///< by PointOptions::every
  std::uint64_t classes = 0;   ///< of other classes
  std::uint64_t returns = 0;   ///< of other returns
  std::uint64_t bounds = 0;    ///< outside of the bounds
  std::uint64_t thinned = 0;   ///< another one stands for their cell
  /// Bit n: points of class n are among those that `classes` counts.
  std::bitset<256> other_classes{};

  PointCounts& operator+=(const PointCounts& other) {
    read += other.read;
    invalid += other.invalid;
    withheld += other.withheld;
    skipped += other.skipped;
    classes += other.classes;
    returns += other.returns;
    bounds += other.bounds;
    thinned += other.thinned;
    other_classes |= other.other_classes;
    return *this;
  }
  bool operator==(const PointCounts&) const = default;

  [[nodiscard]] std::uint64_t dropped() const {
    return invalid + withheld + skipped + classes + returns + bounds + thinned;
  }
  [[nodiscard]] std::uint64_t kept() const { return read - dropped(); }
};

/// One line: "500 points read, 12 withheld, 300 outside the bounds, 188 kept". Where none are kept,
/// it names other classes: "500 points read, 500 of other classes (1, 3-5), 0 kept".
SPILLWAY_API std::string describe(const PointCounts& counts);

/// What a task does.
enum class TaskKind : std::uint8_t {
  kNode,        ///< all that is done for a part with children
  kBaseCase,    ///< triangulates a leaf
  kDivide,      ///< divides points
  kBorder,      ///< finds the border of a merge
  kAccept,      ///< picks the simplices of a border's triangulation that stay
  kNeighbours,  ///< links them with what was there
};

/// "node", "base_case", ...
SPILLWAY_API const char* to_string(TaskKind kind) noexcept;

/// One task of a run: a node of the k-d recursion, or a step of one. Its parts follow one another
/// in the order of the members: steps `before`, its own work, `children`, steps `after`. Steps run
/// one after the other, children at the same time.
struct Task {
  TaskKind kind = TaskKind::kNode;
  std::size_t points = 0;  ///< points it works on
  double seconds = 0;      ///< wall time of its own work, that of the tasks below it excluded
  std::size_t grains = 1;  ///< independent parts its own work splits into, as those of a loop
  std::vector<Task> before{};
  std::vector<Task> children{};
  std::vector<Task> after{};

  /// Own time and that of all tasks below.
  [[nodiscard]] SPILLWAY_API double total_seconds() const;
};

/// A node of the tree over tiles that is done: a tile, or a merge of tiles.
struct TaskNode {
  std::uint32_t number = 0;               ///< in post-order, from 0; the last is the root
  std::uint32_t level = 0;                ///< merges of tiles below it, at most; 0: a tile
  std::vector<std::uint32_t> children{};  ///< their numbers, in order; none of a tile
  Task task{};  ///< of a tile with all its parts; of a merge without its `children`
};

/// What the levels of a TaskSum count.
enum class TaskScope : std::uint8_t {
  kInTile,        ///< 0: leaves of a tile; above, its merges by their height over the leaves
  kBetweenTiles,  ///< 1 and more: merges of tiles by their height over the tiles
  kBetweenRanks,  ///< 1 and more: merges of ranks
};

/// "in_tile", "between_tiles", "between_ranks".
SPILLWAY_API const char* to_string(TaskScope scope) noexcept;

/// The tasks of one kind at one level, all together. A step counts at the level of the part whose
/// step it is, with all tasks below it: at the levels of merges a base case is one of a border's
/// triangulation, and a tile is divided at its highest level.
struct TaskSum {
  TaskScope scope = TaskScope::kInTile;
  std::uint32_t level = 0;
  TaskKind kind = TaskKind::kNode;
  std::uint64_t tasks = 0;   ///< how many
  std::uint64_t points = 0;  ///< and so on: the sums of their members
  double seconds = 0;
  std::uint64_t grains = 0;
};

/// The time that the tasks would take on `cores` cores, under a greedy schedule: a core that falls
/// free takes the deepest piece that is ready, as work-stealing does. Durations as measured; moving
/// data costs nothing.
SPILLWAY_API double greedy_makespan(const Task& root, unsigned cores);

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

/// What triangulating was like, of a run or of one of its ranks.
struct RunFigures {
  MeshTotals mesh;
  std::uint64_t left_out = 0;  ///< simplices with an edge longer than max_edge
  unsigned threads = 1;        ///< that were used
  std::uint64_t tiles = 0;
  std::uint64_t leaves = 0;
  std::size_t tile_capacity = 0;     ///< most points of a tile
  std::size_t leaf_size = 0;         ///< most points of a leaf
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
  std::vector<TaskSum> task_sums{};  ///< by scope, level and kind
};

/// A merge between two ranks.
struct RankMerge {
  std::uint32_t level = 0;
  std::uint64_t received_bytes = 0;
  std::uint64_t received_simplices = 0;  ///< of the border that came from the other rank
  std::uint64_t border_simplices = 0;    ///< of both borders
  std::uint64_t retriangulated = 0;      ///< points
  double wait_seconds = 0;               ///< for that border
  double seconds = 0;                    ///< of the merge
};

/// What one of several processes did.
struct RankFigures {
  RunFigures run;
  std::uint64_t peak_memory = 0;  ///< bytes that the process has held
  std::uint64_t messages_sent = 0;
  std::uint64_t bytes_sent = 0;
  std::uint64_t points_sent = 0;
  std::uint64_t point_bytes_sent = 0;
  std::uint64_t border_simplices_sent = 0;
  std::uint64_t border_bytes_sent = 0;
  std::vector<RankMerge> merges{};
};

/// What a run was like: over ranks the sums of all of them, the longest of what is wall time.
struct Report : RunFigures {
  int dimension = 2;
  PointCounts points;                ///< of a run from points
  bool on_lattice = false;           ///< predicates saw integers
  std::string output_format{};       ///< of files: "spm", "tif", ...
  std::uint64_t output_bytes = 0;    ///< of files
  double write_seconds = 0;          ///< wall time of completing the output
  std::vector<RankFigures> ranks{};  ///< at the first of several ranks: what each has done
};

}  // namespace spillway
