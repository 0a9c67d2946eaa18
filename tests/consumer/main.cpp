// What a program does with the library; docs/library.md explains it with the same code. Ends with
// 1 and says where if something is not as promised.

#include <spillway/delaunay.h>
#include <spillway/version.h>

#include "products.h"
#include "streams.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

namespace {

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::exit(EXIT_FAILURE);
}

template <int D>
std::vector<spillway::Point<D>> random_points(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<spillway::Point<D>> points(count);
  for (auto& point : points) {
    for (double& c : point) c = coordinate(random);
  }
  return points;
}

// Points, triangles, neighbours.
void triangulate_and_walk() {
  const std::vector<spillway::Point<2>> points{{0, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {4, 0}};
  const spillway::Delaunay<2> mesh(points);

  for (const auto cell : mesh.cells()) {
    std::printf("triangle %d %d %d\n", cell.vertices[0], cell.vertices[1], cell.vertices[2]);
  }
  for (const auto& [point, vertex] : mesh.duplicates()) {
    std::printf("point %d equals point %d\n", point, vertex);
  }
  expect(mesh.cell_count() == 4 && mesh.duplicates().size() == 1,
         "five places make four triangles");

  // All triangles are reached from one by way of their neighbours.
  std::set<std::int32_t> reached{0};
  std::vector<std::int32_t> next{0};
  while (!next.empty()) {
    const auto cell = mesh.cells()[next.back()];
    next.pop_back();
    for (const std::int32_t neighbour : cell.neighbours) {
      if (neighbour >= 0 && reached.insert(neighbour).second) next.push_back(neighbour);
    }
  }
  expect(reached.size() == mesh.cell_count(), "neighbours reach everything");

  // The hull is walked along its edges, counter-clockwise.
  double area = 0;
  const auto hull = mesh.hull_facets();
  for (std::size_t f = 0; f < hull.size(); f += 2) {
    const auto& a = mesh.points()[hull[f]];
    const auto& b = mesh.points()[hull[f + 1]];
    area += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  expect(area == 12, "the hull has the area of the rectangle");
}

// Arrays as they lie in the program's memory.
void use_arrays() {
  struct Return {
    float intensity;
    double x, y, z;
  };
  const std::vector<Return> scan{
      {0.5F, 0, 0, 7}, {0.1F, 2, 0, 8}, {0.3F, 0, 2, 9}, {0.2F, 2, 3, 10}};
  const spillway::PointView<2> view({&scan[0].x, &scan[0].y}, scan.size(), sizeof(Return));
  const spillway::Delaunay<2> terrain(view);

  std::vector<double> heights;
  for (const Return& r : scan) heights.push_back(r.z);
  const std::vector<spillway::Point<2>> places{{1, 0}, {2, 3}, {9, 9}};
  const std::vector<double> found = terrain.interpolate(heights, places);
  expect(found[0] == 7.5 && found[1] == 10, "heights between points");
#ifndef __FAST_MATH__  // with it a program cannot ask
  expect(std::isnan(found[2]), "no height outside");
#endif
}

// Questions in space.
void ask() {
  const auto points = random_points<3>(10'000);
  const spillway::Delaunay<3> mesh(points, {.threads = 2});
  const spillway::Point<3> place{0.5, 0.5, 0.5};

  const std::int32_t cell = mesh.locate(place);
  expect(cell >= 0, "the middle is inside");
  const std::int32_t nearest = mesh.nearest_vertex(place);
  const std::vector<std::int32_t> all = mesh.nearest_vertex(points);
  for (std::size_t i = 0; i < all.size(); ++i) {
    expect(all[i] == static_cast<std::int32_t>(i), "a point is nearest to itself");
  }
  const spillway::Point<3> centre = mesh.circumcentre(cell);
  std::printf("tetrahedron %d, nearest point %d, centre at %g %g %g\n", cell, nearest, centre[0],
              centre[1], centre[2]);
  expect(mesh.locate(spillway::Point<3>{2, 2, 2}) == -1, "-1 is outside");
}

// Errors have codes.
spillway::ErrorCode fault_of(spillway::PointView<2> points,
                             spillway::DelaunayOptions options = {}) {
  try {
    const spillway::Delaunay<2> mesh(points, options);
  } catch (const spillway::Error& error) {
    std::printf("%s: %s\n", to_string(error.code()), error.what());
    return error.code();
  }
  expect(false, "an error is thrown");
  return {};
}

// Points that repeat with a box.
void repeat() {
  const auto atoms = random_points<3>(2000);

  const spillway::PeriodicBox box{.box = {{0, 0, 0}, {1, 1, 1}}};
  const spillway::Delaunay<3> packing(atoms, {.periodic = box});
  double longest = 0;
  for (std::size_t c = 0; c < packing.cell_count(); ++c) {
    double squares = 0;  // of the edge from the first corner to the second
    for (int k = 0; k < 3; ++k) {
      const auto coordinate = [&](std::size_t corner) {
        const std::int32_t vertex = packing.cell_vertices()[4 * c + corner];
        const int periods = packing.cell_offsets()[3 * (4 * c + corner) + k];
        return packing.points()[vertex][k] + periods * box.period(k);
      };
      const double along = coordinate(1) - coordinate(0);
      squares += along * along;
    }
    longest = std::max(longest, std::sqrt(squares));
  }

  expect(packing.hull_facets().empty(), "a closed box has no hull");
  expect(longest > 0 && longest < 0.5, "edges are short across the sides, too");
  expect(packing.locate({1.25, -3.5, 0.5}) == packing.locate({0.25, 0.5, 0.5}),
         "copies of a place lie in the same cell");
}

void catch_errors() {
  using spillway::ErrorCode;
  using Points = std::vector<spillway::Point<2>>;
  const Points line{{0, 0}, {1, 1}, {2, 2}};
  expect(fault_of(line) == ErrorCode::kDegenerateInput, "a line spans no triangle");
  expect(fault_of({}) == ErrorCode::kDegenerateInput, "nothing spans no triangle");

  const Points hole{{0, 0}, {1, 0}, {std::numeric_limits<double>::quiet_NaN(), 1}};
  expect(fault_of(hole) == ErrorCode::kInvalidArgument, "coordinates are finite");

  const double zero = 0;  // the same point, three thousand million times
  const spillway::PointView<2> many({&zero, &zero}, 3'000'000'000, 0);
  expect(fault_of(many) == ErrorCode::kTooLarge, "32 bits do not number so many points");
}

// A long run tells of its progress, and can be stopped.
void cancel() {
  const auto points = random_points<2>(500'000);
  std::stop_source stop;
  spillway::DelaunayOptions options;
  options.threads = 1;
  options.progress = [&](std::size_t done, std::size_t total) {
    std::printf("%zu of %zu\n", done, total);
    stop.request_stop();
  };
  options.stop = stop.get_token();
  expect(fault_of(points, options) == spillway::ErrorCode::kInterrupted, "a run can be stopped");
}

// A program may be built with -ffast-math, where numbers below 1e-308 become 0 in its own code.
void keep_subnormal_numbers() {
  const double least = std::numeric_limits<double>::denorm_min();
  const std::vector<spillway::Point<2>> points{{0, 0}, {least, 0}, {0, least}, {least, least}};
  const spillway::Delaunay<2> mesh(points);
  expect(mesh.cell_count() == 2 && mesh.duplicates().empty(), "the least distance is one");
}

}  // namespace

int main() {
  expect(spillway::version() == SPILLWAY_VERSION_TEXT, "headers and library are of one version");
  triangulate_and_walk();
  use_arrays();
  ask();
  repeat();
  catch_errors();
  cancel();
  keep_subnormal_numbers();
  try {
    use_streams();
    make_products();
  } catch (const std::logic_error& error) {
    expect(false, error.what());
  }
}
