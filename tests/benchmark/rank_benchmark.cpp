// The command under mpirun. Three tables: ranks of one thread beside one process of as many
// threads; what grows with the number of ranks when each has as many points (weak scaling), level
// by level; and what a model makes of that for more ranks than there are here.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using Json = nlohmann::json;

struct Plan {
  std::string command = SPILLWAY_COMMAND;
  std::string mpirun = SPILLWAY_MPIRUN;
  std::string folder = ".";
  std::string family = "terrain";
  std::uint64_t points = 20'000'000;        ///< of the comparison with threads
  std::uint64_t points_per_rank = 500'000;  ///< of weak scaling
  std::vector<int> ranks{1, 2, 4, 8};
  std::string memory = "512M";
  unsigned turns = 3;
  double point_seconds = 0;  ///< of the model; 0: as measured with one rank
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Runs a command line in a shell and returns its seconds; ends this program if it fails.
double run(const std::string& line) {
  const auto start = std::chrono::steady_clock::now();
  if (std::system(line.c_str()) != 0) {
    fmt::print(stderr, "{} failed\n", line);
    std::exit(1);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string input_of(const Plan& plan) { return plan.folder + "/benchmark.las"; }
std::string stats_of(const Plan& plan) { return plan.folder + "/benchmark.json"; }

std::string triangulate(const Plan& plan, unsigned threads) {
  return fmt::format(
      "{} triangulate -q {} -o {}/benchmark.spm --memory {} --threads {} --stats {} "
      "--tmpdir {}",
      plan.command, input_of(plan), plan.folder, plan.memory, threads, stats_of(plan), plan.folder);
}

std::string over_ranks(const Plan& plan, int ranks) {
  return fmt::format(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 {} -n {} --oversubscribe "
      "--bind-to none {}",
      plan.mpirun, ranks, triangulate(plan, 1));
}

void generate(const Plan& plan, std::uint64_t points) {
  run(fmt::format("{} generate -q {} -n {} -o {}", plan.command, plan.family, points,
                  input_of(plan)));
}

Json stats(const Plan& plan) { return Json::parse(std::ifstream(stats_of(plan))); }

double most(const Json& each, const char* key) {
  double value = 0;
  for (const Json& rank : each) value = std::max(value, rank.at(key).get<double>());
  return value;
}

double sum(const Json& each, const char* key) {
  double value = 0;
  for (const Json& rank : each) value += rank.at(key).get<double>();
  return value;
}

constexpr double kMiB = 1024.0 * 1024.0;

void compare_with_threads(const Plan& plan) {
  generate(plan, plan.points);
  std::vector<double> threads;
  std::vector<double> ranks;
  std::vector<double> ratios;
  double threads_peak = 0;
  Json last;
  for (unsigned turn = 0; turn < plan.turns; ++turn) {
    threads.push_back(run(triangulate(plan, 2)));
    threads_peak = std::max(threads_peak, stats(plan).at("peak_rss_bytes").get<double>() / kMiB);
    ranks.push_back(run(over_ranks(plan, 2)));
    ratios.push_back(ranks.back() / threads.back());
    last = stats(plan).at("ranks");
  }
  fmt::print("| {} points | seconds | peak MiB of a process |\n|---|---|---|\n", plan.points);
  fmt::print("| 1 process, 2 threads | {:.2f} | {:.0f} |\n", median(threads), threads_peak);
  fmt::print("| 2 ranks, 1 thread each | {:.2f} | {:.0f} |\n", median(ranks),
             most(last.at("each"), "peak_rss_bytes") / kMiB);
  fmt::print("\nRatio {:.3f}. Bytes sent per point {:.2f}, per border simplex {:.1f}.\n\n",
             median(ratios), last.at("point_bytes_sent_per_point").get<double>(),
             last.at("border_bytes_sent_per_border_simplex").get<double>());
}

/// What one number of ranks showed.
struct Measured {
  int ranks = 0;
  double points_per_rank = 0;
  double cpu_per_point = 0;  ///< seconds of all stages and ranks
  /// Simplices that a merge gets, per root of the points below it; the root's first.
  std::vector<double> border_per_root;
  double bytes_per_simplex = 0;  ///< of a border message
  double merge_per_simplex = 0;  ///< seconds
  double peak_mib = 0;
};

Measured measure(const Plan& plan, int ranks) {
  const std::uint64_t points = plan.points_per_rank * static_cast<std::uint64_t>(ranks);
  generate(plan, points);
  run(over_ranks(plan, ranks));
  const Json all = stats(plan).at("ranks");
  const Json& each = all.at("each");
  Measured result;
  result.ranks = ranks;
  result.points_per_rank = static_cast<double>(plan.points_per_rank);
  for (const Json& rank : each) {
    for (const auto& [stage, seconds] : rank.at("stages").items()) {
      if (stage != "exchange") result.cpu_per_point += seconds.get<double>();
    }
  }
  result.cpu_per_point /= static_cast<double>(points);
  result.peak_mib = most(each, "peak_rss_bytes") / kMiB;
  struct Level {
    int merges = 0;
    double simplices = 0;
    double bytes = 0;
    double seconds = 0;
    double retriangulated = 0;
  };
  std::map<int, Level> levels;
  for (const Json& rank : each) {
    for (const Json& merge : rank.at("merges")) {
      Level& level = levels[merge.at("level").get<int>()];
      ++level.merges;
      level.simplices += merge.at("border_simplices").get<double>();
      level.bytes += merge.at("received_bytes").get<double>();
      level.seconds += merge.at("seconds").get<double>();
      level.retriangulated += merge.at("retriangulated_points").get<double>();
    }
  }
  double simplices = 0;
  double seconds = 0;
  for (const auto& [number, level] : levels) {
    const double below = static_cast<double>(points) / level.merges;
    fmt::print("| {} | {} | {} | {:.0f} | {:.2f} | {:.0f} | {:.0f} | {:.2f} |\n", ranks, number,
               level.merges, level.simplices / level.merges,
               level.simplices / level.merges / std::sqrt(below), level.bytes / level.merges,
               level.retriangulated / level.merges, 1e3 * level.seconds / level.merges);
    simplices += level.simplices;
    seconds += level.seconds;
    result.border_per_root.insert(result.border_per_root.begin(),
                                  level.simplices / level.merges / std::sqrt(below));
  }
  if (simplices > 0) {
    result.merge_per_simplex = seconds / simplices;
    result.bytes_per_simplex = all.at("border_bytes_sent_per_border_simplex").get<double>();
  }
  fmt::print(
      "| {} | all | | | | {:.2f} B a point sent, {:.0f} % of points | peak {:.0f} MiB | {:.0f} "
      "ns of CPU a point |\n",
      ranks, sum(each, "point_bytes_sent") / static_cast<double>(points),
      100 * all.at("points_sent_share").get<double>(), result.peak_mib, 1e9 * result.cpu_per_point);
  std::fflush(stdout);
  return result;
}

/// Time and memory of P ranks with n points each: docs/performance.md derives it.
void extrapolate(const Plan& plan, const Measured& alone, const Measured& many) {
  const double point_seconds = plan.point_seconds > 0 ? plan.point_seconds : alone.cpu_per_point;
  constexpr double kNetwork = 1e9;      // bytes a second of a rank
  constexpr double kLatency = 5e-6;     // seconds a message
  constexpr double kPointBytes = 4;     // of a point that moves
  constexpr double kBorderBytes = 100;  // of a border simplex in memory, with its vertices
  constexpr double kMergeBytes = 300;   // of each point of a border's triangulation
  fmt::print(
      "\n| points per rank | ranks | tiles s | exchange s | merges s | total s | efficiency | "
      "speed-up | most for a border, MiB |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double n : {1e6, 1e8}) {
    for (int p = 2; p <= 2048; p *= 4) {
      const double ranks = p;
      const double tiles = n * point_seconds;
      const double rounds = std::ceil(n / (4 * 65'536));
      const double exchange =
          n * (ranks - 1) / ranks * kPointBytes / kNetwork + rounds * ranks * kLatency;
      double merges = 0;
      double most_border = 0;
      std::size_t depth = 0;
      for (double below = ranks; below >= 2; below /= 2, ++depth) {
        const std::size_t known = std::min(depth, many.border_per_root.size() - 1);
        const double border = many.border_per_root[known] * std::sqrt(below * n);
        most_border = std::max(most_border, border);
        merges += border * many.merge_per_simplex + border / 2 * many.bytes_per_simplex / kNetwork +
                  kLatency;
      }
      const double total = tiles + exchange + merges;
      fmt::print("| {:.0e} | {} | {:.2f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.0f} | {:.1f} |\n",
                 n, p, tiles, exchange, merges, total, tiles / total, ranks * tiles / total,
                 most_border * (kBorderBytes + kMergeBytes / 2) / kMiB);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Plan plan;
  bool only_scaling = false;
  CLI::App app("Measures the command under mpirun, and a model for more ranks");
  app.add_option("--command", plan.command, "The spillway to run");
  app.add_option("--folder", plan.folder, "Where input, output and scratch files lie");
  app.add_option("--family", plan.family, "Family of points in the plane");
  app.add_option("-n,--points", plan.points, "Points of the comparison with threads");
  app.add_option("--points-per-rank", plan.points_per_rank, "Points of a rank in weak scaling");
  app.add_option("--ranks", plan.ranks, "Numbers of ranks in weak scaling")->delimiter(',');
  app.add_option("-m,--memory", plan.memory, "--memory of a process");
  app.add_option("-r,--turns", plan.turns, "Turns of the comparison");
  app.add_option("--point-seconds", plan.point_seconds,
                 "The model's seconds of one core for a point; 0: as measured with one rank");
  app.add_flag("--only-scaling", only_scaling, "Leave out the comparison with threads");
  CLI11_PARSE(app, argc, argv);
  if (!only_scaling) compare_with_threads(plan);
  fmt::print(
      "| ranks | level | merges | border simplices | per root of the points below | bytes "
      "received | retriangulated | ms |\n|---|---|---|---|---|---|---|---|\n");
  std::vector<Measured> measured;
  for (const int ranks : plan.ranks) measured.push_back(measure(plan, ranks));
  extrapolate(plan, measured.front(), measured.back());
  for (const char* name : {"/benchmark.las", "/benchmark.spm", "/benchmark.json"}) {
    std::filesystem::remove(plan.folder + name);
  }
}
