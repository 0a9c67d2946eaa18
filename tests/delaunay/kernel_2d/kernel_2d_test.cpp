// The 2D kernel as a whole: for every input CGAL's triangulation.

#include "src/delaunay/kernel_2d/kernel_2d.h"
#include "src/delaunay/base_case/base_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/error.h"
#include "src/generators/random.h"
#include "tests/delaunay/kernel_sets.h"
#include "tests/generators/family_cases.h"

namespace spillway::test {
namespace {

using Points = std::vector<Point<2>>;

void expect_equal_to_cgal(const Points& points) {
  EXPECT_EQ(compare_kernel_with_cgal<2>(points, 0), "");
}

Points scaled(Points points, int exponent) {
  for (Point<2>& p : points) p = {std::ldexp(p[0], exponent), std::ldexp(p[1], exponent)};
  return points;
}

Points moved(Points points, double dx, double dy) {
  for (Point<2>& p : points) p = {p[0] + dx, p[1] + dy};
  return points;
}

Points random_integers(std::size_t count, std::uint64_t columns, std::uint64_t rows) {
  Random random(3);
  Points points(count);
  for (Point<2>& p : points) {
    p = {static_cast<double>(random.below(columns)), static_cast<double>(random.below(rows))};
  }
  return points;
}

std::vector<FamilyCase> planar_cases() {
  std::vector<FamilyCase> cases = all_family_cases();
  std::erase_if(cases, [](const FamilyCase& c) { return c.dimension != 2; });
  return cases;
}

class Kernel2dOfFamily : public ::testing::TestWithParam<FamilyCase> {};

TEST_P(Kernel2dOfFamily, EqualsCgal) {
  const bool collinear = GetParam().family == Family::kCollinear;  // CGAL takes quadratic time
  for (const std::uint64_t n : {10, 1'000, collinear ? 2'000 : 20'000}) {
    SCOPED_TRACE(n);
    expect_equal_to_cgal(generated_points<2>({.family = GetParam().family, .count = n, .seed = 5}));
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Kernel2dOfFamily, ::testing::ValuesIn(planar_cases()),
                         family_case_name);

TEST(Kernel2d, EqualsCgalOnSmallHardSets) {
  for (std::uint64_t seed = 1; seed <= 3'000; ++seed) {
    ASSERT_EQ(compare_kernel_with_cgal<2>(hard_set<2>(seed), seed), "") << "seed " << seed;
  }
}

TEST(Kernel2d, EqualsCgalOnWheelsOfManySpokes) {
  // The hub, inserted late, is in conflict with thousands of triangles at once.
  Points wheel;
  constexpr int kSpokes = 5'000;
  for (int i = 0; i < kSpokes; ++i) {
    wheel.push_back({std::cos(2 * M_PI * i / kSpokes), std::sin(2 * M_PI * i / kSpokes)});
  }
  wheel.push_back({0x1p-40, 0x1p-41});
  EXPECT_EQ(compare_kernel_with_cgal<2>(wheel, 1), "");
}

TEST(Kernel2d, EqualsCgalWhateverThePowerOfTwo) {
  const Points lattice = random_integers(500, 20, 20);
  const Points circle = generated_points<2>({.family = Family::kCircle, .count = 200});
  for (const int exponent : {-1074, -1050, -1000, -500, -1, 10, 500, 960, 1000}) {
    SCOPED_TRACE(exponent);
    expect_equal_to_cgal(scaled(lattice, exponent));
    expect_equal_to_cgal(scaled(circle, exponent));
  }
}

TEST(Kernel2d, EqualsCgalAtHugeOffsets) {
  const Points lattice = random_integers(500, 25, 25);
  const Points uniform = generated_points<2>({.family = Family::kUniform, .count = 500});
  for (const double offset : {1e6, 1e9, 1e12, 1e15}) {
    SCOPED_TRACE(offset);
    expect_equal_to_cgal(moved(lattice, offset, -offset));
    expect_equal_to_cgal(moved(uniform, offset, 2 * offset));
  }
}

TEST(Kernel2d, EqualsCgalOnTheLargestDoubles) {
  constexpr double kMax = std::numeric_limits<double>::max();
  expect_equal_to_cgal(
      {{-kMax, -kMax}, {kMax, -kMax}, {kMax, kMax}, {-kMax, kMax}, {1, 2}, {0, 0}});
}

TEST(Kernel2d, EqualsCgalOnTheFullLatticeOf32Bits) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << 32) - 1;
  Points points = moved(random_integers(3'000, kAll, kAll), -0x1p31, -0x1p31);
  for (const double x : {-0x1p31, 0x1p31 - 1}) {
    for (const double y : {-0x1p31, 0x1p31 - 1}) points.push_back({x, y});
  }
  expect_equal_to_cgal(points);
  const Points dense = random_integers(500, 20, 20);
  points.insert(points.end(), dense.begin(), dense.end());
  expect_equal_to_cgal(points);
}

TEST(Kernel2d, EqualsCgalOnLatticesThatAreNotIntegers) {
  expect_equal_to_cgal(scaled(random_integers(2'000, 60, 60), -2));
  Points decimals = random_integers(2'000, 60, 60);
  for (Point<2>& p : decimals) p = {500'000 + p[0] * 0.01, 4'000'000 + p[1] * 0.01};
  expect_equal_to_cgal(decimals);
}

TEST(Kernel2d, EqualsCgalOnVerySmallBesideVeryLarge) {
  Points points = scaled(random_integers(50, 8, 8), -1074);
  const Points large = scaled(random_integers(50, 8, 8), 1000);
  points.insert(points.end(), large.begin(), large.end());
  points.push_back({0.25, 1e-200});
  expect_equal_to_cgal(points);
}

TEST(Kernel2d, GivesTheSameSimplicesInTheSameOrderEveryTime) {
  const Points points = generated_points<2>({.family = Family::kTerrain, .count = 3'000});
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  const auto run = [&] {
    return triangulate_base_case<2>({.points = points, .input_index = index});
  };
  const BaseCase<2> first = run();
  triangulate_base_case<2>({.points = std::span(points).first(70), .input_index = index});
  const BaseCase<2> second = run();  // in memory that others have used
  ASSERT_EQ(first.simplices.size(), second.simplices.size());
  for (std::size_t i = 0; i < first.simplices.size(); ++i) {
    ASSERT_EQ(first.simplices[i].vertices, second.simplices[i].vertices);
    ASSERT_EQ(first.simplices[i].neighbours, second.simplices[i].neighbours);
  }
  EXPECT_EQ(first.hull, second.hull);
}

TEST(Kernel2d, MakesWayForCgalWhenAsked) {
  const Points points = random_integers(400, 20, 20);
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  const BaseCaseInput<2> input{.points = points, .input_index = index};
  const BaseCase<2> own = triangulate_base_case<2>(input);
  BaseCaseInput<2> with_cgal = input;
  with_cgal.kernel = Kernel::kCgal;
  const BaseCase<2> cgal = triangulate_base_case<2>(with_cgal);
  EXPECT_EQ(own.simplices.size(), cgal.simplices.size());
  EXPECT_EQ(own.hull.size(), cgal.hull.size());
  EXPECT_EQ(own.duplicates, cgal.duplicates);
}

TEST(Kernel2d, RefusesMorePointsThanItCanNumber) {
  const Points few{{0, 0}, {1, 0}, {0, 1}};
  const std::vector<VertexId> basis{0, 1, 2};
  const BaseCaseInput<2> input{.points = std::span(few.data(), std::size_t{1} << 28),
                               .input_index = basis};
  EXPECT_THROW(kernel_2d_base_case(input, basis), Failure);
}

TEST(Kernel2d, EqualsCgalWithFewLanes) {
  const LaneLimit limit(2);
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    ASSERT_EQ(compare_kernel_with_cgal<2>(hard_set<2>(seed), seed), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace spillway::test
