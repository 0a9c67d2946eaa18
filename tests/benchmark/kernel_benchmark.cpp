// The 2D kernel beside CGAL's Delaunay_triangulation_2, in one process, in turns, on one core.
// Prints one Markdown table; times are the thread's processor time, medians over the turns, and
// include the sorting of the points on both sides.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "src/delaunay/base_case.h"
#include "src/delaunay/hilbert_order.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "src/generators/random.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway {
namespace {

using Points = std::vector<Point<2>>;

void shuffle(Points& points) {
  Random random(7);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
}

/// Uniform in a square, on a lattice of centimetres far from the origin, a point to half a square
/// metre on average.
Points lattice_points(std::size_t count) {
  Random random(42);
  const double side = 70 * std::sqrt(static_cast<double>(count));
  Points points(count);
  for (Point<2>& p : points) {
    p = {std::round(random.uniform() * side) + 5e7, std::round(random.uniform() * side) + 4e8};
  }
  return points;
}

/// Circles beside each other, each with 1,536 points with integer coordinates.
Points integer_circles(std::size_t count) {
  constexpr std::int64_t kSquaredRadius = 837'346'264'625;  // 5^3 13^2 17 29 37 41 53
  const auto radius = static_cast<std::int64_t>(std::sqrt(static_cast<double>(kSquaredRadius)));
  Points circle;
  for (std::int64_t x = -radius; x <= radius; ++x) {
    const std::int64_t squared_y = kSquaredRadius - x * x;
    const std::int64_t y = std::llround(std::sqrt(static_cast<double>(squared_y)));
    if (y * y != squared_y) continue;
    circle.push_back({static_cast<double>(x), static_cast<double>(y)});
    circle.push_back({static_cast<double>(x), static_cast<double>(-y)});
  }
  const std::size_t circles = count / circle.size() + 1;
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(circles)));
  const double distance = 3 * static_cast<double>(radius);
  Points points;
  for (std::size_t i = 0; i < circles; ++i) {
    const std::size_t column = i % columns;
    const std::size_t row = i / columns;
    for (const Point<2>& p : circle) {
      points.push_back({p[0] + distance * static_cast<double>(column),
                        p[1] + distance * static_cast<double>(row)});
    }
  }
  points.resize(count);
  shuffle(points);
  return points;
}

Points make_points(const std::string& set, std::size_t count) {
  if (set == "las") return lattice_points(count);
  if (set == "integer-circles") return integer_circles(count);
  if (set == "metres") {
    Points points = lattice_points(count);
    for (Point<2>& p : points) p = {p[0] * 0.01, p[1] * 0.01};
    return points;
  }
  Points points = generate_points<2>({.family = family_by_name(set), .count = count});
  if (set == "lattice") shuffle(points);
  return points;
}

/// The memory that is in use, whether it was taken in small pieces or mapped.
std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct OwnRun {
  Timing timing{};
  std::size_t bytes = 0;  ///< at the end, the result and the kernel's working memory
};

/// Sorts and triangulates as `divide` and its callers do with a leaf.
OwnRun run_own(const Points& points) {
  OwnRun run;
  const std::size_t bytes_before = bytes_in_use();
  BaseCase<2> base_case;
  {
    const ProcessorStopwatch watch(run.timing.processor_seconds);
    Box<2> box;
    for (const Point<2>& p : points) box.expand(p);
    const std::vector<VertexId> input_index = hilbert_order<2>(points, box);
    Points sorted(points.size());
    constexpr std::size_t kAhead = 16;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i + kAhead < points.size()) __builtin_prefetch(&points[input_index[i + kAhead]]);
      sorted[i] = points[input_index[i]];
    }
    base_case = triangulate_base_case<2>({.points = sorted, .input_index = input_index});
  }
  run.timing.simplices = base_case.simplices.size() - base_case.hull.size();
  run.bytes = bytes_in_use() - bytes_before;
  return run;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void compare(const std::string& set, std::size_t count, unsigned repetitions) {
  const Points points = make_points(set, count);
  release_base_case_memory();
  const std::size_t bytes = run_own(points).bytes;  // later base cases find its working memory
  std::vector<double> cgal;
  std::vector<double> own;
  for (unsigned r = 0; r < repetitions; ++r) {
    const Timing reference = time_cgal_sequential<2>(points);
    const Timing ours = run_own(points).timing;
    if (ours.simplices != reference.simplices) {
      throw Error(
          fmt::format("{}: {} triangles, CGAL has {}", set, ours.simplices, reference.simplices));
    }
    cgal.push_back(reference.processor_seconds);
    own.push_back(ours.processor_seconds);
  }
  const double n = static_cast<double>(points.size());
  fmt::print("| {} | {} | {:.3f} | {:.3f} | **{:.2f}** | {:.0f} |\n", set, points.size(),
             median(cgal) / n * 1e6, median(own) / n * 1e6, median(cgal) / median(own),
             static_cast<double>(bytes) / n);
  std::fflush(stdout);
}

}  // namespace
}  // namespace spillway

int main(int argc, char** argv) {
  std::vector<std::string> sets{"uniform", "terrain",  "las",    "metres",
                                "lattice", "clusters", "circle", "integer-circles"};
  std::vector<std::size_t> counts{50'000, 100'000, 200'000, 1'000'000};
  unsigned repetitions = 5;
  CLI::App app("Times CGAL's 2D Delaunay triangulation and the 2D kernel in turns");
  app.add_option("--sets", sets, "Families of points, las, metres or integer-circles")
      ->delimiter(',');
  app.add_option("-n,--points", counts, "Points of each set")->delimiter(',');
  app.add_option("-r,--repetitions", repetitions, "Turns; medians are printed");
  CLI11_PARSE(app, argc, argv);
  try {
    fmt::print(
        "| points | n | CGAL us a point | ours us a point | CGAL / ours | bytes a point |\n"
        "|---|---|---|---|---|---|\n");
    for (const std::string& set : sets) {
      for (const std::size_t count : counts) spillway::compare(set, count, repetitions);
    }
  } catch (const spillway::Error& error) {
    fmt::print(stderr, "kernel_benchmark: {}\n", error.what());
    return 1;
  }
}
