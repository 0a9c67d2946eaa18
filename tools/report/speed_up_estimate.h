#pragma once

#include <spillway/figures.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spillway::detail {

/// Reads a list of core counts: "1,2,8", and "1,2,4,...,1024", where the dots stand for doubling.
/// Throws UsageError.
std::vector<unsigned> parse_core_list(std::string_view text);

/// What a greedy schedule of measured tasks would reach.
struct SimulatedRun {
  unsigned cores;
  double seconds;
  double speed_up;  ///< over the same schedule on one core
};

/// Puts the tree of a run's tasks together from its nodes.
class TaskTree {
 public:
  /// Children before parents.
  void add(TaskNode node);

  /// After the last node: its task, with all below. An empty task if there was none.
  [[nodiscard]] Task take();

 private:
  std::map<std::uint32_t, Task> roots_;  ///< by number, those that wait for their parents
};

std::vector<SimulatedRun> simulate_cores(const Task& tasks, const std::vector<unsigned>& cores);

/// A table for people: a heading, then one line a run; no line end after the last.
std::string simulation_table(const std::vector<SimulatedRun>& runs);

}  // namespace spillway::detail
