#pragma once

#include "tools/simulate/run_model.h"

namespace spillway::command {

/// What a run is played on.
struct SimulatedCores {
  unsigned cores = 1;
  double disk_speed = 0;  ///< bytes a second; 0: the disk takes no time
};

/// How many seconds the run takes there. Every core works as fast as that on which it was measured,
/// and moving data between cores costs nothing.
double play(const RunModel& run, const SimulatedCores& on);

}  // namespace spillway::command
