#include "stream/ranks/shared_report.h"

#include <array>
#include <utility>
#include <vector>

#include "src/runtime/packing.h"
#include "src/runtime/process_memory.h"
#include "src/runtime/stage_times.h"
#include "stream/triangulate/task_sums.h"

namespace spillway::detail {
namespace {

using distributed::Ranks;
using distributed::Reduction;

/// Calls `each` with every member of the figures that is one number, sums first, wall times last.
template <typename Figures, typename Each>
void for_each_sum(Figures& figures, Each each) {
  each(figures.tiles);
  each(figures.leaves);
  each(figures.spilled_points);
  each(figures.spilled_bytes);
  each(figures.final_in_leaves);
  each(figures.final_in_tiles);
  each(figures.retriangulated);
  each(figures.border_simplices);
  each(figures.border_bytes);
  each(figures.divided_points);
  each(figures.first_block_read_points);
  each(figures.tile_shapes.up_to_twice);
  each(figures.tile_shapes.up_to_4_times);
  each(figures.tile_shapes.longer);
}

template <typename Figures, typename Each>
void for_each_time(Figures& figures, Each each) {
  each(figures.read_seconds);
  each(figures.divide_seconds);
  each(figures.triangulate_seconds);
}

void pack(Packer& message, const RunFigures& figures) {
  const auto put = [&](const auto& value) { message.put(value); };
  put(figures.mesh);
  put(figures.left_out);
  put(figures.threads);
  put(figures.tile_capacity);
  put(figures.leaf_size);
  for_each_sum(figures, put);
  for_each_time(figures, put);
  message.put_list(figures.final_by_level);
  for (const StageSeconds& stage : figures.stages) put(stage.seconds);
}

RunFigures unpack_figures(Unpacker& message) {
  RunFigures figures;
  const auto take = [&]<typename T>(T& value) { value = message.take<T>(); };
  take(figures.mesh);
  take(figures.left_out);
  take(figures.threads);
  take(figures.tile_capacity);
  take(figures.leaf_size);
  for_each_sum(figures, take);
  for_each_time(figures, take);
  figures.final_by_level = message.take_list<std::vector<std::uint64_t>>();
  for (const char* const stage : kStageNames) {
    figures.stages.push_back({stage, message.take<double>()});
  }
  return figures;
}

std::vector<std::byte> pack_own(const RankMesh& mesh) {
  const distributed::Traffic sent = distributed::traffic();
  Packer message;
  pack(message, mesh.figures);
  message.put_list(mesh.task_sums);
  for (const std::uint64_t figure :
       {peak_memory(), sent.messages, sent.bytes, mesh.exchanged_points, mesh.exchanged_bytes,
        mesh.exchanged_messages}) {
    message.put(figure);
  }
  message.put_list(mesh.merges);
  return message.take();
}

RankFigures unpack_rank(std::span<const std::byte> bytes) {
  Unpacker message(bytes);
  RankFigures rank;
  rank.run = unpack_figures(message);
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
void combine(RunFigures& figures, const Ranks& ranks) {
  std::vector<std::uint64_t> sums = {figures.threads};
  for_each_sum(figures, [&](std::uint64_t figure) { sums.push_back(figure); });
  ranks.reduce(sums, Reduction::kSum);
  auto sum = sums.begin();
  figures.threads = static_cast<unsigned>(*sum++);
  for_each_sum(figures, [&](std::uint64_t& figure) { figure = *sum++; });
  std::uint64_t levels = figures.final_by_level.size();
  ranks.reduce(std::span(&levels, 1), Reduction::kMost);
  figures.final_by_level.resize(levels);
  ranks.reduce(figures.final_by_level, Reduction::kSum);
  std::vector<double> stages;
  for (const StageSeconds& stage : figures.stages) stages.push_back(stage.seconds);
  ranks.reduce(stages, Reduction::kSum);
  for (std::size_t s = 0; s < stages.size(); ++s) figures.stages[s].seconds = stages[s];
  std::vector<double> times;
  for_each_time(figures, [&](double time) { times.push_back(time); });
  ranks.reduce(times, Reduction::kMost);
  auto time = times.begin();
  for_each_time(figures, [&](double& seconds) { seconds = *time++; });
}

}  // namespace

Report shared_report(const RankMesh& mesh, const PointCounts& counts, const Ranks& ranks) {
  Report report;
  static_cast<RunFigures&>(report) = mesh.figures;
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

}  // namespace spillway::detail
