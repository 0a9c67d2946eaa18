#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spillway::detail {

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
  std::size_t pieces = 1;  ///< independent pieces its own work splits into (a loop's grains)
  std::vector<Task> before;
  std::vector<Task> children;
  std::vector<Task> after;

  /// Own time and that of all tasks below.
  [[nodiscard]] double total_seconds() const;
};

/// Adds the time between its construction and its destruction to a task's seconds.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

/// The time that the tasks would take on `cores` cores, under a greedy schedule: a core that falls
/// free takes the deepest piece that is ready, as work-stealing does. Durations as measured; moving
/// data costs nothing.
double greedy_makespan(const Task& root, unsigned cores);

}  // namespace spillway::detail
