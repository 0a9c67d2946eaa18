// The terrain family looks like a flight over a landscape.

#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>

#include "src/error.h"
#include "src/generators/generators.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kCount = 400000;

const std::vector<Point<3>>& sample() {
  static const auto points = generated_points<3>({Family::kTerrain, kCount, 3, 7});
  return points;
}

/// Points in each square of `metres`, by its column and row.
std::map<std::pair<int, int>, int> counts_in_squares(double metres) {
  std::map<std::pair<int, int>, int> counts;
  for (const Point<3>& p : sample()) {
    ++counts[{static_cast<int>(p[0] / (100 * metres)), static_cast<int>(p[1] / (100 * metres))}];
  }
  return counts;
}

TEST(Terrain, IsInCentimetresAtUtmOffsets) {
  const auto generator = make_generator({Family::kTerrain, 10, 2, 1});
  ASSERT_NE(generator->lattice(), nullptr);
  EXPECT_EQ(*generator->lattice(), (IntegerLattice{{0.01, 0.01, 0.01}, {500000, 4100000, 0}}));
}

TEST(Terrain, HasPositiveCoordinatesOfOneArea) {
  for (const Point<3>& p : sample()) {
    EXPECT_TRUE(p[0] > 0 && p[0] < 60000);
    EXPECT_TRUE(p[1] > 0 && p[1] < 60000);
    EXPECT_TRUE(p[2] > 0 && p[2] < 100000);
  }
}

TEST(Terrain, IsTheSameForEitherDimension) {
  const auto flat = generated_points<2>({Family::kTerrain, 1000, 2, 7});
  const auto full = generated_points<3>({Family::kTerrain, 1000, 3, 7});
  for (std::size_t i = 0; i < flat.size(); ++i) {
    EXPECT_EQ(flat[i], (Point<2>{full[i][0], full[i][1]}));
  }
}

TEST(Terrain, AFewPerCentOfThePointsRepeatAnXy) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto points = generated_points<3>({Family::kTerrain, 100000, 3, seed});
    std::sort(points.begin(), points.end());
    std::size_t repeated = 0;
    std::size_t same_z = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i][0] != points[i - 1][0] || points[i][1] != points[i - 1][1]) continue;
      ++repeated;
      same_z += points[i][2] == points[i - 1][2] ? 1 : 0;
    }
    const auto n = static_cast<double>(points.size());
    EXPECT_GT(static_cast<double>(repeated) / n, 0.01);
    EXPECT_LT(static_cast<double>(repeated) / n, 0.06);
    EXPECT_GT(same_z, repeated / 10);
    EXPECT_LT(same_z, repeated * 9 / 10);
  }
}

TEST(Terrain, ComesInScanOrder) {
  // Neighbours in the stream are neighbours on the ground, but for gaps and new flight lines.
  const auto& points = sample();
  const double spacing = 100 * std::sqrt(300.0 * 300 / static_cast<double>(kCount));
  std::size_t near = 0;
  std::size_t northwards = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double dx = points[i][0] - points[i - 1][0];
    const double dy = points[i][1] - points[i - 1][1];
    near += std::hypot(dx, dy) < 4 * spacing ? 1 : 0;
    if (i > 1000) northwards += points[i][1] > points[i - 1000][1] ? 1 : 0;
  }
  const auto n = static_cast<double>(points.size());
  EXPECT_GT(static_cast<double>(near) / n, 0.99);
  // Two lines of three lead north.
  EXPECT_NEAR(static_cast<double>(northwards) / n, 2.0 / 3, 0.1);
}

TEST(Terrain, DensityVariesAndDoublesWhereLinesOverlap) {
  std::vector<int> densities;
  for (const auto& [square, count] : counts_in_squares(10)) densities.push_back(count);
  std::sort(densities.begin(), densities.end());
  const int sparse = densities[densities.size() / 5];
  const int dense = densities[densities.size() * 9 / 10];
  EXPECT_GT(dense, 3 * sparse / 2);
}

TEST(Terrain, HasGapsOverWater) {
  const auto counts = counts_in_squares(5);
  int empty = 0;
  int inner = 0;
  for (int column = 16; column < 68; ++column) {  // well inside the area
    for (int row = 16; row < 68; ++row) {
      ++inner;
      const auto found = counts.find({column, row});
      empty += found == counts.end() || found->second < 20 ? 1 : 0;
    }
  }
  EXPECT_GT(empty, inner / 100);
  EXPECT_LT(empty, inner / 3);
}

TEST(Terrain, HasWallsAndCrownsAboveSmoothGround) {
  // Within a square of two metres the ground hardly rises; roofs and trees do.
  std::map<std::pair<int, int>, std::pair<double, double>> ranges;
  for (const Point<3>& p : sample()) {
    const std::pair square(static_cast<int>(p[0] / 200), static_cast<int>(p[1] / 200));
    const auto [at, fresh] = ranges.try_emplace(square, p[2], p[2]);
    if (fresh) continue;
    at->second.first = std::min(at->second.first, p[2]);
    at->second.second = std::max(at->second.second, p[2]);
  }
  std::size_t steep = 0;
  for (const auto& [square, range] : ranges) steep += range.second - range.first > 300 ? 1 : 0;
  EXPECT_GT(steep, ranges.size() / 50);
  EXPECT_LT(steep, ranges.size() / 2);
}

TEST(Terrain, GrowsWithItsNumberOfPointsAtSomeSixASquareMetre) {
  // The first flight line of a hundred million points.
  const auto generator = make_generator({Family::kTerrain, 100000000, 3, 7});
  std::vector<Point<3>> points(50000);
  ASSERT_EQ(generator->next(points), points.size());
  const auto [low, high] = std::minmax_element(points.begin(), points.end());
  const auto by_y = [](const Point<3>& a, const Point<3>& b) { return a[1] < b[1]; };
  const auto [south, north] = std::minmax_element(points.begin(), points.end(), by_y);
  const double area = ((*high)[0] - (*low)[0]) * ((*north)[1] - (*south)[1]) / 1e4;
  EXPECT_NEAR(static_cast<double>(points.size()) / area, 5, 2);
}

TEST(Terrain, HugeOnesStayWithinThirtyTwoBitsOrAreRefused) {
  const auto generator = make_generator({Family::kTerrain, 1000000000000000, 3, 7});
  std::vector<Point<3>> points(1000);
  ASSERT_EQ(generator->next(points), points.size());
  try {
    make_generator({Family::kTerrain, 10000000000000000, 3, 7});
    FAIL();
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), HasSubstr("10000000000000000 points"));
    EXPECT_THAT(error.what(), HasSubstr("at most 10^15"));
  }
}

}  // namespace
}  // namespace spillway::test
