#include "tools/statistics.h"

#include <sys/resource.h>

#include "src/geometry/canonical_hash.h"

namespace spillway {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Task& task) {
  Json json = {{"kind", task.kind},
               {"points", task.points},
               {"seconds", task.seconds},
               {"pieces", task.pieces}};
  const auto add_list = [&json](const char* key, const std::vector<Task>& tasks) {
    if (tasks.empty()) return;
    json[key] = Json::array();
    for (const Task& below : tasks) json[key].push_back(to_json(below));
  };
  add_list("before", task.before);
  add_list("children", task.children);
  add_list("after", task.after);
  return json;
}

}  // namespace

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

Json to_json(const RunStatistics& statistics) {
  Json json;
  json["version"] = SPILLWAY_VERSION;
  json["dimension"] = statistics.dimension;
  json["threads"] = statistics.threads;
  json["inputs"] = statistics.inputs;
  json["output"] = statistics.output;
  json["output_format"] = statistics.output_format;
  json["on_lattice"] = statistics.on_lattice;
  json["points"] = statistics.points;
  json["withheld"] = statistics.withheld;
  json["duplicates"] = statistics.duplicates;
  json["vertices"] = statistics.mesh.vertices;
  json["simplices"] = statistics.mesh.simplices;
  json["left_out"] = statistics.mesh.left_out;
  json["hull_facets"] = statistics.mesh.hull_facets;
  json["canonical_hash"] = hash_to_hex(statistics.mesh.canonical_hash);
  json["peak_rss_bytes"] = peak_rss_bytes();
  json["seconds"] = statistics.seconds;
  json["phases"] = {{"read", statistics.read_seconds},
                    {"triangulate", statistics.triangulate_seconds},
                    {"hash", statistics.hash_seconds},
                    {"write", statistics.write_seconds}};
  if (!statistics.simulated.empty()) {
    json["simulated"] = Json::array();
    for (const SimulatedRun& run : statistics.simulated) {
      json["simulated"].push_back(
          {{"cores", run.cores}, {"seconds", run.seconds}, {"speed_up", run.speed_up}});
    }
  }
  json["tasks"] = to_json(statistics.tasks);
  return json;
}

}  // namespace spillway
