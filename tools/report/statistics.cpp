#include "tools/report/statistics.h"

#include <sys/resource.h>

#include "src/geometry/canonical_hash.h"

namespace spillway::detail {
namespace {

const char* name_of(TaskKind kind) {
  switch (kind) {
    case TaskKind::kNode:
      return "node";
    case TaskKind::kBaseCase:
      return "base_case";
    case TaskKind::kDivide:
      return "divide";
    case TaskKind::kBorder:
      return "border";
    case TaskKind::kAccept:
      return "accept";
    case TaskKind::kNeighbours:
      return "neighbours";
  }
  return "";
}

Json to_json(const Task& task) {
  Json json = {{"kind", name_of(task.kind)},
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

Json to_json(const PointCounts& counts) {
  return {{"read", counts.read},       {"withheld", counts.withheld}, {"every", counts.every},
          {"class", counts.classes},   {"returns", counts.returns},   {"bounds", counts.bounds},
          {"thinned", counts.thinned}, {"kept", counts.kept()}};
}

Json to_json(const RunStatistics& statistics) {
  const StreamFigures& stream = statistics.stream;
  const MeshTotals& totals = stream.totals;
  Json json;
  json["version"] = SPILLWAY_VERSION;
  json["dimension"] = statistics.dimension;
  json["threads"] = stream.threads;
  json["inputs"] = statistics.inputs;
  json["output"] = statistics.output;
  json["output_format"] = statistics.output_format;
  json["output_bytes"] = statistics.output_bytes;
  json["on_lattice"] = statistics.on_lattice;
  json["points"] = totals.points;
  json["withheld"] = statistics.input.withheld;
  json["filters"] = to_json(statistics.input);
  json["duplicates"] = totals.duplicates;
  json["vertices"] = totals.vertices;
  json["simplices"] = totals.simplices;
  json["left_out"] = stream.left_out;
  json["hull_facets"] = totals.hull_facets;
  json["canonical_hash"] = hash_to_hex(totals.canonical_hash);
  json["memory_limit"] = statistics.memory_limit;
  json["peak_rss_bytes"] = peak_rss_bytes();
  json["seconds"] = statistics.seconds;
  json["phases"] = {{"read", stream.read_seconds},
                    {"divide", stream.divide_seconds},
                    {"triangulate", stream.triangulate_seconds},
                    {"write", statistics.write_seconds}};
  Json stages;
  for (std::size_t s = 0; s < kStageNames.size(); ++s) {
    stages[kStageNames[s]] = stream.stage_seconds[s];
  }
  json["stages"] = std::move(stages);
  json["tiles"] = stream.tiles;
  json["tile_capacity"] = stream.tile_capacity;
  json["leaves"] = stream.leaves;
  json["leaf_size"] = stream.leaf_size;
  json["spilled_points"] = stream.spilled_points;
  json["spilled_bytes"] = stream.spilled_bytes;
  json["divided_points"] = stream.divided_points;
  json["final"] = {{"in_leaves", stream.final_in_leaves},
                   {"in_tiles", stream.final_in_tiles},
                   {"by_level", stream.final_by_level}};
  json["retriangulated_points"] = stream.retriangulated;
  json["border_simplices"] = stream.border_simplices;
  json["border_bytes"] = stream.border_bytes;
  if (!statistics.simulated.empty()) {
    json["simulated"] = Json::array();
    for (const SimulatedRun& run : statistics.simulated) {
      json["simulated"].push_back(
          {{"cores", run.cores}, {"seconds", run.seconds}, {"speed_up", run.speed_up}});
    }
  }
  if (statistics.ranks) {
    json["ranks"] = *statistics.ranks;
  } else {
    json["tasks"] = to_json(stream.tasks);
  }
  return json;
}

}  // namespace spillway::detail
