#include "src/runtime/work_forecast.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

/// Of samples of 1,000 and 4,000 points, where so many simplices take a byte each.
WorkForecast by_samples(std::size_t smaller, std::size_t larger) {
  return WorkForecast::of({1'000, smaller}, {4'000, larger}, 3, 1);
}

TEST(WorkForecast, GrowsAsTheSamplesDoAndALittleFaster) {
  const WorkForecast linear = by_samples(6'000, 24'000);
  EXPECT_NEAR(linear.exponent, 1.1, 1e-9) << "the hull makes the smaller one seem larger";
  EXPECT_DOUBLE_EQ(linear.bytes_for(4'000), 24'000);
  EXPECT_GT(linear.bytes_for(40'000), 240'000);
  EXPECT_LT(linear.bytes_for(40'000), 400'000);
  EXPECT_NEAR(by_samples(6'000, 48'000).exponent, 1.6, 1e-9);
}

TEST(WorkForecast, LiesBetweenInProportionAndBySquares) {
  EXPECT_DOUBLE_EQ(by_samples(6'000, 96'000).exponent, 2) << "as points on two skew lines";
  EXPECT_DOUBLE_EQ(by_samples(6'000, 600'000).exponent, 2);
  EXPECT_DOUBLE_EQ(by_samples(6'000, 12'000).exponent, 1);
  EXPECT_DOUBLE_EQ(by_samples(6'000, 3'000).exponent, 1);
}

TEST(WorkForecast, TakesTheWorstWhereTheSamplesSayNothing) {
  EXPECT_DOUBLE_EQ(by_samples(0, 24'000).exponent, 2);
  EXPECT_DOUBLE_EQ(WorkForecast::of({}, {4'000, 24'000}, 3, 1).exponent, 2);
  EXPECT_DOUBLE_EQ(WorkForecast::of({4'000, 24'000}, {4'000, 24'000}, 3, 1).exponent, 2);
}

TEST(WorkForecast, OfFewerPointsIsNotLessThanTheSampleTook) {
  const WorkForecast forecast = WorkForecast::of({1'000, 6'000}, {4'000, 24'000}, 3, 10);
  EXPECT_DOUBLE_EQ(forecast.bytes_for(10), 240'000);
  EXPECT_DOUBLE_EQ(forecast.bytes_for(0), 240'000);
}

}  // namespace
}  // namespace spillway::test
