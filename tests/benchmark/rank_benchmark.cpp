// The command under mpirun, in tables: ranks of one thread beside one process of as many threads;
// what grows with the number of ranks when each has as many points (weak scaling), level by level,
// and what a model makes of that for more ranks than there are here; and ranks against threads
// where their product stays.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tests/benchmark/rank_model.h"
#include "tests/benchmark/rank_runs.h"

namespace {

using namespace spillway::test;
using Json = nlohmann::json;

void compare_with_threads(const Plan& plan) {
  generate(plan, plan.points);
  std::vector<double> threads;
  std::vector<double> ranks;
  std::vector<double> ratios;
  double threads_peak = 0;
  Json last;
  for (unsigned turn = 0; turn < plan.turns; ++turn) {
    threads.push_back(run_threads(plan, 2).seconds);
    threads_peak =
        std::max(threads_peak, statistics(plan).at("peak_rss_bytes").get<double>() / kMiB);
    ranks.push_back(run_ranks(plan, 2, 1).seconds);
    ratios.push_back(ranks.back() / threads.back());
    last = statistics(plan).at("ranks");
  }
  fmt::print("| {} points | seconds | peak MiB of a process |\n|---|---|---|\n", plan.points);
  fmt::print("| 1 process, 2 threads | {:.2f} | {:.0f} |\n", median(threads), threads_peak);
  fmt::print("| 2 ranks, 1 thread each | {:.2f} | {:.0f} |\n", median(ranks),
             most(last.at("each"), "peak_rss_bytes") / kMiB);
  fmt::print("\nRatio {:.3f}. Bytes sent per point {:.2f}, per border simplex {:.1f}.\n\n",
             median(ratios), last.at("point_bytes_sent_per_point").get<double>(),
             last.at("border_bytes_sent_per_border_simplex").get<double>());
}

void print_merges(const Plan& plan, const std::vector<RankRun>& runs) {
  const char* const power = plan.dimension == 2 ? "N^(1/2)" : "N^(2/3)";
  fmt::print(
      "| ranks | level | merges | border simplices of a merge | exposed | per {} | points | per {} "
      "| inner merges | their points | bytes sent | ms of all ranks | ms of the longest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      power, power);
  for (const RankRun& run : runs) {
    for (const MergeLevel& level : run.levels) {
      fmt::print(
          "| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {:.0f} | {:.2f} | {:.0f} | {:.0f} | "
          "{:.0f} | {:.2f} | {:.2f} |\n",
          run.ranks, level.level, level.merges, level.simplices, level.exposed,
          level.per_power(level.exposed, plan.dimension), level.points,
          level.per_power(level.points, plan.dimension), level.inner_merges, level.inner_points,
          level.sent_bytes, 1e3 * (level.triangulation_seconds + level.share_seconds),
          1e3 * level.longest_seconds);
    }
  }
}

void print_runs(const std::vector<RankRun>& runs) {
  fmt::print(
      "\n| ranks | bytes sent for a point | points that move | processor time of a point, us | "
      "peak MiB of each rank |\n|---|---|---|---|---|\n");
  for (const RankRun& run : runs) {
    std::string peaks;
    for (const double peak : run.peaks_mib) {
      peaks += fmt::format("{}{:.0f}", peaks.empty() ? "" : ", ", peak);
    }
    fmt::print("| {} | {:.2f} | {:.0f} % | {:.3f} | {} |\n", run.ranks,
               run.point_bytes_sent / run.points, 100 * run.points_sent / run.points,
               1e6 * run.cpu_seconds / run.points, peaks);
  }
}

/// Ranks times threads at a constant product, each thread with as many points and as much memory.
void sweep(const Plan& plan) {
  fmt::print(
      "\n| ranks x threads | points | processor time of all, s | seconds | peak MiB of all ranks "
      "|\n|---|---|---|---|---|\n");
  for (const int product : plan.sweep) {
    const std::uint64_t points = plan.points_per_rank * static_cast<std::uint64_t>(product);
    generate(plan, points);
    for (int ranks = product; ranks >= 1; ranks /= 2) {
      std::vector<double> cpu_seconds;
      std::vector<double> seconds;
      double peak = 0;
      for (unsigned turn = 0; turn < plan.turns; ++turn) {
        const ProcessFigures used = run_ranks(plan, ranks, product / ranks);
        cpu_seconds.push_back(used.cpu_seconds);
        seconds.push_back(used.seconds);
        peak = std::max(peak, sum(statistics(plan).at("ranks").at("each"), "peak_rss_bytes"));
      }
      fmt::print("| {} x {} | {} | {:.2f} | {:.2f} | {:.0f} |\n", ranks, product / ranks, points,
                 median(cpu_seconds), median(seconds), peak / kMiB);
      std::fflush(stdout);
    }
  }
}

/// What is wrong with the numbers of ranks, or empty.
std::string fault_of(const Plan& plan) {
  const std::vector<int>& ranks = plan.ranks;
  const bool rises =
      std::adjacent_find(ranks.begin(), ranks.end(), std::greater_equal<>()) == ranks.end();
  if (ranks.size() < 2 || ranks.front() != 1 || !rises) {
    return "--ranks: the model needs one rank first and then rising numbers, as in 1,2,4,8";
  }
  for (const int product : plan.sweep) {
    if (product < 1 || !std::has_single_bit(static_cast<unsigned>(product))) {
      return fmt::format("--sweep: {} is no power of two; choose some, as in 2,8", product);
    }
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  Plan plan;
  Network network;
  bool only_scaling = false;
  CLI::App app("Measures the command under mpirun, and a model for more ranks");
  app.add_option("--command", plan.command, "The spillway to run");
  app.add_option("--folder", plan.folder, "Where input, output and scratch files lie");
  app.add_option("--family", plan.family, "Family of points");
  app.add_option("--dim", plan.dimension, "Dimension")->check(CLI::IsMember({2, 3}));
  app.add_option("-n,--points", plan.points, "Points of the comparison with threads");
  app.add_option("--points-per-rank", plan.points_per_rank,
                 "Points of a rank in weak scaling, and of a rank's thread in the sweep");
  app.add_option("--ranks", plan.ranks, "Numbers of ranks in weak scaling")->delimiter(',');
  app.add_option("--sweep", plan.sweep, "Products of ranks and threads, powers of two")
      ->delimiter(',');
  app.add_option("-m,--memory", plan.memory, "--memory of a process of one thread")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("-r,--turns", plan.turns, "Turns of all measurements")->check(CLI::PositiveNumber);
  app.add_option("--network", network.bytes_per_second, "The model's bytes a second of a rank");
  app.add_option("--latency", network.latency, "The model's seconds a message");
  app.add_flag("--only-scaling", only_scaling, "Leave out the comparison with threads");
  CLI11_PARSE(app, argc, argv);
  if (const std::string fault = fault_of(plan); !fault.empty()) {
    fmt::print(stderr, "{}\n", fault);
    return 2;
  }
  for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"}) {
    ::setenv(name, "1", 1);
  }
  if (!only_scaling) compare_with_threads(plan);
  std::vector<RankRun> runs;
  for (const int ranks : plan.ranks) runs.push_back(measure(plan, ranks));
  print_merges(plan, runs);
  print_runs(runs);
  print_model(plan, runs, network);
  if (!plan.sweep.empty()) sweep(plan);
  remove_files(plan);
}
