#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/delaunay/schedule.h"
#include "tools/core_simulation.h"
#include "tools/mesh_output.h"

namespace spillway {

/// What --stats tells about a run of `triangulate`. docs/cli.md lists the keys; they are stable.
struct RunStatistics {
  int dimension = 2;
  unsigned threads = 1;
  std::vector<std::string> inputs;
  std::string output;
  std::string output_format;
  bool on_lattice = false;
  std::uint64_t points = 0;
  std::uint64_t withheld = 0;
  std::uint64_t duplicates = 0;
  MeshFigures mesh;
  double seconds = 0;  ///< of the whole run
  double read_seconds = 0;
  double triangulate_seconds = 0;
  double hash_seconds = 0;  ///< counting what is left out included
  double write_seconds = 0;
  std::vector<SimulatedRun> simulated;
  Task tasks;
};

nlohmann::ordered_json to_json(const RunStatistics& statistics);

/// The most memory this process has held so far, in bytes.
std::uint64_t peak_rss_bytes();

}  // namespace spillway
