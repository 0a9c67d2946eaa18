// Side by side in one process, in turns: CGAL's Delaunay triangulations and ours, on the five
// distributions of the paper, medians over the repetitions; then how ours would do on more cores.
// Prints two Markdown tables.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "src/delaunay/schedule.h"
#include "src/delaunay/working_memory.h"
#include "src/generators/generators.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway {
namespace {

struct Plan {
  std::vector<std::string> families{"uniform", "normal", "bubbles", "ellipsoid", "lines"};
  std::vector<int> dimensions{2, 3};
  std::uint64_t points = 1'000'000;
  std::uint64_t points_on_lines_3d = 3'000;
  unsigned repetitions = 3;
  unsigned threads = 2;
  std::size_t base_case_size = 0;
  unsigned children = 2;
  std::vector<std::size_t> simulated_base_cases{262'144, 65'536, 16'384, 4'096};
  unsigned simulated_cores = 1'024;
};

/// Takes memory from the system and gives it back. On a virtual machine, memory that nobody has
/// used for some seconds may be the host's again; fetching it would go into one time or another.
void touch_memory() {
  constexpr std::size_t kBytes = std::size_t{1} << 30;
  constexpr std::size_t kPage = 4096;
  struct Free {
    void operator()(char* memory) const { std::free(memory); }
  };
  const std::unique_ptr<char, Free> memory(static_cast<char*>(std::aligned_alloc(kPage, kBytes)));
  ask_for_huge_pages(memory.get(), kBytes);
  for (std::size_t i = 0; i < kBytes; i += kPage) static_cast<volatile char*>(memory.get())[i] = 1;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <int D>
Timing time_ours(std::span<const Point<D>> points, const DelaunayOptions& options) {
  touch_memory();
  Timing timing{};
  Triangulation<D> triangulation;
  {
    const Stopwatch watch(timing.seconds);
    triangulation = delaunay<D>(points, options);
  }
  timing.simplices = triangulation.finite_count();
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
    time_ours<D>(points, {.threads = 1,
                          .base_case_size = plan.simulated_base_cases[r],
                          .children = plan.children,
                          .tasks = &runs[r]});
  }
  std::string row = fmt::format("| {}D {} |", D, family);
  for (unsigned cores = 1; cores <= plan.simulated_cores; cores *= 2) {
    std::vector<double> seconds;
    for (const Task& run : runs) seconds.push_back(greedy_makespan(run, cores));
    const auto best = std::min_element(seconds.begin(), seconds.end());
    row += fmt::format(" {:.1f} ({}) |", cgal_seconds / *best,
                       plan.simulated_base_cases[best - seconds.begin()] / 1024);
  }
  return row + "\n";
}

template <int D>
std::string compare(const std::string& family, const Plan& plan) {
  const bool quadratic = D == 3 && family == "lines";
  const GeneratorOptions generate{.family = family_by_name(family),
                                  .count = quadratic ? plan.points_on_lines_3d : plan.points,
                                  .dimension = D};
  const std::vector<Point<D>> points = generate_points<D>(generate);
  std::vector<double> cgal;
  std::vector<double> cgal_parallel;
  std::vector<double> ours_one;
  std::vector<double> ours;
  Timing last{};
  for (unsigned r = 0; r < plan.repetitions; ++r) {
    touch_memory();
    const Timing reference = time_cgal_sequential<D>(points);
    cgal.push_back(reference.seconds);
    if constexpr (D == 3) {
      touch_memory();
      cgal_parallel.push_back(time_cgal_parallel(points, plan.threads).seconds);
    }
    DelaunayOptions options{
        .threads = 1, .base_case_size = plan.base_case_size, .children = plan.children};
    ours_one.push_back(time_ours<D>(points, options).seconds);
    options.threads = plan.threads;
    last = time_ours<D>(points, options);
    ours.push_back(last.seconds);
    if (last.simplices != reference.simplices) {
      fmt::print("DIFFERENT COUNTS: {} and {}\n", last.simplices, reference.simplices);
    }
  }
  const double n = static_cast<double>(points.size()) * 1e-6;
  fmt::print(
      "| {}D {} | {} | {} | {:.3f} | {} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | **{:.2f}** | {} |\n",
      D, family, points.size(), last.simplices, median(cgal),
      D == 3 ? fmt::format("{:.3f}", median(cgal_parallel)) : "-", median(ours_one), median(ours),
      median(ours) / n, median(ours_one) / median(ours), median(ours) / median(cgal),
      D == 3 ? fmt::format("{:.2f}", median(ours) / median(cgal_parallel)) : "-");
  std::fflush(stdout);
  if (plan.simulated_base_cases.empty()) return {};
  return simulate<D>(family, points, median(cgal), plan);
}

}  // namespace
}  // namespace spillway

int main(int argc, char** argv) {
  spillway::Plan plan;
  CLI::App app("Times CGAL's Delaunay triangulations and ours in turns");
  app.add_option("--families", plan.families, "Families of points")->delimiter(',');
  app.add_option("--dims", plan.dimensions, "Dimensions")->delimiter(',');
  app.add_option("-n,--points", plan.points, "Points of each set");
  app.add_option("--points-on-lines-3d", plan.points_on_lines_3d, "Points of lines in 3D");
  app.add_option("-r,--repetitions", plan.repetitions, "Turns; medians are printed");
  app.add_option("--threads", plan.threads, "Threads of the parallel runs");
  app.add_option("--base-case", plan.base_case_size, "Largest base case, 0: default");
  app.add_option("--children", plan.children, "Parts merged at a time");
  app.add_option("--simulate", plan.simulated_base_cases,
                 "Sizes of base cases to simulate more cores with; one of 0 to leave it")
      ->delimiter(',');
  app.add_option("--simulated-cores", plan.simulated_cores, "Most cores to simulate");
  CLI11_PARSE(app, argc, argv);
  if (plan.simulated_base_cases == std::vector<std::size_t>{0}) plan.simulated_base_cases.clear();
  const unsigned t = plan.threads;
  fmt::print(
      "| points | n | simplices | CGAL s | CGAL parallel, {} threads s | ours, 1 thread s | "
      "ours, {} threads s | us a point | speed-up | ours / CGAL | ours / CGAL parallel |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      t, t);
  std::string simulated;
  for (const int dimension : plan.dimensions) {
    for (const std::string& family : plan.families) {
      simulated +=
          dimension == 2 ? spillway::compare<2>(family, plan) : spillway::compare<3>(family, plan);
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
