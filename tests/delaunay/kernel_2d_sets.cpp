#include "tests/delaunay/kernel_2d_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "src/delaunay/affine_basis.h"
#include "src/delaunay/base_case.h"
#include "src/delaunay/hilbert_order.h"
#include "src/delaunay/kernel_2d/kernel_2d.h"
#include "src/generators/random.h"
#include "tests/delaunay/cgal_oracle.h"

namespace spillway {
namespace {

using Points = std::vector<Point<2>>;

double integer_below(Random& random, std::uint64_t n) {
  return static_cast<double>(random.below(n));
}

void add_lattice(Random& random, Points& points, std::size_t count) {
  const std::uint64_t columns = 1 + random.below(7);
  const std::uint64_t rows = 1 + random.below(7);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({integer_below(random, columns), integer_below(random, rows)});
  }
}

void add_line(Random& random, Points& points, std::size_t count) {
  const double dx = integer_below(random, 4);
  const double dy = integer_below(random, 4) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = integer_below(random, 20);
    points.push_back({t * dx, t * dy});
  }
}

/// Points with integer coordinates on one circle around the origin, sometimes with its centre.
void add_integer_circle(Random& random, Points& points, std::size_t count) {
  constexpr std::array<int, 5> kRadii{5, 25, 65, 325, 1105};
  const int radius = kRadii[random.below(kRadii.size())];
  Points circle;
  for (int x = -radius; x <= radius; ++x) {
    const int y = static_cast<int>(std::lround(std::sqrt(radius * radius - x * x)));
    if (x * x + y * y != radius * radius) continue;
    circle.push_back({static_cast<double>(x), static_cast<double>(y)});
    circle.push_back({static_cast<double>(x), static_cast<double>(-y)});
  }
  for (std::size_t i = 0; i < count; ++i) points.push_back(circle[random.below(circle.size())]);
  if (random.below(2) == 0) points.push_back({0, 0});
}

/// As near to a circle as doubles are, or some roundings off.
void add_rounded_circle(Random& random, Points& points, std::size_t count) {
  const std::uint64_t roundings = random.below(4);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * integer_below(random, 64) / 64;
    Point<2> p{std::cos(angle), std::sin(angle)};
    for (double& c : p) c *= 1 + integer_below(random, roundings + 1) * 0x1p-52;
    points.push_back(p);
  }
}

void add_decimals(Random& random, Points& points, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({integer_below(random, 8) * 0.1, integer_below(random, 8) * 0.1});
  }
}

void add_uniform(Random& random, Points& points, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) points.push_back({random.uniform(), random.uniform()});
}

/// Corners of a large square beside the points of a small one.
void add_two_scales(Random& random, Points& points, std::size_t count) {
  constexpr double kEnd = 0x1p31;
  for (std::size_t i = 0; i < count; ++i) {
    const bool corner = random.below(3) == 0;
    const double x = integer_below(random, 4);
    const double y = integer_below(random, 4);
    points.push_back(corner ? Point<2>{x < 2 ? -kEnd : kEnd - 1, y < 2 ? -kEnd : kEnd - 1}
                            : Point<2>{x, y});
  }
}

void transform(Random& random, Points& points) {
  constexpr std::array<double, 5> kOffsets{1e6, 1e9, 1e12, 1e15, -3e5};
  constexpr std::array<int, 7> kExponents{-1074, -1060, -500, -30, 30, 500, 950};
  if (random.below(3) == 0) {
    const double dx = kOffsets[random.below(kOffsets.size())];
    const double dy = kOffsets[random.below(kOffsets.size())];
    for (Point<2>& p : points) p = {p[0] + dx, p[1] + dy};
  }
  if (random.below(3) == 0) {
    const int exponent = kExponents[random.below(kExponents.size())];
    for (Point<2>& p : points) p = {std::ldexp(p[0], exponent), std::ldexp(p[1], exponent)};
  }
  if (random.below(4) == 0) {
    for (Point<2>& p : points) std::swap(p[0], p[1]);
  }
}

using Triangle = std::array<VertexId, 3>;

/// The finite triangles as CGAL's oracle names them: by sorted places in `points`, of equal points
/// the first.
std::vector<Triangle> finite_triangles(const BaseCase<2>& base_case,
                                       std::span<const VertexId> place) {
  std::vector<Triangle> triangles;
  for (const Simplex<2>& s : base_case.simplices) {
    if (s.infinite()) continue;
    Triangle& triangle = triangles.emplace_back();
    for (int i = 0; i < 3; ++i) triangle[i] = place[s.vertices[i]];
    std::sort(triangle.begin(), triangle.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

std::vector<Point<2>> hard_set(std::uint64_t seed) {
  constexpr std::array kParts{add_lattice,  add_line,    add_integer_circle, add_rounded_circle,
                              add_decimals, add_uniform, add_two_scales};
  Random random(seed);
  Points points;
  const std::uint64_t parts = 1 + random.below(2);
  for (std::uint64_t part = 0; part < parts; ++part) {
    kParts[random.below(kParts.size())](random, points, 1 + random.below(30));
  }
  transform(random, points);
  return points;
}

std::string compare_kernel_with_cgal(std::span<const Point<2>> points, std::uint64_t seed) {
  // Half of the sets in the order of the curve, as the kernel likes it, half as they come.
  std::vector<VertexId> place(points.size());
  std::iota(place.begin(), place.end(), VertexId{0});
  if (seed % 2 == 0) {
    Box<2> box;
    for (const Point<2>& p : points) box.expand(p);
    place = hilbert_order<2>(points, box);
  }
  Triangulation<2> t;
  for (const VertexId i : place) t.points.push_back(points[i]);
  t.input_index = place;
  const BaseCaseInput<2> input{.points = t.points, .input_index = t.input_index};
  const std::vector<VertexId> basis = affine_basis<2>(input.points);
  const auto expected = cgal_simplices<2>(points);
  if (basis.size() < 3) return expected.empty() ? "" : "collinear points have triangles";
  const BaseCase<2> result = kernel_2d_base_case(input, basis);
  if (finite_triangles(result, place) != expected) {
    return fmt::format("{} finite triangles, CGAL has {}, or others",
                       result.simplices.size() - result.hull.size(), expected.size());
  }
  t.blocks.resize(1);
  t.blocks[0].simplices = result.simplices;
  for (const std::uint32_t i : result.hull) t.hull.push_back({0, i});
  t.duplicates = result.duplicates;
  t.dimension = 2;
  const std::vector<std::string> faults = verify(t);
  return faults.empty() ? "" : faults.front();
}

}  // namespace spillway
