#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/rooms.h"

namespace spillway::runtime {

/// What a task does.
enum class TaskKind : std::uint8_t {
  kNode,        ///< all that is done for a part with children
  kBaseCase,    ///< triangulates a leaf
  kDivide,      ///< divides points
  kBorder,      ///< finds the border of a merge
  kAccept,      ///< picks the simplices of a border's triangulation that stay
  kNeighbours,  ///< links them with what was there
};

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
  [[nodiscard]] double total_seconds() const;
};

}  // namespace spillway::runtime
