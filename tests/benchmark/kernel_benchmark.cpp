// The own kernels beside CGAL's Delaunay triangulations, in one process, in turns, on one core.
// Prints one Markdown table; times are the thread's processor time, medians over the turns, and
// include the sorting of the points on both sides.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/kernel_3d/kernel_3d.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/delaunay/kernel_common/lane_width.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "src/generators/random.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway::test {
namespace {

template <int D>
using Points = std::vector<Point<D>>;

template <int D>
void shuffle(Points<D>& points) {
  Random random(7);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
}

/// Uniform in a square, on a lattice of centimetres far from the origin, a point to half a square
/// metre on average.
Points<2> lattice_points(std::size_t count) {
  Random random(42);
  const double side = 70 * std::sqrt(static_cast<double>(count));
  Points<2> points(count);
  for (Point<2>& p : points) {
    p = {std::round(random.uniform() * side) + 5e7, std::round(random.uniform() * side) + 4e8};
  }
  return points;
}

/// Circles beside each other, each with 1,536 points with integer coordinates.
Points<2> integer_circles(std::size_t count) {
  constexpr std::int64_t kSquaredRadius = 837'346'264'625;  // 5^3 13^2 17 29 37 41 53
  const auto radius = static_cast<std::int64_t>(std::sqrt(static_cast<double>(kSquaredRadius)));
  Points<2> circle;
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
  Points<2> points;
  for (std::size_t i = 0; i < circles; ++i) {
    const std::size_t column = i % columns;
    const std::size_t row = i / columns;
    for (const Point<2>& p : circle) {
      points.push_back({p[0] + distance * static_cast<double>(column),
                        p[1] + distance * static_cast<double>(row)});
    }
  }
  points.resize(count);
  shuffle<2>(points);
  return points;
}

/// Integers of 30 bits.
Points<3> random_integers(std::size_t count) {
  Random random(42);
  Points<3> points(count);
  for (Point<3>& p : points) {
    for (double& c : p) c = static_cast<double>(random.below(std::uint64_t{1} << 30));
  }
  return points;
}

/// In more than three dimensions.
template <int D>
Points<D> random_points(const std::string& set, std::size_t count) {
  Random random(42);
  Points<D> points(count);
  for (Point<D>& p : points) {
    for (double& c : p) c = set == "normal" ? random.normal_pair()[0] : random.uniform();
  }
  return points;
}

template <int D>
Points<D> make_points(const std::string& set, std::size_t count) {
  if constexpr (D == 2) {
    if (set == "las") return lattice_points(count);
    if (set == "integer-circles") return integer_circles(count);
    if (set == "metres") {
      Points<2> points = lattice_points(count);
      for (Point<2>& p : points) p = {p[0] * 0.01, p[1] * 0.01};
      return points;
    }
  } else if constexpr (D > 3) {
    if (set == "uniform" || set == "normal") return random_points<D>(set, count);
    throw Failure(fmt::format("there is no set {} in {} dimensions", set, D));
  } else {
    if (set == "integers") return random_integers(count);
    if (set == "sphere") return make_points<3>("circle", count);
  }
  if constexpr (D <= 3) {
    Points<D> points = generated_points<D>({.family = family_by_name(set), .count = count});
    if (set == "lattice") shuffle<D>(points);
    return points;
  }
}

/// What the process has in memory, or had at most since the last call of forget_peak().
std::size_t resident_bytes(const char* name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return std::stoull(line.substr(line.find(':') + 1)) * 1024;
  }
  return 0;
}

void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

struct OwnRun {
  Timing timing{};
  std::size_t bytes = 0;  ///< at the peak, the result and the kernel's working memory
};

