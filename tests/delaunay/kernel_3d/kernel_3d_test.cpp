// The 3D kernel as a whole: for every input CGAL's triangulation.

#include "src/delaunay/kernel_3d/kernel_3d.h"
#include "src/delaunay/base_case/base_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "src/error.h"
#include "src/generators/random.h"
#include "tests/delaunay/kernel_sets.h"
#include "tests/generators/family_cases.h"

namespace spillway::test {
namespace {

using Points = std::vector<Point<3>>;

void expect_equal_to_cgal(const Points& points) {
  EXPECT_EQ(compare_kernel_with_cgal<3>(points, 0), "");
}

Points scaled(Points points, int exponent) {
  for (Point<3>& p : points) {
    for (double& c : p) c = std::ldexp(c, exponent);
  }
  return points;
}

Points moved(Points points, const Point<3>& by) {
  for (Point<3>& p : points) {
    for (int k = 0; k < 3; ++k) p[k] += by[k];
  }
  return points;
}

Points random_integers(std::size_t count, std::uint64_t side, std::uint64_t height) {
  Random random(3);
  Points points(count);
  for (Point<3>& p : points) {
    p = {static_cast<double>(random.below(side)), static_cast<double>(random.below(side)),
         static_cast<double>(random.below(height))};
  }
  return points;
}

Points uniform(std::size_t count) {
  return generated_points<3>({.family = Family::kUniform, .count = count, .seed = 5});
}

std::vector<VertexId> indices(std::size_t count) {
  std::vector<VertexId> index(count);
  std::iota(index.begin(), index.end(), VertexId{0});
  return index;
}

std::vector<FamilyCase> spatial_cases() {
  std::vector<FamilyCase> cases = all_family_cases();
  std::erase_if(cases, [](const FamilyCase& c) { return c.dimension != 3; });
  return cases;
}

class Kernel3dOfFamily : public ::testing::TestWithParam<FamilyCase> {};

TEST_P(Kernel3dOfFamily, EqualsCgal) {
  const Family family = GetParam().family;
  // Points of two lines have quadratically many cells, and CGAL takes quadratic time for one.
  const bool quadratic = family == Family::kLines || family == Family::kCollinear;
  for (const std::uint64_t n : {10, 300, quadratic ? 600 : 8'000}) {
    SCOPED_TRACE(n);
    expect_equal_to_cgal(generated_points<3>({.family = family, .count = n, .seed = 5}));
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Kernel3dOfFamily, ::testing::ValuesIn(spatial_cases()),
                         family_case_name);

TEST(Kernel3d, EqualsCgalOnSmallHardSets) {
  for (std::uint64_t seed = 1; seed <= 3'000; ++seed) {
    ASSERT_EQ(compare_kernel_with_cgal<3>(hard_set<3>(seed), seed), "") << "seed " << seed;
  }
}

TEST(Kernel3d, EqualsCgalWithFewLanes) {
  for (const int doubles : {4, 2}) {
    const LaneLimit limit(doubles);
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
      ASSERT_EQ(compare_kernel_with_cgal<3>(hard_set<3>(seed), seed), "") << "seed " << seed;
    }
    expect_equal_to_cgal(uniform(3'000));
    expect_equal_to_cgal(random_integers(3'000, 12, 12));
  }
}

TEST(Kernel3d, GivesTheSameSimplicesWithVectorsOfAnyWidth) {
  const Points points = uniform(2'000);
  const std::vector<VertexId> index = indices(points.size());
  const BaseCaseInput<3> input{.points = points, .input_index = index};
  const BaseCase<3> wide = triangulate_base_case<3>(input);
  for (const int doubles : {4, 2}) {
    const LaneLimit limit(doubles);
    const BaseCase<3> narrow = triangulate_base_case<3>(input);
    ASSERT_EQ(wide.simplices.size(), narrow.simplices.size());
    for (std::size_t i = 0; i < wide.simplices.size(); ++i) {
      ASSERT_EQ(wide.simplices[i].vertices, narrow.simplices[i].vertices);
      ASSERT_EQ(wide.simplices[i].neighbours, narrow.simplices[i].neighbours);
    }
  }
}

TEST(Kernel3d, EqualsCgalOnAPlaneAndOnePoint) {
  Points plane = uniform(3'000);
  for (Point<3>& p : plane) p[2] = 0;
  plane.push_back({0.3, 0.4, 1});
  expect_equal_to_cgal(plane);
  for (Point<3>& p : plane) p[2] += p[0] + 2 * p[1];  // rounded: nearly coplanar
  expect_equal_to_cgal(plane);
  Points grid = random_integers(2'000, 40, 1);
  grid.push_back({7, 8, 9});
  expect_equal_to_cgal(grid);
}

TEST(Kernel3d, EqualsCgalOnStarsOfManyCells) {
  // The centre, inserted late, is in conflict with thousands of cells at once.
  for (const std::uint64_t count : {60, 150, 400, 3'000}) {
    SCOPED_TRACE(count);
    Points sphere = generated_points<3>({.family = Family::kCircle, .count = count, .seed = 2});
    sphere.push_back({0x1p-40, 0x1p-41, 0x1p-42});
    EXPECT_EQ(compare_kernel_with_cgal<3>(sphere, 1), "");
    Points needle(count, Point<3>{});
    for (std::size_t i = 0; i < count; ++i) {
      needle[i] = i % 2 == 0 ? Point<3>{std::cos(static_cast<double>(i)),
                                        std::sin(static_cast<double>(i)), 0}
                             : Point<3>{0, 0, static_cast<double>(i)};
    }
    needle.resize(std::min<std::size_t>(count, 400));
    EXPECT_EQ(compare_kernel_with_cgal<3>(needle, 1), "");
  }
}

TEST(Kernel3d, EqualsCgalOnIntegerSpheres) {
  Points sphere;
  for (int x = -33; x <= 33; ++x) {
    for (int y = -33; y <= 33; ++y) {
      for (int z = -33; z <= 33; ++z) {
        if (x * x + y * y + z * z != 33 * 33) continue;
        sphere.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
      }
    }
  }
  ASSERT_GT(sphere.size(), 100U);
  expect_equal_to_cgal(sphere);
  sphere.push_back({0, 0, 0});
  EXPECT_EQ(compare_kernel_with_cgal<3>(sphere, 1), "");
}

TEST(Kernel3d, EqualsCgalWhateverThePowerOfTwo) {
  const Points lattice = random_integers(400, 8, 8);
  const Points sphere = generated_points<3>({.family = Family::kCircle, .count = 150});
  for (const int exponent : {-1074, -1050, -1000, -500, -1, 10, 500, 960, 1000}) {
    SCOPED_TRACE(exponent);
    expect_equal_to_cgal(scaled(lattice, exponent));
    expect_equal_to_cgal(scaled(sphere, std::min(exponent, 900)));  // its radius is large
  }
}

TEST(Kernel3d, EqualsCgalAtHugeOffsets) {
  const Points lattice = random_integers(500, 9, 9);
  for (const double offset : {1e6, 1e9, 1e12, 1e15}) {
    SCOPED_TRACE(offset);
    expect_equal_to_cgal(moved(lattice, {offset, -offset, 2 * offset}));
    expect_equal_to_cgal(moved(uniform(500), {offset, 2 * offset, -offset}));
  }
}

TEST(Kernel3d, EqualsCgalOnTheLargestDoubles) {
  constexpr double kMax = std::numeric_limits<double>::max();
  Points corners{{1, 2, 3}, {0, 0, 0}};
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {(i & 1) != 0 ? kMax : -kMax, (i & 2) != 0 ? kMax : -kMax, (i & 4) != 0 ? kMax : -kMax});
  }
  expect_equal_to_cgal(corners);
}

TEST(Kernel3d, EqualsCgalOnTheFullLatticeOf32Bits) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << 32) - 1;
  Points points = moved(random_integers(3'000, kAll, kAll), {-0x1p31, -0x1p31, -0x1p31});
  for (int i = 0; i < 8; ++i) {
    const auto end = [i](int bit) { return (i & bit) != 0 ? 0x1p31 - 1 : -0x1p31; };
    points.push_back({end(1), end(2), end(4)});
  }
  expect_equal_to_cgal(points);
  const Points dense = random_integers(500, 8, 8);  // ties among cells of which some are huge
  points.insert(points.end(), dense.begin(), dense.end());
  expect_equal_to_cgal(points);
}

TEST(Kernel3d, EqualsCgalOnLatticesOfManySizes) {
  // From all ties noted in the spheres to none, and with determinants beyond what doubles hold.
  for (const int step : {1, 20, 300, 5'000, 200'000}) {
    SCOPED_TRACE(step);
    Points points = random_integers(1'000, 9, 9);
    for (Point<3>& p : points) {
      for (double& c : p) c *= step;
    }
    points.push_back({1, 0, 0});  // or the lattice would be made unit
    expect_equal_to_cgal(points);
  }
}

TEST(Kernel3d, EqualsCgalOnLatticesThatAreNotIntegers) {
  expect_equal_to_cgal(scaled(random_integers(2'000, 20, 20), -2));
  Points decimals = random_integers(1'000, 12, 12);
  for (Point<3>& p : decimals) p = {500'000 + p[0] * 0.01, 4'000'000 + p[1] * 0.01, p[2] * 0.01};
  expect_equal_to_cgal(decimals);
}

TEST(Kernel3d, EqualsCgalOnVerySmallBesideVeryLarge) {
  Points points = scaled(random_integers(50, 4, 4), -1074);
  const Points large = scaled(random_integers(50, 4, 4), 1000);
  points.insert(points.end(), large.begin(), large.end());
  points.push_back({0.25, 1e-200, 1e100});
  expect_equal_to_cgal(points);
}

TEST(Kernel3d, KeepsTheDuplicateOfLowestInputIndex) {
  Points points = random_integers(300, 4, 4);
  std::vector<VertexId> index = indices(points.size());
  std::reverse(index.begin(), index.end());
  const BaseCase<3> result = triangulate_base_case<3>({.points = points, .input_index = index});
  ASSERT_GT(result.duplicates.size(), 200U);
  for (const DroppedDuplicate& d : result.duplicates) {
    EXPECT_EQ(points[d.dropped], points[d.kept]);
    EXPECT_GT(index[d.dropped], index[d.kept]);
  }
  EXPECT_TRUE(std::is_sorted(result.duplicates.begin(), result.duplicates.end()));
}

TEST(Kernel3d, GivesTheSameSimplicesInTheSameOrderEveryTime) {
  const Points points = generated_points<3>({.family = Family::kTerrain, .count = 3'000});
  const std::vector<VertexId> index = indices(points.size());
  const auto run = [&] {
    return triangulate_base_case<3>({.points = points, .input_index = index});
  };
  const BaseCase<3> first = run();
  triangulate_base_case<3>({.points = std::span(points).first(70), .input_index = index});
  const BaseCase<3> second = run();  // in memory that others have used
  ASSERT_EQ(first.simplices.size(), second.simplices.size());
  for (std::size_t i = 0; i < first.simplices.size(); ++i) {
    ASSERT_EQ(first.simplices[i].vertices, second.simplices[i].vertices);
    ASSERT_EQ(first.simplices[i].neighbours, second.simplices[i].neighbours);
  }
  EXPECT_EQ(first.hull, second.hull);
}

TEST(Kernel3d, MakesWayForCgalWhenAsked) {
  const Points points = random_integers(600, 8, 8);
  const std::vector<VertexId> index = indices(points.size());
  const BaseCaseInput<3> input{.points = points, .input_index = index};
  const BaseCase<3> own = triangulate_base_case<3>(input);
  BaseCaseInput<3> with_cgal = input;
  with_cgal.kernel = Kernel::kCgal;
  const BaseCase<3> cgal = triangulate_base_case<3>(with_cgal);
  EXPECT_EQ(own.simplices.size(), cgal.simplices.size());
  EXPECT_EQ(own.hull.size(), cgal.hull.size());
  EXPECT_EQ(own.duplicates, cgal.duplicates);
}

TEST(Kernel3d, RefusesMorePointsThanItCanNumber) {
  const Points few{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<VertexId> basis{0, 1, 2, 3};
  const BaseCaseInput<3> input{.points = std::span(few.data(), std::size_t{1} << 28),
                               .input_index = basis};
  EXPECT_THROW(kernel_3d_base_case(input, basis), Failure);
}

}  // namespace
}  // namespace spillway::test
