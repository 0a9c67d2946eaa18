// The whole command, points in a file to a mesh stream in a file, beside CGAL's sequential
// insertion of the same points in memory without any input or output, and beside plain copies of
// the same bytes. Each turn runs all of them. Prints Markdown tables; medians over the turns.

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/generators/generators.h"
#include "tests/benchmark/cgal_timing.h"
#include "tests/benchmark/child_process.h"

namespace spillway::test {
namespace {

struct Plan {
  std::string command = SPILLWAY_COMMAND;
  std::string folder = ".";
  std::string family = "terrain";
  int dimension = 2;
  std::vector<std::uint64_t> points{1'000'000};
  std::vector<std::string> memory{"256M"};
  std::uint64_t reference_points = 0;
  unsigned threads = 2;
  unsigned turns = 3;
  std::vector<std::string> more;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Seconds of a plain copy: reads `bytes` from `from` in pieces of a megabyte (nothing if empty)
/// and writes as many to `to` (nowhere if empty).
double copy(const std::string& from, const std::string& to, std::uint64_t bytes) {
  std::vector<char> piece(1 << 20, 'x');
  const auto start = std::chrono::steady_clock::now();
  std::ifstream in(from, std::ios::binary);
  std::ofstream out(to, std::ios::binary);
  for (std::uint64_t done = 0; done < bytes; done += piece.size()) {
    const auto count =
        static_cast<std::streamsize>(std::min<std::uint64_t>(piece.size(), bytes - done));
    if (!from.empty()) in.read(piece.data(), count);
    if (!to.empty()) out.write(piece.data(), count);
  }
  out.flush();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// CGAL's seconds for a point of the same family.
template <int D>
double time_reference(const Plan& plan, std::uint64_t count) {
  const auto points =
      generated_points<D>({.family = family_by_name(plan.family), .count = count, .dimension = D});
  return time_cgal_sequential<D>(points).seconds / static_cast<double>(points.size());
}

void compare(const Plan& plan, std::uint64_t count, const std::string& memory) {
  const bool terrain = plan.family == "terrain";
  const std::string input = fmt::format("{}/benchmark.{}", plan.folder, terrain ? "las" : "npy");
  const std::string output = plan.folder + "/benchmark.spm";
  const std::string stats = plan.folder + "/benchmark.json";
  const std::string scratch = plan.folder + "/benchmark.copy";
  std::vector<std::string> generate = {plan.command,          "generate", "-q", plan.family, "-n",
                                       std::to_string(count), "-o",       input};
  if (!terrain) {  // which always has z
    generate.insert(generate.end(), {"--dim", std::to_string(plan.dimension)});
  }
  run_program(generate);
  std::vector<double> reference;
  std::vector<double> ours;
  std::vector<double> disk;
  double peak = 0;
  double cpu = 0;
  nlohmann::json last;
  for (unsigned turn = 0; turn < plan.turns; ++turn) {
    const std::uint64_t reference_count = plan.reference_points > 0 ? plan.reference_points : count;
    reference.push_back(plan.dimension == 2 ? time_reference<2>(plan, reference_count)
                                            : time_reference<3>(plan, reference_count));
    std::vector<std::string> words = {plan.command,
                                      "triangulate",
                                      "-q",
                                      input,
                                      "-o",
                                      output,
                                      "--dim",
                                      std::to_string(plan.dimension),
                                      "--memory",
                                      memory,
                                      "--threads",
                                      std::to_string(plan.threads),
                                      "--stats",
                                      stats,
                                      "--scratch-folder",
                                      plan.folder};
    words.insert(words.end(), plan.more.begin(), plan.more.end());
    const ProcessFigures statistics = run_program(words);
    ours.push_back(statistics.seconds / static_cast<double>(count));
    peak = std::max(peak, statistics.peak_mib);
    cpu = statistics.cpu_seconds;
    last = nlohmann::json::parse(std::ifstream(stats));
    const auto spilled = last["spilled_bytes"].get<std::uint64_t>();
    disk.push_back((copy(input, "", std::filesystem::file_size(input)) +
                    copy("", scratch, spilled) + copy(scratch, "", spilled) +
                    copy("", scratch, std::filesystem::file_size(output))) /
                   static_cast<double>(count));
  }
  const double n = static_cast<double>(count);
  fmt::print(
      "| {}D {} | {} | {} | {:.3f} | {:.3f} | **{:.2f}** | {:.3f} | {:.0f} | {} | {:.2f} | "
      "{:.1f} | {:.1f} | {} | {:.4f} | {:.3f} | {:.1f} |\n",
      plan.dimension, plan.family, count, memory, 1e6 * median(reference), 1e6 * median(ours),
      median(ours) / median(reference), 1e6 * cpu / n, peak, last["tiles"].get<int>(),
      last["spilled_points"].get<double>() / n, last["spilled_bytes"].get<double>() / n,
      last["output_bytes"].get<double>() / n, last["border_simplices"].get<std::uint64_t>(),
      last["border_simplices"].get<double>() / last["simplices"].get<double>(), 1e6 * median(disk),
      median(ours) / median(disk));
  fmt::print("|   ns of thread time a point:");
  for (const auto& [stage, seconds] : last["stages"].items()) {
    fmt::print(" {} {:.0f},", stage, 1e9 * seconds.get<double>() / n);
  }
  fmt::print(" wall time of phases:");
  for (const auto& [phase, seconds] : last["phases"].items()) {
    fmt::print(" {} {:.0f}", phase, 1e9 * seconds.get<double>() / n);
  }
  fmt::print(" |\n");
  std::fflush(stdout);
  for (const std::string& file : {input, output, stats, scratch}) std::filesystem::remove(file);
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Times the whole command beside CGAL's insertion in memory and plain copies");
  app.add_option("--command", plan.command, "The spillway to run");
  app.add_option("--folder", plan.folder, "Where input, output and scratch files lie");
  app.add_option("--family", plan.family, "Family of points");
  app.add_option("--dim", plan.dimension, "Dimension");
  app.add_option("-n,--points", plan.points, "Points of each run")->delimiter(',');
  app.add_option("-m,--memory", plan.memory, "--memory of each run; the last one serves all others")
      ->delimiter(',');
  app.add_option("--reference-points", plan.reference_points,
                 "Points that CGAL gets, its time being scaled; 0: all");
  app.add_option("--threads", plan.threads, "Threads");
  app.add_option("-r,--turns", plan.turns, "Turns");
  app.add_option("--more", plan.more, "More options for the command")->delimiter(' ');
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| points | n | --memory | CGAL us/pt | ours us/pt | ours / CGAL | cpu us/pt | peak MiB | "
      "tiles | writes/pt | spill B/pt | mesh B/pt | border | of simplices | copies us/pt | ours / "
      "copies |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    spillway::test::compare(plan, plan.points[i], plan.memory[std::min(i, plan.memory.size() - 1)]);
  }
}
