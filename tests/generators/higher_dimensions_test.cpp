// The families in four to six dimensions: the same bits everywhere, in any blocks, and what
// docs/generators.md says of them.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "src/error.h"
#include "src/generators/generators.h"
#include "src/generators/random.h"

namespace spillway::test {
namespace {

const std::vector<Family> kHigherFamilies = {
    Family::kUniform, Family::kNormal,   Family::kBubbles,    Family::kEllipsoid,
    Family::kLines,   Family::kLattice,  Family::kCircle,     Family::kClusters,
    Family::kUtm,     Family::kCoplanar, Family::kDuplicates, Family::kCollinear};

template <int D>
std::vector<Point<D>> some(Family family, std::uint64_t count = 1000) {
  return generated_points<D>({.family = family, .count = count, .seed = 5});
}

TEST(HigherFamilies, AreTheSameInBlocksOfAnySize) {
  for (const Family family : kHigherFamilies) {
    const auto generator = make_generator({family, 1000, 5, 5});
    const std::vector<Point<5>> all = some<5>(family);
    std::array<Point<3>, 7> block;
    std::size_t next = 0;
    while (const std::size_t n = generator->next(block)) {
      ASSERT_EQ(generator->further().size(), 2 * n);
      for (std::size_t i = 0; i < n; ++i, ++next) {
        const Point<5> point = {block[i][0], block[i][1], block[i][2], generator->further()[2 * i],
                                generator->further()[2 * i + 1]};
        ASSERT_EQ(point, all[next]);
      }
    }
    EXPECT_EQ(next, all.size());
    EXPECT_EQ(generator->lattice(), nullptr);
  }
}

TEST(HigherFamilies, HaveTheFirstCoordinatesOfUniformPointsInSpace) {
  const auto space = some<3>(Family::kUniform);
  const auto six = some<6>(Family::kUniform);
  for (std::size_t i = 0; i < space.size(); ++i) {
    EXPECT_EQ(space[i], (Point<3>{six[i][0], six[i][1], six[i][2]}));
  }
}

TEST(HigherFamilies, FillTheSmallestCubeOfTheLattice) {
  const auto points = some<4>(Family::kLattice, 81);
  EXPECT_EQ(std::set<Point<4>>(points.begin(), points.end()).size(), 81U);
  EXPECT_EQ(points[80], (Point<4>{2, 2, 2, 2}));
}

/// Sums of squares, in integers of 128 bits.
template <int D>
void expect_exact_sphere() {
  using Wide = unsigned __int128;
  const auto norm = [](const Point<D>& p) {
    Wide sum = 0;
    for (const double x : p) sum += static_cast<Wide>(std::abs(x)) * static_cast<Wide>(std::abs(x));
    return sum;
  };
  const auto points = some<D>(Family::kCircle, 4000);
  const double radius = std::sqrt(static_cast<double>(norm(points[0])));
  EXPECT_LT(radius, 0x1p53);
  std::set<Point<D>> exact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 2 == 0) {
      ASSERT_TRUE(norm(points[i]) == norm(points[0]));
      for (const double x : points[i]) ASSERT_EQ(x, std::nearbyint(x));
      exact.insert(points[i]);
    } else {
      double square = 0;
      for (const double x : points[i]) square += x / radius * (x / radius);
      ASSERT_NEAR(square, 1, 1e-14);
    }
  }
  EXPECT_GT(exact.size(), 1900U);
}

TEST(HigherFamilies, HaveEveryOtherPointOfTheCircleExactlyOnIt) {
  expect_exact_sphere<4>();
  expect_exact_sphere<5>();
  expect_exact_sphere<6>();
}

TEST(HigherFamilies, AreInOneHyperplaneOrOnOneLineWhereTheyAreToBe) {
  for (const Point<6>& p : some<6>(Family::kCoplanar)) {
    EXPECT_EQ(p[5], 2 * p[0] - 3 * p[1] + p[2] + p[3] + p[4] + 7);
  }
  for (const Point<5>& p : some<5>(Family::kCollinear)) {
    EXPECT_EQ(p, (Point<5>{p[0], -2 * p[0] / 3, 5 * p[0] / 3, -7 * p[0] / 3, 11 * p[0] / 3}));
  }
}

TEST(HigherFamilies, AreNoneOfPlaneAndSpaceAlone) {
  for (const Family family : {Family::kTerrain, Family::kPacking, Family::kScan}) {
    EXPECT_THROW(make_generator({family, 10, 4, 1}), InvalidArgument);
  }
}

template <int D>
std::uint64_t fingerprint_of_all() {
  std::uint64_t bits = 0;
  for (const Family family : kHigherFamilies) {
    for (const Point<D>& point : some<D>(family)) {
      for (const double x : point) bits = mix_bits(bits + std::bit_cast<std::uint64_t>(x));
    }
  }
  return bits;
}

TEST(HigherFamilies, HaveTheSameBitsOnEveryMachine) {
  EXPECT_EQ(fingerprint_of_all<4>(), 17189528425659629377U);
  EXPECT_EQ(fingerprint_of_all<5>(), 4012828615400418874U);
  EXPECT_EQ(fingerprint_of_all<6>(), 2911550774031949324U);
}

}  // namespace
}  // namespace spillway::test
