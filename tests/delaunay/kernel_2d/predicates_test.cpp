// Each stage of the 2D kernel's predicates against the exact one, on quadruples that are nearly
// degenerate.

#include <gtest/gtest.h>

#include <cmath>

#include "src/delaunay/kernel_2d/circles.h"
#include "src/delaunay/kernel_2d/exact_predicates.h"
#include "src/delaunay/kernel_2d/filters.h"
#include "src/delaunay/kernel_common/lane_width.h"
#include "src/generators/random.h"
#include "src/geometry/predicates.h"

namespace spillway::delaunay::kernel_2d {

using namespace test;  // NOLINT(google-build-using-namespace): what tests share
namespace {

using Four = std::array<Point<2>, 4>;
constexpr Quad kQuad{1, 2, 3, 4};
constexpr int kRuns = 20'000;

/// Four points near one circle, the first three counter-clockwise, rounded to multiples of 2^-bits
/// of the radius: the fewer bits, the more ties.
Four near_circle(Random& random, int bits) {
  for (;;) {
    Four points;
    const double spread = std::ldexp(1.0, -static_cast<int>(random.below(20)));
    const double start = random.uniform() * 6;
    for (Point<2>& p : points) {
      const double angle = start + random.uniform() * 6 * spread;
      p = {std::cos(angle), std::sin(angle)};
      for (double& c : p) c = std::ldexp(std::round(std::ldexp(c, bits)), -bits);
    }
    const int side = orientation<2>({points[0], points[1], points[2]});
    if (side < 0) std::swap(points[1], points[2]);
    if (side != 0) return points;
  }
}

int exact_side(const Four& p) {
  return stages::exact<stages::InSphere<2>>({p[0], p[1], p[2], p[3]});
}

/// The determinant as the inner loop computes it, triangle c, a, b beyond the edge a -> c.
double determinant(const WorkingPoints& points) {
  const Pair query = pair_of(points.scaled[4]);
  const Corner from = corner_at(points.scaled[1], query);
  const Corner apex = corner_at(points.scaled[2], query);
  const Corner to = corner_at(points.scaled[3], query);
  return in_circle_determinant(from, to, apex);
}

double largest(const WorkingPoints& points) {
  const Pair query = pair_of(points.scaled[4]);
  return largest_square(corner_at(points.scaled[1], query), corner_at(points.scaled[2], query),
                        corner_at(points.scaled[3], query));
}

struct Scene {
  explicit Scene(const Four& four) : points(make_working_points(four, memory)) {}
  Slab memory;
  WorkingPoints points;
};

/// The circle of the first three points of the scene, made as part of a star whose other triangles
/// are turned over. `lane` is its place there.
template <int kLanes>
Triangle circle(const WorkingPoints& points, std::size_t lane) {
  std::array<Triangle, 4> memory{};
  const TriangleArray triangles(memory.data());
  std::array<Handle, 4> handles;
  for (std::uint32_t i = 0; i < 4; ++i) handles[i] = TriangleArray::handle(i, 0);
  const bool even = lane % 2 == 0;
  const std::array<VertexId, 2> ends{even ? kQuad.b : kQuad.c, even ? kQuad.c : kQuad.b};
  const std::array<VertexId, 5> ring{ends[0], ends[1], ends[0], ends[1], ends[0]};
  const auto bits = make_circles<kLanes>({.triangles = triangles,
                                          .scaled = points.scaled,
                                          .handles = handles.data(),
                                          .ring = ring.data(),
                                          .apex = pair_of(points.scaled[kQuad.a]),
                                          .next = pair_of(points.scaled[kQuad.query]),
                                          .largest = points.largest},
                                         0);
  const double s = squared_distance(memory[lane], pair_of(points.scaled[kQuad.query]));
  EXPECT_EQ((bits.in_conflict >> lane & 1) != 0, s < memory[lane].inner);
  EXPECT_EQ((bits.unproved >> lane & 1) != 0, std::isnan(memory[lane].inner));
  EXPECT_TRUE(std::isnan(memory[lane ^ 1].inner));
  return memory[lane];
}

SPILLWAY_TARGET("avx2") Triangle wide_circle(const WorkingPoints& points, std::size_t lane) {
  return circle<4>(points, lane);
}

TEST(Kernel2dPredicates, CirclesAreRightWhereTheyAnswer) {
  Random random(7);
  int answers = 0;
  int proved = 0;
  for (int run = 0; run < kRuns; ++run) {
    Four four = near_circle(random, 4 + static_cast<int>(random.below(50)));
    const double offset = run % 3 == 0 ? std::ldexp(1.0, static_cast<int>(random.below(40))) : 0;
    for (Point<2>& p : four) {
      for (double& c : p) c += offset;
    }
    if (random.below(4) == 0) four[3][random.below(2)] *= 1 + std::ldexp(1.0, -run % 30);
    if (orientation<2>({four[0], four[1], four[2]}) <= 0) continue;
    const Scene scene(four);
    const int exact = exact_side(four);
    const std::size_t lane = random.below(4);
    const bool wide = widest_lanes() >= 4;
    const Triangle found =
        wide ? wide_circle(scene.points, lane) : circle<2>(scene.points, lane % 2);
    const double s = squared_distance(found, pair_of(scene.points.scaled[kQuad.query]));
    proved += std::isnan(found.inner) ? 0 : 1;
    if (s < found.inner) {
      ASSERT_EQ(exact, 1) << run;
      ++answers;
    }
    if (s > found.outer) {
      ASSERT_EQ(exact, -1) << run;
      ++answers;
    }
    if (!wide) continue;
    const Triangle narrow = circle<2>(scene.points, lane % 2);
    ASSERT_EQ(std::isnan(narrow.inner), std::isnan(found.inner));
    if (!std::isnan(narrow.inner)) {
      ASSERT_EQ(narrow.inner, found.inner);
    }
  }
  EXPECT_GT(answers, kRuns / 10);
  EXPECT_GT(proved, kRuns / 2);
}

TEST(Kernel2dPredicates, FilterIsRightWhereItAnswers) {
  Random random(1);
  int answers = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Four four = near_circle(random, 4 + static_cast<int>(random.below(50)));
    const Scene scene(four);
    const int exact = exact_side(four);
    if (const auto side = in_circle_filtered(scene.points, kQuad)) {
      ASSERT_EQ(*side, exact);
      ++answers;
    }
  }
  EXPECT_GT(answers, kRuns / 20);
}

TEST(Kernel2dPredicates, LatticeDoublesAreExactUpToTheirLimit) {
  Random random(2);
  int ties = 0;
  int near_limit = 0;
  for (int run = 0; run < kRuns; ++run) {
    Four four = near_circle(random, 1 + static_cast<int>(random.below(13)));
    const Scene scene(four);
    ASSERT_TRUE(scene.points.lattice);
    const double size = largest(scene.points);
    if (size > kExactInCircle) continue;
    near_limit += size > kExactInCircle / 4 ? 1 : 0;
    const double value = determinant(scene.points);
    ASSERT_EQ(stages::sign(value), exact_side(four));
    ties += value == 0 ? 1 : 0;
  }
  EXPECT_GT(ties, 100);
  EXPECT_GT(near_limit, 100);
}

TEST(Kernel2dPredicates, IntegersAndDoubleDoublesAreRightWhereTheyAnswer) {
  Random random(3);
  int integers = 0;
  int double_doubles = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Four four = near_circle(random, 4 + static_cast<int>(random.below(50)));
    const Scene scene(four);
    const int exact = exact_side(four);
    if (scene.points.lattice) {
      if (const auto side = in_circle_integer(scene.points, kQuad)) {
        ASSERT_EQ(*side, exact);
        ++integers;
      }
    }
    if (const auto side = in_circle_double_double(scene.points, kQuad)) {
      ASSERT_EQ(*side, exact);
      ++double_doubles;
    }
    ASSERT_EQ(side_of_circle(scene.points, kQuad), exact);
  }
  EXPECT_GT(integers, 1'000);
  EXPECT_GT(double_doubles, 1'000);
}

TEST(Kernel2dPredicates, RectanglesAreCocircular) {
  Random random(4);
  for (int run = 0; run < 1'000; ++run) {
    const double x = random.uniform();
    const double y = random.uniform();
    const double w = 1 + random.uniform();
    const double h = 1 + random.uniform();
    const Four four{{{x, y}, {w, y}, {w, h}, {x, h}}};
    const Scene scene(four);
    ASSERT_TRUE(is_rectangle(scene.points, kQuad));
    ASSERT_EQ(exact_side(four), 0);
    ASSERT_EQ(side_of_circle(scene.points, kQuad), 0);
  }
}

TEST(Kernel2dPredicates, TieRulesAreThatOfInSphere) {
  Random random(5);
  int ties = 0;
  for (int run = 0; run < kRuns; ++run) {
    // The query beyond the edge c -> a: a and c are opposite each other.
    const Four four = near_circle(random, 1 + static_cast<int>(random.below(5)));
    const auto& [a, b, c, query] = four;
    if (orientation<2>({a, c, query}) <= 0 || exact_side(four) != 0) continue;
    const Scene scene(four);
    const Pair at = pair_of(scene.points.scaled[4]);
    const bool expected = in_sphere<2>({a, b, c}, query) > 0;
    ASSERT_EQ(conflicts(scene.points, kQuad), expected);
    ASSERT_EQ(
        tie_conflicts(corner_at(scene.points.scaled[1], at), corner_at(scene.points.scaled[3], at),
                      corner_at(scene.points.scaled[2], at)),
        expected);
    ++ties;
  }
  EXPECT_GT(ties, 50);
}

TEST(Kernel2dPredicates, SideOfLineIsExact) {
  Random random(6);
  for (int run = 0; run < kRuns; ++run) {
    const Point<2> a{random.uniform(), random.uniform()};
    const Point<2> b{random.uniform(), random.uniform()};
    const double t = random.uniform();
    Point<2> q{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
    if (random.below(4) == 0) q[0] = a[0];
    const Four four{a, b, {3, 1}, q};
    const Scene scene(four);
    ASSERT_EQ(side_of_line(scene.points, 1, 2, 4),
              (stages::exact<stages::Orientation<2>>({a, b, q})));
  }
}

TEST(Kernel2dPredicates, LatticesAreFoundWhateverTheirUnit) {
  for (const double unit : {1.0, 0.25, 0x1p-900, 0x1p900, 3.0}) {
    const Four four{
        {{unit, unit}, {unit * 5, unit}, {unit * 9, unit * 1025}, {unit * 2, unit * 3}}};
    const Scene scene(four);
    EXPECT_TRUE(scene.points.lattice) << unit;
    EXPECT_EQ(scene.points.scaled[3][1], unit == 3.0 ? 1024 * 3 : 1024) << unit;
  }
  const Scene decimals(Four{{{0.1, 0.2}, {0.3, 0.7}, {0.6, 0.1}, {0.5, 0.5}}});
  EXPECT_FALSE(decimals.points.lattice);
}

}  // namespace
}  // namespace spillway::delaunay::kernel_2d
