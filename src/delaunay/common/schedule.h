#pragma once

#include <chrono>

#include "src/runtime/task.h"

namespace spillway::delaunay {

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

}  // namespace spillway::delaunay
