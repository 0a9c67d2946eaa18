#pragma once

#include <spillway/report.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/bytes/json.h"
#include "stream/plan/run_trace.h"
#include "tools/simulate/core_simulation.h"

namespace spillway::command {

/// What --stats tells of a run besides its report.
struct RunFacts {
  std::vector<std::string> inputs{};
  std::string output{};
  std::uint64_t memory_limit = 0;  ///< bytes
  double seconds = 0;              ///< of the whole run
  std::vector<SimulatedRun> simulated{};
  std::uint64_t simulated_points = 0;  ///< of each of these
};

/// What the library reports of a run, and what its trace has told.
struct TracedReport : Report {
  RunSums sums{};
};

/// The object that --stats writes. docs/cli.md lists the keys; they are stable.
Json to_json(const TracedReport& report, const RunFacts& facts);

/// "skipped_files" of --stats.
Json to_json(const std::vector<SkippedFile>& files);

/// "filters" of --stats and of `info`.
Json to_json(const PointCounts& counts);

}  // namespace spillway::command
