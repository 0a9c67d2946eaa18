// A mesh in memory: its construction, and queries of many places, beside CGAL's on the same points
// and places, sorted along its spatial curve, each search from where the last one ended. Prints a
// Markdown table of microseconds a point or place, medians over the turns: processor time of the
// one thread that works, or wall time if there are several. The engine is the part of construction
// that all other calls share.

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>
#include <fmt/format.h>
#include <spillway/delaunay.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/generators/generators.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <int D>
struct Cgal;
template <>
struct Cgal<2> {
  using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
  static Kernel::Point_2 point(const Point<2>& p) { return {p[0], p[1]}; }
  static auto cell(Triangulation::Vertex_handle vertex) { return vertex->face(); }
};
template <>
struct Cgal<3> {
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;
  static Kernel::Point_3 point(const Point<3>& p) { return {p[0], p[1], p[2]}; }
  static auto cell(Triangulation::Vertex_handle vertex) { return vertex->cell(); }
};

struct Plan {
  std::vector<int> dimensions{2, 3};
  std::vector<std::string> families{"uniform"};
  std::uint64_t points = 1'000'000;
  std::uint64_t places = 1'000'000;
  std::vector<unsigned> threads{1, 2};
  unsigned repetitions = 3;
  bool cgal = true;
};

template <typename Watch, typename Work>
double median_microseconds(const Plan& plan, std::size_t items, const Work& work) {
  std::vector<double> times(plan.repetitions, 0);
  for (double& seconds : times) {
    const Watch watch(seconds);
    static_cast<void>(work());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2] * 1e6 / static_cast<double>(items);
}

template <int D>
void print_row(const Plan& plan, const std::string& family, const std::string& whose,
               std::array<double, 7> times) {
  std::string row = fmt::format("| {}D {} | {} | {} |", D, family, plan.points, whose);
  for (const double time : times) {
    row += time > 0 ? fmt::format(" {:.3f} |", time) : std::string(" - |");
  }
  fmt::print("{}\n", row);
  std::fflush(stdout);
}

template <int D>
void time_cgal(const Plan& plan, const std::string& family, const std::vector<Point<D>>& points,
               const std::vector<Point<D>>& places) {
  using Query = decltype(Cgal<D>::point({}));
  std::vector<Query> input, queries;
  for (const auto& p : points) input.push_back(Cgal<D>::point(p));
  for (const auto& p : places) queries.push_back(Cgal<D>::point(p));
  const auto sorted = [&queries] {
    std::vector<Query> copy = queries;
    CGAL::spatial_sort(copy.begin(), copy.end(), Kernel());
    return copy;
  };
  typename Cgal<D>::Triangulation triangulation;
  std::array<double, 7> times{};
  times[1] = median_microseconds<ProcessorStopwatch>(plan, points.size(), [&] {
    triangulation = typename Cgal<D>::Triangulation(input.begin(), input.end());
  });
  times[2] = median_microseconds<ProcessorStopwatch>(plan, places.size(), [&] {
    auto cell = triangulation.locate(queries[0]);
    for (const Query& q : sorted()) cell = triangulation.locate(q, cell);
  });
  times[3] = median_microseconds<ProcessorStopwatch>(plan, places.size(), [&] {
    auto cell = triangulation.locate(queries[0]);
    for (const Query& q : sorted()) {
      cell = Cgal<D>::cell(triangulation.nearest_vertex(q, cell));
    }
  });
  print_row<D>(plan, family, "CGAL", times);
}

template <int D>
void time_family(const Plan& plan, const std::string& family) {
  const auto generate = [&](std::uint64_t count, std::uint64_t seed) {
    return generated_points<D>({family_by_name(family), count, D, seed});
  };
  const std::vector<Point<D>> points = generate(plan.points, 1);
  const std::vector<Point<D>> places = generate(plan.places, 2);
  if (plan.cgal) time_cgal<D>(plan, family, points, places);
  std::vector<double> values(points.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = points[i][0];
  for (const unsigned threads : plan.threads) {
    const DelaunayOptions options{.threads = threads};
    const auto time = [&](std::size_t items, const auto& work) {
      return threads == 1 ? median_microseconds<ProcessorStopwatch>(plan, items, work)
                          : median_microseconds<Stopwatch>(plan, items, work);
    };
    const double engine = time(
        points.size(), [&] { return delaunay_triangulation<D>(points, {.threads = threads}); });
    const double construction =
        time(points.size(), [&] { const Delaunay<D> mesh(points, options); });
    const Delaunay<D> mesh(points, options);
    const double locate = time(places.size(), [&] { return mesh.locate(places); });
    const double nearest = time(places.size(), [&] { return mesh.nearest_vertex(places); });
    const double interpolate =
        time(places.size(), [&] { return mesh.interpolate(values, places); });
    const double one = time(places.size(), [&] {
      for (const auto& place : places) static_cast<void>(mesh.locate(place));
    });
    const double centres = time(points.size(), [&] { return mesh.circumcentres(); });
    print_row<D>(
        plan, family, fmt::format("Spillway, {} thread{}", threads, threads == 1 ? "" : "s"),
        {engine, construction, locate, nearest, interpolate, threads == 1 ? one : 0, centres});
  }
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Times meshes in memory and questions to them, ours and CGAL's");
  app.add_option("--dims", plan.dimensions, "Dimensions")->delimiter(',');
  app.add_option("--families", plan.families, "Families of points and places")->delimiter(',');
  app.add_option("-n,--points", plan.points, "Points of each set");
  app.add_option("-q,--places", plan.places, "Places to ask for");
  app.add_option("--threads", plan.threads, "Threads of ours")->delimiter(',');
  app.add_option("-r,--repetitions", plan.repetitions, "Turns; medians are printed");
  app.add_flag("--cgal,!--no-cgal", plan.cgal, "Time CGAL, too");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| points | n | | engine | construction | locate | nearest vertex | interpolate | locate, "
      "one by one "
      "| circumcentres |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int dimension : plan.dimensions) {
    for (const std::string& family : plan.families) {
      dimension == 2 ? spillway::test::time_family<2>(plan, family)
                     : spillway::test::time_family<3>(plan, family);
    }
  }
}
