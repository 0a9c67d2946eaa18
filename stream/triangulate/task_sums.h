#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <tuple>
#include <vector>

#include "src/runtime/task.h"
#include "stream/plan/run_trace.h"

namespace spillway::stream {

/// The sums of a run's tasks by scope, level and kind: as much memory as there are levels, whatever
/// the number of tasks. Used by many threads.
class TaskSums {
 public:
  /// Adds all tasks of a tile.
  void add_tile(const Task& tile);

  /// Adds the task of a merge and its steps.
  void add_merge(TaskScope scope, std::uint32_t level, const Task& merge);

  /// Adds sums that were made elsewhere.
  void add(std::span<const TaskSum> sums);

  /// Sorted by scope, level and kind.
  [[nodiscard]] std::vector<TaskSum> sums() const;

 private:
  using Key = std::tuple<TaskScope, std::uint32_t, TaskKind>;
  using Sums = std::map<Key, TaskSum>;

  static std::uint32_t add_part(Sums& sums, const Task& part);
  static void add_task(Sums& sums, TaskScope scope, std::uint32_t level, const Task& task);
  static void add_steps(Sums& sums, TaskScope scope, std::uint32_t level, const Task& task);
  static void add_sum(Sums& sums, const TaskSum& sum);

  mutable std::mutex mutex_;  ///< guards the next one
  Sums sums_;
};

}  // namespace spillway::stream
