// Samples of points that come in spans, and points that stand for those to come.

#include "stream/points/point_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace spillway::test {
namespace {

std::vector<LatticePoint> numbered_points(std::size_t count) {
  std::vector<LatticePoint> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({static_cast<double>(i), 0, 0});
  return points;
}

TEST(PointSample, OfEveryPointHasAll) {
  PointSample sample(1);
  const std::vector<LatticePoint> points = numbered_points(50);
  sample.add(std::span(points).first(20));
  sample.add(std::span(points).subspan(20));
  EXPECT_EQ(sample.take(), points);
}

TEST(PointSample, HasAboutItsShareOfEveryPart) {
  PointSample sample(10);
  sample.add(numbered_points(20'000));
  std::array<int, 10> parts{};
  for (const LatticePoint& p : sample.take()) ++parts[static_cast<std::size_t>(p[0] / 2000)];
  for (const int part : parts) EXPECT_NEAR(part, 200, 40);
}

TEST(PointSample, DoesNotDependOnTheSpans) {
  const std::vector<LatticePoint> points = numbered_points(1000);
  PointSample whole(7);
  whole.add(points);
  PointSample spans(7);
  for (std::size_t begin = 0, size = 0; begin < points.size(); begin += size, ++size) {
    spans.add(std::span(points).subspan(begin, std::min(size, points.size() - begin)));
  }
  EXPECT_EQ(spans.take(), whole.take());
}

TEST(PointSample, SeesEveryColumnOfAGrid) {
  PointSample sample(16);
  std::vector<LatticePoint> points;
  for (int i = 0; i < 64 * 256; ++i) points.push_back({static_cast<double>(i % 64), 0, 0});
  sample.add(points);
  std::array<int, 64> columns{};
  for (const LatticePoint& p : sample.take()) ++columns[static_cast<std::size_t>(p[0])];
  EXPECT_GT(*std::ranges::min_element(columns), 2);
}

TEST(SpansExtent, LooksAtTheAxesOfTheDimension) {
  const Box<3> extent{{0, 0, 0}, {10, 10, 10}};
  EXPECT_TRUE(spans_extent(extent, extent, 3));
  EXPECT_TRUE(spans_extent({{0.5, 0, 5}, {9.9, 10, 5}}, extent, 2));
  EXPECT_FALSE(spans_extent({{0.5, 0, 5}, {9.9, 10, 5}}, extent, 3));
  EXPECT_FALSE(spans_extent({{0, 0, 0}, {8.9, 10, 10}}, extent, 2));
}

TEST(ExpectedPoints, LieEvenlyWhereNoneHaveCome) {
  const Box<3> extent{{100, 0, 0}, {200, 40, 10}};
  const Box<3> seen{{100, 0, 0}, {150, 40, 10}};
  for (const int dimension : {2, 3}) {
    std::vector<LatticePoint> sample(100, {120, 20, 5});
    append_expected_points(sample, seen, extent, dimension, 8);
    ASSERT_EQ(sample.size(), 900U);
    std::array<int, 4> quarters{};
    for (const LatticePoint& p : std::span(sample).subspan(100)) {
      ASSERT_GT(p[0], 150);
      ASSERT_LE(p[0], 200);
      ASSERT_GE(p[1], 0);
      ASSERT_LE(p[1], 40);
      ++quarters[(p[0] < 175 ? 0 : 1) + (p[1] < 20 ? 0 : 2)];
    }
    for (const int quarter : quarters) EXPECT_NEAR(quarter, 200, 10);
  }
}

TEST(ExpectedPoints, AreNoneIfPointsHaveComeFromEverywhere) {
  const Box<3> extent{{0, 0, 0}, {1, 1, 1}};
  std::vector<LatticePoint> sample(10);
  append_expected_points(sample, extent, extent, 2, 5);
  EXPECT_EQ(sample.size(), 10U);
}

}  // namespace
}  // namespace spillway::test
