#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/simulate/run_model.h"

namespace spillway::command {

/// What shortens a run most if there is enough of it.
struct Bottleneck {
  std::string_view name;
  double seconds = 0;  ///< that the run takes then
};

/// What a run would take on so many cores.
struct SimulatedRun {
  unsigned cores = 1;
  double seconds = 0;
  double speed_up = 1;  ///< over the same on one core
  /// At least one; then what shortens it most when there is enough of those before, as far as that
  /// counts, up to more cores.
  std::vector<Bottleneck> bottlenecks{};
};

/// Plays the run on each of these numbers of cores, and again without each resource. `disk_speed`
/// as in SimulatedCores.
std::vector<SimulatedRun> simulate_cores(const RunModel& run, const std::vector<unsigned>& cores,
                                         double disk_speed);

/// A run of about so many points, made of whole copies of this one: its batches come one copy after
/// the other, and so do tiles. Copies are merged in pairs, and such merges are as much larger from
/// level to level as those of the run are. Returns the run itself if the points are fewer.
RunModel enlarge(const RunModel& run, std::uint64_t points);

}  // namespace spillway::command
