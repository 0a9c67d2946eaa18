#include "tools/simulate/core_simulation.h"

#include <optional>
#include <utility>

#include "tools/simulate/resource.h"
#include "tools/simulate/run_player.h"

namespace spillway::command {
namespace {

/// How many bottlenecks are told of, one behind the other, and what share of the time all but the
/// first must take.
constexpr std::size_t kMostBottlenecks = 4;
constexpr double kLeastShare = 0.02;

/// A run with what it is played on, and the seconds that takes.
struct Played {
  RunModel run;
  SimulatedCores on;
  double seconds = 0;
};

Played play_without(const Played& played, Resource resource) {
  Played free = played;
  make_free(resource, free.run);
  free.on = make_free(resource, played.on, played.run);
  free.seconds = play(free.run, free.on);
  return free;
}

std::vector<Bottleneck> bottlenecks_of(Played played) {
  std::vector<Bottleneck> found;
  while (found.size() < kMostBottlenecks) {
    std::optional<Played> best;
    Resource best_resource{};
    for (const Resource resource : all_resources()) {
      Played free = play_without(played, resource);
      if (best && free.seconds >= best->seconds) continue;
      best = std::move(free);
      best_resource = resource;
    }
    if (!found.empty() && best->seconds > (1 - kLeastShare) * played.seconds) break;
    found.push_back({name_of(best_resource), best->seconds});
    if (best_resource == Resource::kCores) break;
    played = *std::move(best);
  }
  return found;
}

}  // namespace

std::vector<SimulatedRun> simulate_cores(const RunModel& run, const std::vector<unsigned>& cores,
                                         double disk_speed) {
  const double alone = play(run, {1, disk_speed});
  std::vector<SimulatedRun> runs;
  for (const unsigned count : cores) {
    const SimulatedCores on{count, disk_speed};
    const double seconds = play(run, on);
    runs.push_back({.cores = count,
                    .seconds = seconds,
                    .speed_up = seconds > 0 ? alone / seconds : 1,
                    .bottlenecks = bottlenecks_of({run, on, seconds})});
  }
  return runs;
}

}  // namespace spillway::command
