// Figures of ascending heights against plain evaluation in long double.

#include "src/terrain/height_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

HeightStatistics statistics_of(std::vector<double> heights) {
  std::ranges::sort(heights);
  HeightStatistics statistics;
  for (const double z : heights) statistics.add(z);
  return statistics;
}

TEST(HeightStatistics, AreThoseOfPlainEvaluation) {
  std::mt19937 random(5);
  for (const double base : {0.0, 8848.86, -1e7}) {
    for (const std::size_t count : {1U, 2U, 7U, 5000U}) {
      std::vector<double> heights(count);
      for (double& z : heights) z = base + std::uniform_real_distribution<double>(-3, 3)(random);
      long double sum = 0;
      for (const double z : heights) sum += z;
      const long double mean = sum / static_cast<long double>(count);
      long double squares = 0;
      for (const double z : heights) squares += (z - mean) * (z - mean);
      const HeightStatistics found = statistics_of(heights);
      EXPECT_EQ(found.count(), count);
      EXPECT_EQ(found.lowest(), std::ranges::min(heights));
      EXPECT_EQ(found.highest(), std::ranges::max(heights));
      EXPECT_NEAR(found.mean(), static_cast<double>(mean), 1e-15 + 2e-16 * std::abs(base));
      EXPECT_NEAR(found.deviation(),
                  static_cast<double>(std::sqrt(squares / static_cast<long double>(count))), 1e-12);
    }
  }
}

/// The difference of the sums of squares would have no digit left.
TEST(HeightStatistics, ASmallDeviationFarFromZeroKeepsItsDigits) {
  const HeightStatistics found = statistics_of({1e9, 1e9, 1e9 + 1e-3, 1e9 + 1e-3});
  const double step = (1e9 + 1e-3) - 1e9;
  EXPECT_NEAR(found.deviation(), step / 2, 1e-15);
}

TEST(HeightStatistics, EqualHeightsHaveNoDeviation) {
  EXPECT_EQ(statistics_of(std::vector<double>(1000, 0.1)).deviation(), 0);
  EXPECT_EQ(statistics_of({0.1}).deviation(), 0);
}

TEST(PercentilePlace, IsThatOfDefinition7) {
  // 1, 2, ..., 11: the tenths are the numbers themselves.
  for (int tenth = 0; tenth <= 10; ++tenth) {
    const PercentilePlace place(tenth * 10.0, 11);
    EXPECT_NEAR(static_cast<double>(place.rank) + place.share, tenth, 1e-12);
  }
  EXPECT_EQ(PercentilePlace(50, 2).rank, 0U);
  EXPECT_EQ(PercentilePlace(50, 2).share, 0.5);
  EXPECT_EQ(PercentilePlace(100, 7).rank, 6U);
  EXPECT_EQ(PercentilePlace(100, 7).share, 0);
  EXPECT_EQ(PercentilePlace(37, 1).rank, 0U);
  EXPECT_EQ(PercentilePlace(37, 1).share, 0);
}

}  // namespace
}  // namespace spillway::test
