// The five distributions of the paper, by their moments and shapes, and the numbers beneath them.

#include <cmath>

#include <gtest/gtest.h>

#include "src/generators/generators.h"
#include "src/generators/random.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kCount = 40000;

struct Moments {
  double mean, deviation;
};

template <typename P>
Moments moments(const std::vector<P>& points, int axis) {
  double sum = 0;
  double squares = 0;
  for (const P& p : points) {
    sum += p[axis];
    squares += p[axis] * p[axis];
  }
  const auto n = static_cast<double>(points.size());
  const double mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean)};
}

template <int D>
std::vector<Point<D>> points_of(Family family) {
  return generated_points<D>({family, kCount, D, 42});
}

template <typename Dimension>
class DistributionTest : public ::testing::Test {};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DistributionTest, Dimensions);

TYPED_TEST(DistributionTest, UniformFillsTheUnitCube) {
  const auto points = points_of<TypeParam::value>(Family::kUniform);
  for (int k = 0; k < TypeParam::value; ++k) {
    const auto [mean, deviation] = moments(points, k);
    EXPECT_NEAR(mean, 0.5, 0.01);
    EXPECT_NEAR(deviation, std::sqrt(1 / 12.0), 0.01);
    for (const auto& p : points) EXPECT_TRUE(p[k] >= 0 && p[k] < 1);
  }
}

TYPED_TEST(DistributionTest, NormalHasItsMeanInTheMiddleAndTheSideForDeviation) {
  const auto points = points_of<TypeParam::value>(Family::kNormal);
  for (int k = 0; k < TypeParam::value; ++k) {
    const auto [mean, deviation] = moments(points, k);
    EXPECT_NEAR(mean, 0.5, 0.03);
    EXPECT_NEAR(deviation, 1, 0.03);
    std::size_t within = 0;  // one deviation of the mean
    for (const auto& p : points) within += std::abs(p[k] - 0.5) < 1 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(within) / kCount, 0.6827, 0.01);
  }
}

TYPED_TEST(DistributionTest, BubblesAreNormalAroundTheCentreOfEachOrthant) {
  const auto points = points_of<TypeParam::value>(Family::kBubbles);
  constexpr std::size_t kBubbles = std::size_t{1} << TypeParam::value;
  for (std::size_t bubble = 0; bubble < kBubbles; ++bubble) {
    std::vector<Point<TypeParam::value>> members;
    for (std::size_t i = bubble; i < points.size(); i += kBubbles) members.push_back(points[i]);
    for (int k = 0; k < TypeParam::value; ++k) {
      const auto [mean, deviation] = moments(members, k);
      EXPECT_NEAR(mean, (bubble >> k & 1) != 0 ? 0.75 : 0.25, 0.03);
      EXPECT_NEAR(deviation, 0.5, 0.03);
    }
  }
}

TYPED_TEST(DistributionTest, EllipsoidPointsLieOnItAndAllAroundIt) {
  constexpr std::array<double, 3> kHalfAxes = {0.45, 0.30, 0.15};
  const auto points = points_of<TypeParam::value>(Family::kEllipsoid);
  for (const auto& p : points) {
    double sum = 0;
    for (int k = 0; k < TypeParam::value; ++k) {
      const double q = (p[k] - 0.5) / kHalfAxes[k];
      sum += q * q;
    }
    EXPECT_NEAR(sum, 1, 1e-14);
  }
  for (int k = 0; k < TypeParam::value; ++k) {
    const auto [mean, deviation] = moments(points, k);
    EXPECT_NEAR(mean, 0.5, 0.01);
    // Uniform on the unit sphere before it is stretched.
    EXPECT_NEAR(deviation, kHalfAxes[k] / std::sqrt(TypeParam::value), 0.01 * kHalfAxes[k]);
  }
}

TYPED_TEST(DistributionTest, LinesAreTwoAndEquallyPopulated) {
  const auto points = points_of<TypeParam::value>(Family::kLines);
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    EXPECT_DOUBLE_EQ(points[i][1], 0.1 + 0.9 * points[i][0]);
    EXPECT_EQ(points[i + 1][0] + points[i + 1][1], 1);
    if constexpr (TypeParam::value == 3) {
      EXPECT_EQ(points[i][2], points[i][0]);
      EXPECT_EQ(points[i + 1][2], points[i + 1][1]);
    }
  }
  EXPECT_NEAR(moments(points, 0).mean, 0.5, 0.01);
}

TEST(RandomNumbers, AreThePublishedSplitMix64) {
  // Its first two outputs from the state 1234567.
  constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  EXPECT_EQ(mix_bits(1234567 + kStep), 6457827717110365317ULL);
  EXPECT_EQ(mix_bits(1234567 + 2 * kStep), 3203168211198807973ULL);
}

TEST(RandomNumbers, CounterSkipsDraws) {
  Random random(7);
  Random later(7, 2);
  random.bits();
  random.bits();
  EXPECT_EQ(random.bits(), later.bits());
  EXPECT_NE(Random(7).bits(), Random(8).bits());
}

TEST(RandomNumbers, LogarithmAgreesWithTheLibrary) {
  for (const double x : {1.0, 0.5, 0.75, 0.7071, 0.7072, 1e-300, 1e300, 3.0, 0x1p-53, 0x1.fffp-1}) {
    EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * (1 + std::abs(std::log(x))));
  }
  Random random(5);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform() + 1e-9;
    EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * (1 + std::abs(std::log(x))));
  }
}

TEST(RandomNumbers, BelowStaysBelowAndReachesAll) {
  Random random(9);
  std::array<int, 7> hits{};
  for (int i = 0; i < 7000; ++i) ++hits.at(random.below(7));
  for (const int h : hits) EXPECT_NEAR(h, 1000, 150);
}

}  // namespace
}  // namespace spillway::test
