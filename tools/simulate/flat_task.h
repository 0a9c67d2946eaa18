#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/runtime/task.h"

namespace spillway::command {

/// A task with all below it in little memory: as a row of nodes, parents first. What can only run
/// one after the other is one node.
struct FlatTask {
  struct Node {
    float seconds = 0;           ///< of its own work
    std::uint32_t grains = 1;    ///< independent parts of that
    std::uint32_t end = 0;       ///< of the nodes below it, by number
    std::uint16_t before = 0;    ///< steps before its own work
    std::uint16_t children = 0;  ///< that run at the same time, after it
    std::uint16_t after = 0;     ///< steps after these
  };
  std::vector<Node> nodes{};

  /// Of all nodes.
  [[nodiscard]] double total_seconds() const;
};

/// A task of one grain.
FlatTask one_step(double seconds);

/// The task with all times multiplied; without its `children` if these are told apart.
FlatTask flatten(const Task& task, double factor, bool with_children = true);

/// The same task for so many times the work: longer, and of more grains, where it has many.
FlatTask enlarge(const FlatTask& task, double factor);

}  // namespace spillway::command
