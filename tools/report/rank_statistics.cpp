#include "tools/report/rank_statistics.h"

#include <algorithm>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "tools/report/json_text.h"

namespace spillway::detail {
namespace {

using distributed::Ranks;
using distributed::Reduction;

Json to_json(const MergeFigures& merge) {
  return {{"level", merge.level},
          {"border_simplices", merge.border_simplices},
          {"received_simplices", merge.received_simplices},
          {"received_bytes", merge.received_bytes},
          {"retriangulated_points", merge.retriangulated},
          {"wait_seconds", merge.wait_seconds},
          {"seconds", merge.seconds}};
}

Json rank_json(const RankMesh& mesh, const Ranks& ranks) {
  const StreamFigures& figures = mesh.figures;
  const distributed::Traffic sent = distributed::traffic();
  Json json = {{"rank", ranks.rank()},
               {"points", figures.totals.points},
               {"vertices", figures.totals.vertices},
               {"simplices", figures.totals.simplices},
               {"threads", figures.threads},
               {"tiles", figures.tiles},
               {"leaves", figures.leaves},
               {"spilled_bytes", figures.spilled_bytes},
               {"border_simplices", figures.border_simplices},
               {"border_bytes", figures.border_bytes},
               {"peak_rss_bytes", peak_rss_bytes()},
               {"phases",
                {{"read", figures.read_seconds},
                 {"divide", figures.divide_seconds},
                 {"triangulate", figures.triangulate_seconds}}},
               {"messages_sent", sent.messages},
               {"bytes_sent", sent.bytes},
               {"points_sent", mesh.exchanged_points},
               {"point_bytes_sent", mesh.exchanged_bytes},
               {"border_simplices_sent", mesh.border_simplices_sent},
               {"border_bytes_sent", mesh.border_bytes_sent}};
  Json stages;
  for (std::size_t s = 0; s < kStageNames.size(); ++s) {
    stages[kStageNames[s]] = figures.stage_seconds[s];
  }
  json["stages"] = std::move(stages);
  json["merges"] = Json::array();
  for (const MergeFigures& merge : mesh.merges) json["merges"].push_back(to_json(merge));
  return json;
}

/// Sums of what is counted, the longest of what is timed.
void combine(StreamFigures& figures, const Ranks& ranks) {
  std::vector<std::uint64_t> sums = {
      figures.threads,        figures.tiles,          figures.leaves,
      figures.spilled_points, figures.spilled_bytes,  figures.final_in_leaves,
      figures.final_in_tiles, figures.retriangulated, figures.border_simplices,
      figures.border_bytes,   figures.divided_points};
  ranks.reduce(sums, Reduction::kSum);
  auto sum = sums.begin();
  figures.threads = static_cast<unsigned>(*sum++);
  for (std::uint64_t* const figure :
       {&figures.tiles, &figures.leaves, &figures.spilled_points, &figures.spilled_bytes,
        &figures.final_in_leaves, &figures.final_in_tiles, &figures.retriangulated,
        &figures.border_simplices, &figures.border_bytes, &figures.divided_points}) {
    *figure = *sum++;
  }
  std::uint64_t levels = figures.final_by_level.size();
  ranks.reduce(std::span(&levels, 1), Reduction::kMost);
  figures.final_by_level.resize(levels);
  ranks.reduce(figures.final_by_level, Reduction::kSum);
  ranks.reduce(figures.stage_seconds, Reduction::kSum);
  std::array<double, 3> phases = {figures.read_seconds, figures.divide_seconds,
                                  figures.triangulate_seconds};
  ranks.reduce(phases, Reduction::kMost);
  figures.read_seconds = phases[0];
  figures.divide_seconds = phases[1];
  figures.triangulate_seconds = phases[2];
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void share_statistics(RunStatistics& statistics, const RankMesh& mesh, const Ranks& ranks) {
  statistics.stream = mesh.figures;
  combine(statistics.stream, ranks);
  statistics.stream.totals = mesh.totals;
  statistics.stream.left_out = mesh.left_out;
  statistics.input = shared_counts(statistics.input, ranks);
  std::array<std::uint64_t, 4> sent = {mesh.exchanged_bytes, mesh.exchanged_points,
                                       mesh.border_bytes_sent, mesh.border_simplices_sent};
  ranks.reduce(sent, Reduction::kSum);
  const std::string own = json_text(rank_json(mesh, ranks), -1);
  Json all = Json::array();
  for (const auto& bytes : ranks.gather(as_bytes_of(own), 0)) {
    all.push_back(parse_json(as_text(bytes)));
  }
  statistics.ranks = {{"count", ranks.size()},
                      {"point_bytes_sent_per_point", ratio(sent[0], mesh.totals.points)},
                      {"points_sent_share", ratio(sent[1], mesh.totals.points)},
                      {"border_bytes_sent_per_border_simplex", ratio(sent[2], sent[3])},
                      {"each", std::move(all)}};
}

}  // namespace spillway::detail
