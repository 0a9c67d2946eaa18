#include "src/delaunay/border/run_boxes.h"

#include <gtest/gtest.h>

#include <random>

namespace spillway::test {
namespace {

TEST(RunBoxes, EachIsTightAroundWhatIsBelowIt) {
  std::mt19937_64 random(1);
  std::vector<Point<2>> points(1003);
  for (auto& p : points) p = {double(random() % 100), double(random() % 100)};
  const RunBoxes<2> boxes(points);
  std::vector<Box<2>> expected((points.size() + 7) / 8);
  for (std::size_t p = 0; p < points.size(); ++p) expected[p / 8].expand(points[p]);
  for (std::size_t l = 0; l < boxes.levels(); ++l) {
    const auto level = boxes.level(l);
    EXPECT_EQ(std::vector<Box<2>>(level.begin(), level.end()), expected);
    std::vector<Box<2>> above((expected.size() + 3) / 4);
    for (std::size_t b = 0; b < expected.size(); ++b) above[b / 4].expand(expected[b]);
    expected = above;
  }
  EXPECT_LE(boxes.level(boxes.levels() - 1).size(), 4U);
}

TEST(RunBoxes, OfFewPointsAndOfNone) {
  EXPECT_EQ(RunBoxes<3>().levels(), 0U);
  EXPECT_EQ(RunBoxes<3>(std::span<const Point<3>>()).levels(), 0U);
  const std::vector<Point<3>> one{{1, 2, 3}};
  const RunBoxes<3> boxes(one);
  ASSERT_EQ(boxes.levels(), 1U);
  EXPECT_EQ(boxes.level(0)[0].lo, one[0]);
}

}  // namespace
}  // namespace spillway::test
