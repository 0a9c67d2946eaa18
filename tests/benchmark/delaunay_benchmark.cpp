// Side by side in one process, in turns: CGAL's Delaunay triangulations and ours, on the five
// distributions of the paper. Prints one Markdown table; medians over the repetitions.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "src/delaunay/schedule.h"
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
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <int D>
Timing time_ours(std::span<const Point<D>> points, const DelaunayOptions& options) {
  Timing timing{};
  Triangulation<D> triangulation;
  {
    const Stopwatch watch(timing.seconds);
    triangulation = delaunay<D>(points, options);
  }
  timing.simplices = triangulation.finite_count();
  return timing;
}

template <int D>
void compare(const std::string& family, const Plan& plan) {
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
    const Timing reference = time_cgal_sequential<D>(points);
    cgal.push_back(reference.seconds);
    if constexpr (D == 3) {
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
  CLI11_PARSE(app, argc, argv);
  const unsigned t = plan.threads;
  fmt::print(
      "| points | n | simplices | CGAL s | CGAL parallel, {} threads s | ours, 1 thread s | "
      "ours, {} threads s | us a point | speed-up | ours / CGAL | ours / CGAL parallel |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      t, t);
  for (const int dimension : plan.dimensions) {
    for (const std::string& family : plan.families) {
      if (dimension == 2) {
        spillway::compare<2>(family, plan);
      } else {
        spillway::compare<3>(family, plan);
      }
    }
  }
}
