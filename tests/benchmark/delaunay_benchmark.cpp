// Side by side in one process, in turns: CGAL's Delaunay triangulations and ours, on the five
// distributions of the paper, medians over the repetitions; then how ours would do on more cores.
// Prints two Markdown tables.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/delaunay.h"
#include "src/generators/generators.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway::test {
namespace {

struct Plan {
  std::vector<std::string> families{"uniform", "normal", "bubbles", "ellipsoid", "lines"};
  std::vector<int> dimensions{2, 3};
  std::uint64_t points = 1'000'000;
  std::uint64_t points_on_lines_3d = 3'000;
  unsigned repetitions = 3;
  unsigned threads = 2;
  std::size_t leaf_points = 0;
  unsigned children = 2;
  std::vector<std::size_t> simulated_base_cases{262'144, 65'536, 16'384, 4'096};
  unsigned simulated_cores = 1'024;
  std::size_t touched = 4;
};

/// Takes so many GiB from the system and gives them back. On a virtual machine, memory that nobody
/// has used for some seconds may be the host's again (Linux, free page reporting, which begins two
/// seconds after memory became free): fetching it would go into one time or another. Waits for that
/// first, or it would fall into the next run.
void touch_memory(std::size_t gibibytes) {
  if (gibibytes == 0) return;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  const std::size_t bytes = gibibytes << 30;
  constexpr std::size_t kPage = 4096;
  struct Free {
    void operator()(char* memory) const { std::free(memory); }
  };
  const std::unique_ptr<char, Free> memory(static_cast<char*>(std::aligned_alloc(kPage, bytes)));
  if (memory == nullptr) throw std::bad_alloc();
  ask_for_huge_pages(memory.get(), bytes);
  for (std::size_t i = 0; i < bytes; i += kPage) static_cast<volatile char*>(memory.get())[i] = 1;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Leaves no memory of earlier runs with the process.
void give_back_memory(const Plan& plan) {
  release_base_case_memory();
  malloc_trim(0);
  touch_memory(plan.touched);
}

/// Leaves its memory to the next run.
template <int D>
Timing time_ours(std::span<const Point<D>> points, const DivideAndConquerOptions& options) {
  Timing timing{};
  Triangulation<D> triangulation;
  {
    const Stopwatch watch(timing.seconds);
    triangulation = delaunay_triangulation<D>(points, options);
  }
  timing.simplices = triangulation.finite_count();
  recycle(std::move(triangulation));
  return timing;
}

/// A row of the second table, to be printed after the first: how many times faster than CGAL's
/// sequential time the tasks of one thread would be on 1, 2, 4, ... cores, with the best of some
/// sizes of base cases for each.
template <int D>
std::string simulate(const std::string& family, std::span<const Point<D>> points,
                     double cgal_seconds, const Plan& plan) {
  std::vector<Task> runs(plan.simulated_base_cases.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    give_back_memory(plan);
    time_ours<D>(points, {.threads = 1,
                          .leaf_points = plan.simulated_base_cases[r],
                          .children = plan.children,
                          .tasks = &runs[r]});
  }
  std::string row = fmt::format("| {}D {} |", D, family);
  for (unsigned cores = 1; cores <= plan.simulated_cores; cores *= 2) {
    std::vector<double> seconds;
    seconds.reserve(runs.size());
    for (const Task& run : runs) seconds.push_back(greedy_makespan(run, cores));
    const auto best = std::min_element(seconds.begin(), seconds.end());
    row += fmt::format(" {:.1f} ({}) |", cgal_seconds / *best,
                       plan.simulated_base_cases[best - seconds.begin()] / 1024);
  }
  return row + "\n";
}

/// Of all turns, with memory from the system or left by a run of the same program just before.
struct Times {
  std::vector<double> cgal, cgal_parallel, ours_one, ours;
};

/// One turn. Returns the number of simplices.
template <int D>
std::size_t take_turn(std::span<const Point<D>> points, const Plan& plan, Times& fresh,
                      Times& reused) {
  std::size_t simplices = 0;
  const auto run = [&](std::vector<double> Times::*times, const auto& time) {
    give_back_memory(plan);
    for (Times* memory : {&fresh, &reused}) {
      const Timing timing = time();
      if (simplices != 0 && timing.simplices != simplices) {
        fmt::print("DIFFERENT COUNTS: {} and {}\n", timing.simplices, simplices);
      }
      simplices = timing.simplices;
      (memory->*times).push_back(timing.seconds);
    }
  };
  const auto ours = [&](unsigned threads) {
    return time_ours<D>(
        points, {.threads = threads, .leaf_points = plan.leaf_points, .children = plan.children});
  };
  run(&Times::cgal, [&] { return time_cgal_sequential<D>(points); });
  if constexpr (D == 3) {
    run(&Times::cgal_parallel, [&] { return time_cgal_parallel(points, plan.threads); });
  }
  run(&Times::ours_one, [&] { return ours(1); });
  run(&Times::ours, [&] { return ours(plan.threads); });
  return simplices;
}

template <int D>
std::string compare(const std::string& family, const Plan& plan) {
  const bool quadratic = D == 3 && family == "lines";
  const GeneratorOptions generate{.family = family_by_name(family),
                                  .count = quadratic ? plan.points_on_lines_3d : plan.points,
                                  .dimension = D};
  const std::vector<Point<D>> points = generated_points<D>(generate);
  const double n = static_cast<double>(points.size()) * 1e-6;
  Times fresh, reused;
  std::size_t simplices = 0;
  for (unsigned r = 0; r < plan.repetitions; ++r) {
    simplices = take_turn<D>(points, plan, fresh, reused);
  }
  const auto print_row = [&](const char* memory, const Times& times) {
    const double ours = median(times.ours);
    fmt::print(
        "| {}D {} | {} | {} | {} | {:.3f} | {} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | **{:.3f}** | "
        "{} |\n",
        D, family, memory, points.size(), simplices, median(times.cgal),
        D == 3 ? fmt::format("{:.3f}", median(times.cgal_parallel)) : "-", median(times.ours_one),
        ours, ours / n, median(times.ours_one) / ours, ours / median(times.cgal),
        D == 3 ? fmt::format("{:.2f}", ours / median(times.cgal_parallel)) : "-");
    std::fflush(stdout);
  };
  print_row("fresh", fresh);
  print_row("reused", reused);
  if (plan.simulated_base_cases.empty()) return {};
  return simulate<D>(family, points, median(fresh.cgal), plan);
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Times CGAL's Delaunay triangulations and ours in turns");
  app.add_option("--families", plan.families, "Families of points")->delimiter(',');
  app.add_option("--dims", plan.dimensions, "Dimensions")->delimiter(',');
  app.add_option("-n,--points", plan.points, "Points of each set");
  app.add_option("--points-on-lines-3d", plan.points_on_lines_3d, "Points of lines in 3D");
  app.add_option("-r,--repetitions", plan.repetitions, "Turns; medians are printed");
  app.add_option("--threads", plan.threads, "Threads of the parallel runs");
  app.add_option("--leaf-points", plan.leaf_points, "Largest base case, 0: default");
  app.add_option("--children", plan.children, "Parts merged at a time");
  app.add_option("--simulate", plan.simulated_base_cases,
                 "Sizes of base cases to simulate more cores with; one of 0 to leave it")
      ->delimiter(',');
  app.add_option("--simulated-cores", plan.simulated_cores, "Most cores to simulate");
  app.add_option("--touch", plan.touched,
                 "GiB to touch before each pair of runs, after some seconds; 0: neither");
  CLI11_PARSE(app, argc, argv);
  // What is freed stays with the process until give_back_memory().
  constexpr int kLargestThreshold = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargestThreshold);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  if (plan.simulated_base_cases == std::vector<std::size_t>{0}) plan.simulated_base_cases.clear();
  const unsigned t = plan.threads;
  fmt::print(
      "| points | memory | n | simplices | CGAL s | CGAL parallel, {} threads s | ours, 1 thread s "
      "| "
      "ours, {} threads s | us a point | speed-up | ours / CGAL | ours / CGAL parallel |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      t, t);
  std::string simulated;
  for (const int dimension : plan.dimensions) {
    for (const std::string& family : plan.families) {
      simulated += dimension == 2 ? spillway::test::compare<2>(family, plan)
                                  : spillway::test::compare<3>(family, plan);
    }
  }
  if (plan.simulated_base_cases.empty()) return 0;
  std::string head = "\n| cores |";
  std::string line = "|---|";
  for (unsigned cores = 1; cores <= plan.simulated_cores; cores *= 2) {
    head += fmt::format(" {} |", cores);
    line += "---|";
  }
  fmt::print("{}\n{}\n{}", head, line, simulated);
}
