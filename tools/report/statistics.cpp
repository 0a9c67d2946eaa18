#include "tools/report/statistics.h"

#include <utility>

#include "src/geometry/canonical_hash.h"
#include "src/runtime/process_memory.h"
#include "tools/report/task_json.h"

namespace spillway::command {
namespace {

Json task_sums(const RunSums& sums) {
  Json json = Json::array();
  for (const TaskSum& sum : sums.tasks) json.push_back(to_json(sum));
  return json;
}

Json phases(const RunStatistics& statistics) {
  return {{"read", statistics.read_seconds},
          {"divide", statistics.divide_seconds},
          {"triangulate", statistics.triangulate_seconds}};
}

Json stages(const RunStatistics& statistics) {
  Json json = Json::object();
  for (const StageSeconds& stage : statistics.stages)
    json[std::string(stage.stage)] = stage.seconds;
  return json;
}

Json to_json(const RankMerge& merge) {
  return {{"level", merge.level},
          {"ranks", merge.ranks},
          {"border_simplices", merge.border_simplices},
          {"exposed_simplices", merge.exposed_simplices},
          {"border_points", merge.border_points},
          {"retriangulated_points", merge.retriangulated},
          {"inner_merges", merge.inner_merges},
          {"inner_border_points", merge.inner_border_points},
          {"sent_bytes", merge.sent_bytes},
          {"seconds", merge.seconds},
          {"wait_seconds", merge.wait_seconds},
          {"calls", merge.calls},
          {"processor_seconds", merge.processor_seconds},
          {"triangulation_seconds", merge.triangulation_seconds}};
}

Json to_json(const RankStatistics& rank, std::size_t number) {
  const RunStatistics& run = rank.run;
  Json json = {{"rank", number},
               {"points", run.mesh.points},
               {"vertices", run.mesh.vertices},
               {"simplices", run.mesh.simplices},
               {"threads", run.threads},
               {"tiles", run.tiles},
               {"leaves", run.leaves},
               {"spilled_bytes", run.spilled_bytes},
               {"border_simplices", run.border_simplices},
               {"border_bytes", run.border_bytes},
               {"peak_rss_bytes", rank.peak_memory},
               {"phases", phases(run)},
               {"messages_sent", rank.messages_sent},
               {"bytes_sent", rank.bytes_sent},
               {"points_sent", rank.points_sent},
               {"point_bytes_sent", rank.point_bytes_sent},
               {"point_messages_sent", rank.point_messages_sent}};
  json["stages"] = stages(run);
  json["merges"] = Json::array();
  for (const RankMerge& merge : rank.merges) json["merges"].push_back(to_json(merge));
  return json;
}

Json to_json(const SimulatedRun& run) {
  Json bottlenecks = Json::array();
  for (const Bottleneck& bottleneck : run.bottlenecks) {
    bottlenecks.push_back(
        {{"name", std::string(bottleneck.name)}, {"seconds_without", bottleneck.seconds}});
  }
  Json json = {{"cores", run.cores},
               {"seconds", run.seconds},
               {"speed_up", run.speed_up},
               {"bottleneck", std::string(run.bottlenecks.front().name)}};
  json["bottlenecks"] = std::move(bottlenecks);
  return json;
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// "ranks": what all of them have sent, and what each has done.
Json ranks(const TracedReport& report) {
  RankStatistics sent;
  RankMerge merges;
  Json each = Json::array();
  std::size_t number = 0;
  for (const RankStatistics& rank : report.sums.ranks) {
    sent.points_sent += rank.points_sent;
    sent.point_bytes_sent += rank.point_bytes_sent;
    for (const RankMerge& merge : rank.merges) {
      merges.border_simplices += merge.border_simplices;
      merges.sent_bytes += merge.sent_bytes;
    }
    each.push_back(to_json(rank, number++));
  }
  return {
      {"count", report.sums.ranks.size()},
      {"point_bytes_sent_per_point", ratio(sent.point_bytes_sent, report.mesh.points)},
      {"points_sent_share", ratio(sent.points_sent, report.mesh.points)},
      {"border_bytes_sent_per_border_simplex", ratio(merges.sent_bytes, merges.border_simplices)},
      {"each", std::move(each)}};
}

}  // namespace

Json to_json(const std::vector<SkippedFile>& files) {
  Json json = Json::array();
  for (const SkippedFile& file : files) {
    json.push_back({{"path", file.path}, {"message", file.message}});
  }
  return json;
}

Json to_json(const PointCounts& counts) {
  return {{"read", counts.read},     {"invalid", counts.invalid}, {"withheld", counts.withheld},
          {"every", counts.skipped}, {"class", counts.classes},   {"returns", counts.returns},
          {"bounds", counts.bounds}, {"clip", counts.clip},       {"thinned", counts.thinned},
          {"kept", counts.kept()},   {"lost", counts.lost},       {"where", counts.where}};
}

Json to_json(const TracedReport& report, const RunFacts& facts) {
  const MeshTotals& mesh = report.mesh;
  Json json;
  json["version"] = SPILLWAY_VERSION;
  json["dimension"] = report.dimension;
  json["threads"] = report.threads;
  json["inputs"] = facts.inputs;
  json["output"] = facts.output;
  json["output_format"] = report.output_format;
  json["output_bytes"] = report.output_bytes;
  json["output_files"] = report.output_files;
  json["outside_tiles"] = report.outside_tiles;
  json["outside_vertices"] = report.outside_vertices;
  json["other_files"] = report.other_files;
  json["on_lattice"] = report.on_lattice;
  json["points"] = mesh.points;
  json["withheld"] = report.points.withheld;
  json["skipped_files"] = to_json(report.skipped_files);
  json["lost"] = report.lost;
  json["filters"] = to_json(report.points);
  json["duplicates"] = mesh.duplicates;
  json["vertices"] = mesh.vertices;
  json["simplices"] = mesh.simplices;
  json["left_out"] = report.left_out;
  json["hull_facets"] = mesh.hull_facets;
  json["canonical_hash"] = hash_to_hex(mesh.canonical_hash);
  json["memory_limit"] = facts.memory_limit;
  json["peak_rss_bytes"] = peak_memory();
  json["seconds"] = facts.seconds;
  json["phases"] = phases(report);
  json["phases"]["write"] = report.write_seconds;
  json["stages"] = stages(report);
  json["tiles"] = report.tiles;
  json["tile_capacity"] = report.tile_points;
  json["leaves"] = report.leaves;
  json["leaf_size"] = report.leaf_points;
  json["spilled_points"] = report.spilled_points;
  json["spilled_bytes"] = report.spilled_bytes;
  json["divided_points"] = report.divided_points;
  json["first_block_read_points"] = report.first_block_read_points;
  json["tile_shapes"] = {{"up_to_twice", report.tile_shapes.up_to_twice},
                         {"up_to_4_times", report.tile_shapes.up_to_4_times},
                         {"longer", report.tile_shapes.longer}};
  json["final"] = {{"in_leaves", report.final_in_leaves},
                   {"in_tiles", report.final_in_tiles},
                   {"by_level", report.final_by_level}};
  json["retriangulated_points"] = report.retriangulated;
  json["border_simplices"] = report.border_simplices;
  json["border_bytes"] = report.border_bytes;
  if (!facts.simulated.empty()) {
    json["simulated"] = Json::array();
    for (const SimulatedRun& run : facts.simulated) {
      json["simulated"].push_back(to_json(run));
    }
    json["simulated_points"] = facts.simulated_points;
  }
  json["task_sums"] = task_sums(report.sums);
  if (!report.sums.ranks.empty()) json["ranks"] = ranks(report);
  return json;
}

}  // namespace spillway::command
