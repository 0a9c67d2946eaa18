#include "stream/ranks/shared_report.h"

#include <array>
#include <utility>
#include <vector>

#include "src/runtime/packing.h"
#include "src/runtime/process_memory.h"
#include "src/runtime/stage_times.h"
#include "stream/triangulate/task_sums.h"

namespace spillway::ranks {
namespace {

using distributed::Ranks;
using distributed::Reduction;

/// Calls `each` with every member of the statistics that is one number, sums first, wall times last.
template <typename Statistics, typename Each>
void for_each_sum(Statistics& statistics, Each each) {
  each(statistics.tiles);
  each(statistics.leaves);
  each(statistics.spilled_points);
  each(statistics.spilled_bytes);
  each(statistics.final_in_leaves);
  each(statistics.final_in_tiles);
  each(statistics.retriangulated);
  each(statistics.border_simplices);
  each(statistics.border_bytes);
  each(statistics.divided_points);
  each(statistics.first_block_read_points);
  each(statistics.tile_shapes.up_to_twice);
  each(statistics.tile_shapes.up_to_4_times);
  each(statistics.tile_shapes.longer);
}

template <typename Statistics, typename Each>
void for_each_time(Statistics& statistics, Each each) {
  each(statistics.read_seconds);
  each(statistics.divide_seconds);
  each(statistics.triangulate_seconds);
}

void pack(Packer& message, const RunStatistics& statistics) {
  const auto put = [&](const auto& value) { message.put(value); };
  put(statistics.mesh);
  put(statistics.left_out);
  put(statistics.threads);
  put(statistics.tile_points);
  put(statistics.leaf_points);
  for_each_sum(statistics, put);
  for_each_time(statistics, put);
  message.put_list(statistics.final_by_level);
  for (const StageSeconds& stage : statistics.stages) put(stage.seconds);
}

RunStatistics unpack_statistics(Unpacker& message) {
  RunStatistics statistics;
  const auto take = [&]<typename T>(T& value) { value = message.take<T>(); };
  take(statistics.mesh);
  take(statistics.left_out);
  take(statistics.threads);
  take(statistics.tile_points);
  take(statistics.leaf_points);
  for_each_sum(statistics, take);
  for_each_time(statistics, take);
  statistics.final_by_level = message.take_list<std::vector<std::uint64_t>>();
  for (const char* const stage : kStageNames) {
    statistics.stages.push_back({stage, message.take<double>()});
  }
  return statistics;
}

std::vector<std::byte> pack_own(const RankMesh& mesh) {
  const distributed::Traffic sent = distributed::traffic();
  Packer message;
  pack(message, mesh.statistics);
  message.put_list(mesh.task_sums);
  for (const std::uint64_t figure :
       {peak_memory(), sent.messages, sent.bytes, mesh.exchanged_points, mesh.exchanged_bytes,
        mesh.exchanged_messages}) {
    message.put(figure);
  }
  message.put_list(mesh.merges);
  return message.take();
}

RankStatistics unpack_rank(std::span<const std::byte> bytes) {
  Unpacker message(bytes);
  RankStatistics rank;
  rank.run = unpack_statistics(message);
  rank.task_sums = message.take_list<std::vector<TaskSum>>();
  for (std::uint64_t* const figure :
       {&rank.peak_memory, &rank.messages_sent, &rank.bytes_sent, &rank.points_sent,
        &rank.point_bytes_sent, &rank.point_messages_sent}) {
    *figure = message.take<std::uint64_t>();
  }
  rank.merges = message.take_list<std::vector<RankMerge>>();
  return rank;
}

/// Sums of what is counted, the longest of what is timed.
void combine(RunStatistics& statistics, const Ranks& ranks) {
  std::vector<std::uint64_t> sums = {statistics.threads};
  for_each_sum(statistics, [&](std::uint64_t figure) { sums.push_back(figure); });
  ranks.reduce(sums, Reduction::kSum);
  auto sum = sums.begin();
  statistics.threads = static_cast<unsigned>(*sum++);
  for_each_sum(statistics, [&](std::uint64_t& figure) { figure = *sum++; });
  std::uint64_t levels = statistics.final_by_level.size();
  ranks.reduce(std::span(&levels, 1), Reduction::kMost);
  statistics.final_by_level.resize(levels);
  ranks.reduce(statistics.final_by_level, Reduction::kSum);
  std::vector<double> stages;
  for (const StageSeconds& stage : statistics.stages) stages.push_back(stage.seconds);
  ranks.reduce(stages, Reduction::kSum);
  for (std::size_t s = 0; s < stages.size(); ++s) statistics.stages[s].seconds = stages[s];
  std::vector<double> times;
  for_each_time(statistics, [&](double time) { times.push_back(time); });
  ranks.reduce(times, Reduction::kMost);
  auto time = times.begin();
  for_each_time(statistics, [&](double& seconds) { seconds = *time++; });
}

}  // namespace

Report shared_report(const RankMesh& mesh, const PointCounts& counts, const Ranks& ranks) {
  Report report;
  static_cast<RunStatistics&>(report) = mesh.statistics;
  combine(report, ranks);
  report.mesh = mesh.totals;
  report.left_out = mesh.left_out;
  report.points = shared_counts(counts, ranks);
  return report;
}

RunSums shared_sums(const RankMesh& mesh, const Ranks& ranks) {
  RunSums all;
  TaskSums tasks;
  for (const auto& bytes : ranks.gather(pack_own(mesh), 0)) {
    all.ranks.push_back(unpack_rank(bytes));
    tasks.add(all.ranks.back().task_sums);
  }
  all.tasks = tasks.sums();
  return all;
}

}  // namespace spillway::ranks
