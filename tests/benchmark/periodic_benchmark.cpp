// Triangulations of uniform points in a periodic cube, beside those of CGAL and beside our own of the
// same points without a period. Prints seconds of processor time of one thread, medians over the
// turns, and ratios.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_3.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_traits_3.h>
#include <fmt/format.h>
#include <spillway/delaunay.h>
#include <spillway/triangulate.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "src/generators/generators.h"

namespace spillway::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Periodic = CGAL::Periodic_3_Delaunay_triangulation_3<
    CGAL::Periodic_3_Delaunay_triangulation_traits_3<Kernel>>;

constexpr PeriodicBox kCube{.box = {{0, 0, 0}, {1, 1, 1}}};

/// Processor time of the process.
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

double seconds_of(const std::function<void()>& work) {
  const double start = now();
  work();
  return now() - start;
}

/// Through a sink that counts, by one thread.
void stream(const std::vector<Point<3>>& points, const std::optional<PeriodicBox>& box) {
  ContextOptions options;
  options.threads = 1;
  options.memory = std::uint64_t{1} << 30;
  const Context context(options);
  std::size_t corners = 0;
  const auto sink = mesh_to([&](const MeshBlock& block) { corners += block.corners.size(); });
  triangulate(*points_in_memory(PointView<3>(points), {}), *sink, {.dimension = 3, .periodic = box},
              context);
}

struct Row {
  const char* name;
  std::function<void()> work;
  std::vector<double> seconds{};

  [[nodiscard]] double median() {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }
};

int run(std::uint64_t count, unsigned repetitions, bool with_cgal) {
  const std::vector<Point<3>> points =
      generators::generated_points<3>({generators::Family::kUniform, count, 3, 1});
  std::vector<Kernel::Point_3> for_cgal;
  for (const Point<3>& p : points) for_cgal.emplace_back(p[0], p[1], p[2]);
  std::vector<Row> rows = {
      {"in memory", [&] { const Delaunay<3> mesh(points, {.threads = 1}); }},
      {"in memory, periodic",
       [&] { const Delaunay<3> mesh(points, {.threads = 1, .periodic = kCube}); }},
      {"stream", [&] { stream(points, {}); }},
      {"stream, periodic", [&] { stream(points, kCube); }}};
  if (with_cgal) {
    rows.push_back({"CGAL, periodic", [&] {
                      Periodic mesh(Periodic::Iso_cuboid(0, 0, 0, 1, 1, 1));
                      mesh.insert(for_cgal.begin(), for_cgal.end(), true);
                    }});
  }
  for (unsigned turn = 0; turn < repetitions; ++turn) {
    for (Row& row : rows) row.seconds.push_back(seconds_of(row.work));
  }
  fmt::print(
      "{} uniform points in space, one thread\n\n| | seconds | of in memory | of stream |\n"
      "|---|---|---|---|\n",
      count);
  for (Row& row : rows) {
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} |\n", row.name, row.median(),
               row.median() / rows[0].median(), row.median() / rows[2].median());
  }
  return 0;
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  CLI::App app("Periodic triangulations beside those of CGAL.");
  std::uint64_t count = 1'000'000;
  unsigned repetitions = 3;
  bool without_cgal = false;
  app.add_option("-n", count, "Points")->capture_default_str();
  app.add_option("--repetitions", repetitions, "Turns")->capture_default_str();
  app.add_flag("--no-cgal", without_cgal, "Leave CGAL out");
  CLI11_PARSE(app, argc, argv);
  return spillway::test::run(count, repetitions, !without_cgal);
}
