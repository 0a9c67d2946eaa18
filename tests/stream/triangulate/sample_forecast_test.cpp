#include "stream/triangulate/sample_forecast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "stream/triangulate/border.h"

namespace spillway::test {
namespace {

std::vector<Point<3>> even_points(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<3>> points(count);
  for (Point<3>& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

/// Each edge of one line makes a tetrahedron with each of the other.
std::vector<Point<3>> skew_lines(std::size_t count) {
  std::vector<Point<3>> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<double>(i / 2);
    points[i] = i % 2 == 0 ? Point<3>{t, 0, 0} : Point<3>{0, t, 1};
  }
  std::shuffle(points.begin(), points.end(), std::mt19937_64(2));
  return points;
}

template <int D>
double bytes_a_point(const SampleForecast<D>& sample, double points) {
  return sample.forecast().bytes_for(points) / points;
}

TEST(SampleForecast, OfEvenPointsStaysNearlyInProportion) {
  SampleForecast<3> sample;
  sample.note(even_points(5000));
  EXPECT_LT(bytes_a_point(sample, 1e6), 10 * bytes_a_point(sample, 1e3));
}

TEST(SampleForecast, OfSkewLinesGrowsWithTheSquare) {
  SampleForecast<3> sample;
  sample.note(skew_lines(5000));
  const WorkForecast forecast = sample.forecast();
  EXPECT_GT(forecast.exponent, 1.9);
  EXPECT_GT(forecast.bytes, 128 * 127 / 4 * 80 / 2) << "of the sample itself";
  EXPECT_GT(bytes_a_point(sample, 1e6), 300 * bytes_a_point(sample, 1e3));
}

TEST(SampleForecast, IsThatOfTheLargestTileWheneverItCame) {
  SampleForecast<3> first, last;
  first.note(skew_lines(3000));
  first.note(even_points(2999));
  last.note(even_points(2999));
  last.note(skew_lines(3000));
  EXPECT_EQ(first.forecast().bytes, last.forecast().bytes);
  EXPECT_GT(last.forecast().exponent, 1.9);
}

TEST(SampleForecast, OfFewPointsTakesThemAll) {
  SampleForecast<2> sample;
  sample.note(std::vector<Point<2>>{{0, 0}, {1, 0}, {0, 1}});
  EXPECT_EQ(sample.forecast().points, 3);
  EXPECT_EQ(sample.forecast().bytes, 4 * 80) << "three of the simplices are infinite";
}

TEST(SampleForecast, OfNothingIsNothing) {
  const SampleForecast<3> sample;
  EXPECT_EQ(sample.forecast().bytes_for(1e6), 0);
  EXPECT_LT(enough_for<3>(sample.forecast(), 1000), 1'000'000U) << "no limit beyond all measure";
}

}  // namespace
}  // namespace spillway::test
