// The packing: as dense as atoms of a glass, everywhere, and without order at close range.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "src/generators/generators.h"
#include "src/generators/shuffle.h"

namespace spillway::test {
namespace {

constexpr double kSmallRadius = 1.28;
constexpr double kSpacing = 2.85;
constexpr std::uint64_t kCount = 40000;

template <int D>
double distance(const Point<D>& a, const Point<D>& b) {
  double squares = 0;
  for (int k = 0; k < D; ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squares);
}

/// Distances of all pairs that are less than `most` apart, each once.
template <int D>
std::vector<double> near_distances(const std::vector<Point<D>>& points, double most) {
  std::map<std::array<int, D>, std::vector<Point<D>>> earlier;
  std::vector<double> distances;
  for (const Point<D>& p : points) {
    std::array<int, D> home;
    for (int k = 0; k < D; ++k) home[k] = static_cast<int>(std::floor(p[k] / most));
    const int around = D == 2 ? 9 : 27;
    for (int number = 0; number < around; ++number) {
      std::array<int, D> cell = home;
      for (int k = 0, rest = number; k < D; ++k, rest /= 3) cell[k] += rest % 3 - 1;
      const auto found = earlier.find(cell);
      if (found == earlier.end()) continue;
      for (const Point<D>& q : found->second) {
        if (const double d = distance<D>(p, q); d < most) distances.push_back(d);
      }
    }
    earlier[home].push_back(p);
  }
  return distances;
}

template <int D>
std::vector<Point<D>> packing(std::uint64_t count, std::uint64_t seed = 1) {
  return generated_points<D>({Family::kPacking, count, D, seed});
}

template <typename Dimension>
class PackingTest : public ::testing::Test {
 protected:
  static constexpr int kDimension = Dimension::value;
};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PackingTest, Dimensions);

TYPED_TEST(PackingTest, NoTwoCentresAreCloserThanFourFifthsOfTwoSmallRadii) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto points = packing<TestFixture::kDimension>(kCount, seed);
    EXPECT_TRUE(near_distances<TestFixture::kDimension>(points, 0.8 * 2 * kSmallRadius).empty());
  }
}

TYPED_TEST(PackingTest, NeighboursLieAtAllDistancesAroundTheSpacing) {
  const auto distances = near_distances<TestFixture::kDimension>(
      packing<TestFixture::kDimension>(kCount), kSpacing * std::sqrt(1.5));
  double sum = 0;
  double squares = 0;
  for (const double d : distances) {
    sum += d;
    squares += d * d;
  }
  const auto n = static_cast<double>(distances.size());
  const double deviation = std::sqrt(squares / n - sum / n * (sum / n));
  EXPECT_NEAR(sum / n, kSpacing, 0.02 * kSpacing);
  EXPECT_GT(deviation, 0.04 * kSpacing);
  EXPECT_LT(deviation, 0.10 * kSpacing);
  EXPECT_EQ(std::set(distances.begin(), distances.end()).size(), distances.size());
}

TYPED_TEST(PackingTest, AnyNumberOfPointsFillsACubeAndIsAsDense) {
  constexpr int kD = TestFixture::kDimension;
  const double room = kD == 2 ? std::sqrt(0.75) * kSpacing * kSpacing
                              : std::sqrt(0.5) * kSpacing * kSpacing * kSpacing;
  for (const std::uint64_t count : {20000, 27001, 32768}) {
    const double side = std::pow(static_cast<double>(count) * room, 1.0 / kD);
    const auto points = packing<kD>(count);
    for (int k = 0; k < kD; ++k) {
      const auto [least, most] = std::minmax_element(
          points.begin(), points.end(), [k](const auto& a, const auto& b) { return a[k] < b[k]; });
      EXPECT_NEAR((*most)[k] - (*least)[k], side, 0.1 * side) << count << " along " << k;
      const double middle = ((*least)[k] + (*most)[k]) / 2;
      const auto below =
          std::count_if(points.begin(), points.end(), [&](const auto& p) { return p[k] < middle; });
      EXPECT_NEAR(static_cast<double>(below), count / 2.0, 0.04 * static_cast<double>(count));
    }
  }
}

TYPED_TEST(PackingTest, TheOrderOfPointsTellsNothingOfTheirPlaces) {
  const auto points = packing<TestFixture::kDimension>(kCount);
  double side = 0;
  for (const auto& p : points) side = std::max(side, p[0]);
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += distance<TestFixture::kDimension>(points[i - 1], points[i]);
  }
  // Of two uniform points of a unit square or cube.
  const double expected = TestFixture::kDimension == 2 ? 0.521 : 0.662;
  EXPECT_NEAR(sum / static_cast<double>(points.size()) / side, expected, 0.03);
}

TEST(Packing, EachSiteOfAWholeCubeHasOneSphere) {
  constexpr double kStep = kSpacing * 0.70710678118654752;
  constexpr int kSide = 12;
  std::set<std::array<int, 3>> sites;
  for (const Point<3>& p : packing<3>(kSide * kSide * kSide / 2)) {
    // The nearest site is the one that the centre has left: it moves by less than half the spacing.
    std::array<int, 3> best{};
    double least = kSpacing / 2;
    for (int x = 0; x < kSide; ++x) {
      for (int y = 0; y < kSide; ++y) {
        for (int z = (x + y) % 2; z < kSide; z += 2) {
          const double d = distance<3>(p, {kStep * x, kStep * y, kStep * z});
          if (d < least) {
            least = d;
            best = {x, y, z};
          }
        }
      }
    }
    sites.insert(best);
    EXPECT_LT(least, 0.4);
  }
  EXPECT_EQ(sites.size(), kSide * kSide * kSide / 2U);
}

TEST(Shuffle, IsAPermutationOfAnyNumber) {
  for (std::uint64_t count = 1; count < 300; ++count) {
    const Shuffle shuffle(7, count);
    std::set<std::uint64_t> places;
    for (std::uint64_t i = 0; i < count; ++i) places.insert(shuffle(i));
    EXPECT_EQ(places.size(), count);
    EXPECT_LT(*places.rbegin(), count);
  }
}

TEST(Shuffle, TakesNumbersOf63Bits) {
  const std::uint64_t count = (std::uint64_t{1} << 63) + 5;
  const Shuffle shuffle(7, count);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_LT(shuffle(count - 1 - i), count);
}

}  // namespace
}  // namespace spillway::test