/// Sorts and triangulates as `divide` and its callers do with a leaf of a tile.
template <int D>
OwnRun run_own(const Points<D>& points, bool measure_memory) {
  OwnRun run;
  BaseCase<D> base_case;
  Points<D> sorted(points.size());
  std::vector<VertexId> input_index;
  {
    const ProcessorStopwatch watch(run.timing.processor_seconds);
    Box<D> box;
    for (const Point<D>& p : points) box.expand(p);
    input_index = hilbert_order<D>(points, box);
    constexpr std::size_t kAhead = 16;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i + kAhead < points.size()) __builtin_prefetch(&points[input_index[i + kAhead]]);
      sorted[i] = points[input_index[i]];
    }
  }
  if (measure_memory) forget_peak();
  const std::size_t bytes_before = resident_bytes("VmRSS");
  {
    const ProcessorStopwatch watch(run.timing.processor_seconds);
    base_case =
        triangulate_base_case<D>({.points = sorted, .input_index = input_index, .in_place = true});
  }
  run.timing.simplices = base_case.simplices.size() - base_case.hull.size();
  run.bytes = resident_bytes("VmHWM") - bytes_before;
  recycle(std::move(base_case.simplices));
  return run;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <int D>
void compare(const std::string& set, std::size_t count, unsigned repetitions) {
  const Points<D> points = make_points<D>(set, count);
  release_base_case_memory();
  malloc_trim(0);
  const std::size_t bytes =
      run_own<D>(points, true).bytes;  // later base cases find its working memory
  std::vector<double> cgal;
  std::vector<double> own;
  for (unsigned r = 0; r < repetitions; ++r) {
    const Timing reference = time_cgal_sequential<D>(points);
    const Timing ours = run_own<D>(points, false).timing;
    if (ours.simplices != reference.simplices) {
      throw Failure(
          fmt::format("{}: {} simplices, CGAL has {}", set, ours.simplices, reference.simplices));
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

/// The sets that are timed if none are asked for.
std::vector<std::string> usual_sets(int dimension) {
  if (dimension > 3) return {"uniform", "normal"};
  if (dimension == 3) return {"uniform", "terrain", "lattice", "integers", "sphere"};
  return {"uniform", "terrain",  "las",    "metres",
          "lattice", "clusters", "circle", "integer-circles"};
}

std::vector<std::size_t> usual_counts(int dimension) {
  switch (dimension) {
    case 4:
      return {2'000, 20'000};
    case 5:
      return {500, 2'000};
    case 6:
      return {150, 500};
    default:
      return {50'000, 100'000, dimension == 2 ? std::size_t{200'000} : 300'000, 1'000'000};
  }
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  int dimension = 2;
  std::vector<std::string> sets;
  std::vector<std::size_t> counts;
  unsigned repetitions = 5;
  int vectors = 8;
  CLI::App app("Times CGAL's Delaunay triangulations and the own kernels in turns");
  app.add_option("--dim", dimension, "Dimension")->check(CLI::Range(2, 6));
  app.add_option("--sets", sets,
                 "Families of points; in the plane also las, metres, integer-circles, in space "
                 "integers, sphere")
      ->delimiter(',');
  app.add_option("-n,--points", counts, "Points of each set")->delimiter(',');
  app.add_option("-r,--repetitions", repetitions, "Turns; medians are printed");
  app.add_option("--vectors", vectors,
                 "Not in the plane: 2 for SSE2, 4 for AVX2, 8 for AVX-512's registers, too")
      ->check(CLI::IsMember({2, 4, 8}));
  CLI11_PARSE(app, argc, argv);
  if (sets.empty()) sets = spillway::test::usual_sets(dimension);
  if (counts.empty()) counts = spillway::test::usual_counts(dimension);
  spillway::delaunay::limit_lanes(vectors);
  try {
    if (dimension > 2) {
      const int width = spillway::delaunay::lane_width();
      fmt::print("{}\n\n", width == 8   ? "AVX2 with the registers of AVX-512"
                           : width == 4 ? "AVX2"
                                        : "SSE2");
    }
    fmt::print(
        "| points | n | CGAL us a point | ours us a point | CGAL / ours | bytes a point |\n"
        "|---|---|---|---|---|---|\n");
    spillway::parallel::with_threads(1, [&] {  // whose processor time is measured
      for (const std::string& set : sets) {
        for (const std::size_t count : counts) {
          spillway::geometry::with_dimension(
              dimension, [&](auto d) { spillway::test::compare<d>(set, count, repetitions); });
        }
      }
    });
  } catch (const spillway::runtime::Failure& error) {
    fmt::print(stderr, "kernel_benchmark: {}\n", error.what());
    return 1;
  }
}
