// The families made to break general position do break it, exactly.

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "src/generators/generators.h"

namespace spillway::test {
namespace {

using Wide = __int128;

Wide square(double x) { return static_cast<Wide>(x) * static_cast<Wide>(x); }

/// Squared norm of a point whose coordinates are integers.
Wide squared_norm(const Point<3>& p) { return square(p[0]) + square(p[1]) + square(p[2]); }

template <typename P>
std::size_t distinct(const std::vector<P>& points) {
  return std::set(points.begin(), points.end()).size();
}

TEST(IntegerLattice, FillsANearSquareRowByRow) {
  const auto points = generated_points<2>({Family::kLattice, 10, 2, 1});
  const std::vector<Point<2>> expected = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1},
                                          {1, 1}, {2, 1}, {3, 1}, {0, 2}, {1, 2}};
  EXPECT_EQ(points, expected);
}

TEST(IntegerLattice, FillsANearCubeLayerByLayer) {
  const auto points = generated_points<3>({Family::kLattice, 1000, 3, 1});
  EXPECT_EQ(distinct(points), 1000U);
  EXPECT_EQ(points[999], (Point<3>{9, 9, 9}));
  EXPECT_EQ(points[100], (Point<3>{0, 0, 1}));
}

TEST(IntegerLattice, HasTheUnitLattice) {
  const auto generator = make_generator({Family::kLattice, 10, 2, 1});
  ASSERT_NE(generator->lattice(), nullptr);
  EXPECT_EQ(*generator->lattice(), IntegerLattice{});
}

TEST(Circle, EveryOtherPointIsExactlyOnIt) {
  for (const std::uint64_t count : {10, 1000, 100000}) {
    const auto points = generated_points<2>({Family::kCircle, count, 2, 3});
    const Wide squared_radius = squared_norm({points[0][0], points[0][1], 0});
    const double radius = std::sqrt(static_cast<double>(squared_radius));
    std::set<Point<2>> exact;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [x, y] = points[i];
      if (i % 2 == 0) {
        EXPECT_EQ(x, std::nearbyint(x));
        EXPECT_TRUE(squared_norm({x, y, 0}) == squared_radius);
        exact.insert(points[i]);
      } else {
        EXPECT_NEAR(std::hypot(x, y) / radius, 1, 1e-15);
      }
    }
    EXPECT_EQ(exact.size(), (count + 1) / 2) << "exact points repeat";
  }
}

TEST(Circle, RunsOutOfExactPointsOnlyFarBeyondOtherTests) {
  constexpr std::size_t kExactPoints = 236196;  // 4 * 3^10
  const auto points = generated_points<2>({Family::kCircle, 2 * kExactPoints + 100, 2, 3});
  std::set<Point<2>> exact;
  for (std::size_t i = 0; i < 2 * kExactPoints; i += 2) exact.insert(points[i]);
  EXPECT_EQ(exact.size(), kExactPoints);
}

TEST(Circle, OnASphereInThreeDimensions) {
  const auto points = generated_points<3>({Family::kCircle, 20000, 3, 3});
  const Wide squared_radius = squared_norm(points[0]);
  const double radius = std::sqrt(static_cast<double>(squared_radius));
  std::set<Point<3>> exact;
  Point<3> sum{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<3>& p = points[i];
    for (int k = 0; k < 3; ++k) sum[k] += p[k] / radius / static_cast<double>(points.size());
    if (i % 2 == 0) {
      EXPECT_TRUE(squared_norm(p) == squared_radius);
      exact.insert(p);
    } else {
      EXPECT_NEAR(std::hypot(p[0], p[1], p[2]) / radius, 1, 1e-15);
    }
  }
  EXPECT_GT(exact.size(), 9900U);  // but for the pole, which repeats
  for (const double s : sum) EXPECT_NEAR(s, 0, 0.03);
}

TEST(Clusters, AreSixteenTightOnesFarApart) {
  const auto points = generated_points<3>({Family::kClusters, 1600, 3, 3});
  for (std::size_t i = 16; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(points[i][k] - points[i % 16][k]), 1);
  }
  for (std::size_t i = 1; i < 16; ++i) {
    double distance = 0;
    for (int k = 0; k < 3; ++k) distance += std::abs(points[i][k] - points[0][k]);
    EXPECT_GT(distance, 1000);
  }
}

TEST(Duplicates, AreAboutARootOfNDistinctPoints) {
  EXPECT_EQ(distinct(generated_points<2>({Family::kDuplicates, 10000, 2, 3})), 100U);
  EXPECT_EQ(distinct(generated_points<3>({Family::kDuplicates, 10000, 3, 3})), 100U);
}

TEST(Collinear, LiesExactlyOnALine) {
  for (const auto& p : generated_points<2>({Family::kCollinear, 1000, 2, 3})) {
    EXPECT_EQ(2 * p[0] + 3 * p[1], 0);
  }
  const auto points = generated_points<3>({Family::kCollinear, 1000, 3, 3});
  for (const auto& p : points) {
    EXPECT_EQ(2 * p[0] + 3 * p[1], 0);
    EXPECT_EQ(5 * p[0] - 3 * p[2], 0);
  }
  EXPECT_GT(distinct(points), 990U);
}

TEST(Coplanar, LiesExactlyOnAnObliquePlane) {
  for (const auto& p : generated_points<3>({Family::kCoplanar, 1000, 3, 3})) {
    EXPECT_EQ(2 * p[0] - 3 * p[1] + 7 - p[2], 0);
  }
}

TEST(Utm, IsFarFromTheOrigin) {
  for (const auto& p : generated_points<3>({Family::kUtm, 1000, 3, 3})) {
    EXPECT_TRUE(p[0] >= 500000 && p[0] <= 501000);
    EXPECT_TRUE(p[1] >= 4100000 && p[1] <= 4101000);
    EXPECT_TRUE(p[2] >= 0 && p[2] <= 200);
  }
}

}  // namespace
}  // namespace spillway::test
