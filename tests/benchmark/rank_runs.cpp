#include "tests/benchmark/rank_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

namespace spillway::test {
namespace {

using Json = nlohmann::json;

/// Terrain consists of integers, as LAS does; the other families go to npy.
std::string input_of(const Plan& plan) {
  return plan.folder + (plan.family == "terrain" ? "/benchmark.las" : "/benchmark.npy");
}
std::string mesh_of(const Plan& plan) { return plan.folder + "/benchmark.spm"; }
std::string statistics_of(const Plan& plan) { return plan.folder + "/benchmark.json"; }

std::vector<std::string> triangulate(const Plan& plan, int threads) {
  return {plan.command,
          "triangulate",
          "-q",
          input_of(plan),
          "-o",
          mesh_of(plan),
          "--dim",
          std::to_string(plan.dimension),
          "--memory",
          fmt::format("{}K", plan.memory * static_cast<std::uint64_t>(threads) / 1024),
          "--threads",
          std::to_string(threads),
          "--stats",
          statistics_of(plan),
          "--scratch-folder",
          plan.folder};
}

/// Points of a rank with which a run is little but its start.
constexpr std::uint64_t kFewPoints = 1000;

void add_merges(RankRun& run, const Json& each) {
  std::map<int, MergeLevel> levels;
  for (const Json& rank : each) {
    for (const Json& merge : rank.at("merges")) {
      const auto figure = [&](const char* key) { return merge.at(key).get<double>(); };
      const int number = merge.at("level").get<int>();
      MergeLevel& level = levels[number];
      const double share = 1 / figure("ranks");
      level.level = number;
      level.merges += share;
      level.simplices += figure("border_simplices");
      level.exposed += figure("exposed_simplices");
      level.points += figure("border_points") * share;
      level.inner_merges = std::max(level.inner_merges, figure("inner_merges"));
      level.inner_points = std::max(level.inner_points, figure("inner_border_points"));
      level.sent_bytes += figure("sent_bytes");
      level.calls = std::max(level.calls, figure("calls"));
      const double seconds = figure("processor_seconds");
      const double triangulation = figure("triangulation_seconds");
      level.triangulation_seconds += triangulation;
      level.share_seconds += seconds - triangulation;
      level.longest_share_seconds = std::max(level.longest_share_seconds, seconds - triangulation);
      level.longest_seconds = std::max(level.longest_seconds, seconds);
    }
  }
  std::vector<MergeLevel> all;
  for (auto& [number, level] : levels) {
    level.below = run.points / level.merges;
    for (double* const sum : {&level.simplices, &level.exposed, &level.points, &level.sent_bytes,
                              &level.triangulation_seconds, &level.share_seconds}) {
      *sum /= level.merges;
    }
    if (!run.levels.empty()) {
      const MergeLevel& before = run.levels.at(all.size());
      for (double MergeLevel::*const seconds :
           {&MergeLevel::triangulation_seconds, &MergeLevel::share_seconds,
            &MergeLevel::longest_share_seconds, &MergeLevel::longest_seconds}) {
        level.*seconds = std::min(level.*seconds, before.*seconds);
      }
    }
    all.push_back(level);
  }
  run.levels = std::move(all);
}

}  // namespace

double MergeLevel::per_power(double figure, int dimension) const {
  return figure / std::pow(below, (dimension - 1.0) / dimension);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double sum(const Json& each, const char* key) {
  double value = 0;
  for (const Json& rank : each) value += rank.at(key).get<double>();
  return value;
}

double most(const Json& each, const char* key) {
  double value = 0;
  for (const Json& rank : each) value = std::max(value, rank.at(key).get<double>());
  return value;
}

void generate(const Plan& plan, std::uint64_t points) {
  std::vector<std::string> words{plan.command, "generate",    "-q",
                                 plan.family,  "-n",          std::to_string(points),
                                 "-o",         input_of(plan)};
  if (plan.family != "terrain") {
    words.insert(words.end(), {"--dim", std::to_string(plan.dimension)});
  }
  run_program(words);
}

ProcessFigures run_threads(const Plan& plan, int threads) {
  return run_program(triangulate(plan, threads));
}

ProcessFigures run_ranks(const Plan& plan, int ranks, int threads) {
  std::vector<std::string> words{plan.mpirun,       "-n",        std::to_string(ranks),
                                 "--oversubscribe", "--bind-to", "none"};
  const std::vector<std::string> of_rank = triangulate(plan, threads);
  words.insert(words.end(), of_rank.begin(), of_rank.end());
  return run_program(words);
}

Json statistics(const Plan& plan) { return Json::parse(std::ifstream(statistics_of(plan))); }

RankRun measure(const Plan& plan, int ranks) {
  RankRun run;
  run.ranks = ranks;
  generate(plan, kFewPoints * static_cast<std::uint64_t>(ranks));
  run.start_cpu_seconds = run_ranks(plan, ranks, 1).cpu_seconds;
  run.start_peak_mib = most(statistics(plan).at("ranks").at("each"), "peak_rss_bytes") / kMiB;

  const std::uint64_t points = plan.points_per_rank * static_cast<std::uint64_t>(ranks);
  generate(plan, points);
  run.points = static_cast<double>(points);
  run.exchange_seconds = std::numeric_limits<double>::max();
  std::vector<double> cpu_seconds;
  for (unsigned turn = 0; turn < plan.turns; ++turn) {
    cpu_seconds.push_back(run_ranks(plan, ranks, 1).cpu_seconds - run.start_cpu_seconds);
    const Json each = statistics(plan).at("ranks").at("each");
    double exchange = 0;
    run.waiting_bytes = 0;
    run.peaks_mib.clear();
    for (const Json& rank : each) {
      exchange += rank.at("stages").at("exchange").get<double>();
      run.peaks_mib.push_back(rank.at("peak_rss_bytes").get<double>() / kMiB);
      if (const auto simplices = rank.at("border_simplices").get<double>(); simplices > 0) {
        run.waiting_bytes =
            std::max(run.waiting_bytes, rank.at("border_bytes").get<double>() / simplices);
      }
    }
    run.exchange_seconds = std::min(run.exchange_seconds, exchange);
    run.points_sent = sum(each, "points_sent");
    run.point_bytes_sent = sum(each, "point_bytes_sent");
    run.messages = most(each, "point_messages_sent");
    run.imbalance = most(each, "points") * ranks / sum(each, "points");
    add_merges(run, each);
  }
  run.cpu_seconds = median(cpu_seconds);
  return run;
}

void remove_files(const Plan& plan) {
  for (const std::string& file : {input_of(plan), mesh_of(plan), statistics_of(plan)}) {
    std::filesystem::remove(file);
  }
}

}  // namespace spillway::test
