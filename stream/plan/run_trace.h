#pragma once
// What a run tells of itself, for who plays it again or looks for what takes time.

#include <spillway/report.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/runtime/stage_times.h"
#include "src/runtime/task.h"

namespace spillway::stream {

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

/// What bounds how much of a run can go on at the same time.
struct RunLimits {
  std::uint64_t batches = 0;        ///< of points, on their way to their tiles
  std::uint64_t tile_points = 0;    ///< that a tile counts for at most among the next
  std::uint64_t loaded_points = 0;  ///< of tiles that are worked on at a time, or one tile
  std::uint64_t ready_points = 0;   ///< of tiles, beyond one, before who reads lends a hand
  std::uint64_t waiting_bytes = 0;  ///< of output that waits for its turn while tiles are begun
  unsigned threads = 0;             ///< for which there is memory
};

/// What one rank had of a merge between ranks.
struct RankMerge {
  std::uint32_t level = 0;
  int ranks = 0;                          ///< that have taken part
  std::uint64_t border_simplices = 0;     ///< of its share, before
  std::uint64_t exposed_simplices = 0;    ///< of these, that the other half might change
  std::uint64_t border_points = 0;        ///< that had to be triangulated again, by all
  std::uint64_t retriangulated = 0;       ///< of these, by this rank
  std::uint64_t inner_merges = 0;         ///< of parts of these, of which this rank had one
  std::uint64_t inner_border_points = 0;  ///< of the borders of those merges, together
  std::uint64_t sent_bytes = 0;
  double seconds = 0;
  double wait_seconds = 0;           ///< of these, in exchanges
  std::uint64_t calls = 0;           ///< exchanges, and what else ranks do together
  double processor_seconds = 0;      ///< that it worked, these excluded
  double triangulation_seconds = 0;  ///< of these, for points of borders
};

/// What one of several processes did.
struct RankStatistics {
  RunStatistics run;
  std::vector<TaskSum> task_sums{};  ///< by scope, level and kind
  std::uint64_t peak_memory = 0;     ///< bytes that the process has held
  std::uint64_t messages_sent = 0;
  std::uint64_t bytes_sent = 0;
  std::uint64_t points_sent = 0;
  std::uint64_t point_bytes_sent = 0;
  std::uint64_t point_messages_sent = 0;
  std::vector<RankMerge> merges{};
};

/// What a run knows when it has ended.
struct RunSums {
  std::vector<TaskSum> tasks{};         ///< by scope, level and kind, of all ranks
  std::vector<RankStatistics> ranks{};  ///< at the first of several ranks: what each has done
};

}  // namespace spillway::stream

namespace spillway {

/// Takes what a run tells. Calls come one at a time, from any of the run's threads.
class RunTrace {
 public:
  virtual ~RunTrace() = default;

  /// Whether it wants the nodes of the tree over tiles, or each step: that costs time, and is not
  /// for runs over ranks.
  [[nodiscard]] virtual bool takes_nodes() const { return false; }
  [[nodiscard]] virtual bool takes_steps() const { return false; }

  /// What the run keeps to, before the first step.
  virtual void limits(const stream::RunLimits& /*limits*/) {}
  /// A step that is done, by the thread that has done it. Must not throw.
  virtual void step(const runtime::StageStep& /*step*/) {}
  /// A node that is done, children before parents and else in any order. What it throws ends the
  /// run.
  virtual void node(const stream::TaskNode& /*node*/) {}
  /// The run begins again: all that was told so far is void.
  virtual void begin_again() {}
  /// The run has ended, but for completing the output.
  virtual void end(const stream::RunSums& /*sums*/) {}
};

}  // namespace spillway
