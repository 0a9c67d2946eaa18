#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/bytes/json.h"
#include "stream/pipeline.h"
#include "stream/source/point_filter.h"
#include "tools/report/core_simulation.h"

namespace spillway::detail {

/// What --stats tells about a run of `triangulate`. docs/cli.md lists the keys; they are stable.
struct RunStatistics {
  int dimension = 2;
  std::vector<std::string> inputs;
  std::string output;
  std::string output_format;
  bool on_lattice = false;
  PointCounts input;
  std::optional<double> max_edge;
  std::uint64_t memory_limit = 0;  ///< bytes
  StreamFigures stream;
  std::uint64_t output_bytes = 0;
  double seconds = 0;        ///< of the whole run
  double write_seconds = 0;  ///< completing the output, after the last simplex
  std::vector<SimulatedRun> simulated;
  std::optional<Json> ranks{};  ///< of a run over ranks: what each has done
};

Json to_json(const RunStatistics& statistics);

/// "filters" of --stats and of `info`.
Json to_json(const PointCounts& counts);

/// The most memory this process has held so far, in bytes.
std::uint64_t peak_rss_bytes();

}  // namespace spillway::detail
