#include "stream/triangulate/task_sums.h"

#include <algorithm>

namespace spillway::stream {

void TaskSums::add_tile(const Task& tile) {
  const std::lock_guard lock(mutex_);
  add_part(sums_, tile);
}

void TaskSums::add_merge(TaskScope scope, std::uint32_t level, const Task& merge) {
  const std::lock_guard lock(mutex_);
  add_task(sums_, scope, level, merge);
}

void TaskSums::add(std::span<const TaskSum> sums) {
  const std::lock_guard lock(mutex_);
  for (const TaskSum& sum : sums) add_sum(sums_, sum);
}

std::vector<TaskSum> TaskSums::sums() const {
  const std::lock_guard lock(mutex_);
  std::vector<TaskSum> sums;
  for (const auto& [key, sum] : sums_) sums.push_back(sum);
  return sums;
}

/// A part of a tile: its children are parts, too. Returns its level.
std::uint32_t TaskSums::add_part(Sums& sums, const Task& part) {
  std::uint32_t level = 0;
  for (const Task& child : part.children) level = std::max(level, add_part(sums, child) + 1);
  add_steps(sums, TaskScope::kInTile, level, part);
  return level;
}

void TaskSums::add_task(Sums& sums, TaskScope scope, std::uint32_t level, const Task& task) {
  add_steps(sums, scope, level, task);
  for (const Task& child : task.children) add_task(sums, scope, level, child);
}

/// The task and all below it but its children.
void TaskSums::add_steps(Sums& sums, TaskScope scope, std::uint32_t level, const Task& task) {
  add_sum(sums, {scope, level, task.kind, 1, task.points, task.seconds, task.grains});
  for (const auto* const steps : {&task.before, &task.after}) {
    for (const Task& step : *steps) add_task(sums, scope, level, step);
  }
}

void TaskSums::add_sum(Sums& sums, const TaskSum& sum) {
  TaskSum& all = sums[{sum.scope, sum.level, sum.kind}];
  all.scope = sum.scope;
  all.level = sum.level;
  all.kind = sum.kind;
  all.tasks += sum.tasks;
  all.points += sum.points;
  all.seconds += sum.seconds;
  all.grains += sum.grains;
}

}  // namespace spillway::stream
