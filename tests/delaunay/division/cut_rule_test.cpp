// The rules that say where points are cut, and what a cut leaves of boxes.

#include "src/delaunay/division/cut_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "src/delaunay/division/axis_rule.h"

namespace spillway::test {
namespace {

PointsToCut<2> told(std::vector<Point<2>>& sample) {
  PointsToCut<2> points{.sample = sample, .count = sample.size()};
  for (const Point<2>& p : sample) points.box.expand(p);
  return points;
}

/// x from 0 to 9, y from 0 to 90.
std::vector<Point<2>> tall_points() {
  std::vector<Point<2>> points;
  for (int i = 0; i < 10; ++i) points.push_back({i * 7 % 10 * 1.0, i * 3 % 10 * 10.0});
  return points;
}

TEST(Cut, LeavesOfABoxWhatLiesOnASide) {
  const Box<2> box{{0, 0}, {4, 1}};
  const Cut cut{.axis = 0, .value = 1};
  EXPECT_EQ(share_below(box, cut), 0.25);
  EXPECT_EQ(part_of(box, cut, 0).hi[0], std::nextafter(1.0, 0.0));
  EXPECT_EQ(part_of(box, cut, 1).lo[0], 1);
  EXPECT_EQ(side_of(box, cut), std::nullopt);
  EXPECT_EQ(side_of(box, {.axis = 0, .value = 0}), 1) << "points on the cut go up";
  EXPECT_EQ(share_below(box, {.axis = 0, .value = 0}), 0);
  EXPECT_TRUE(part_of(box, {.axis = 0, .value = 0}, 0).empty());
  EXPECT_EQ(side_of(box, {.axis = 0, .value = 5}), 0);
  EXPECT_EQ(share_below(box, {.axis = 0, .value = 5}), 1);
  EXPECT_EQ(side_of(Box<2>{{2, 2}, {2, 2}}, {.axis = 1, .value = 2}), 1);
}

TEST(AxisRule, CutsTheLongestAxisAtTheShareThatIsAskedFor) {
  std::vector<Point<2>> sample = tall_points();
  PointsToCut<2> points = told(sample);
  points.share = {3, 10};
  const std::optional<Cut> cut = AxisRule<2>().choose(points);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->axis, 1);
  EXPECT_EQ(cut->value, 30);
}

TEST(AxisRule, CutsTheAxisThatTheSchemeTells) {
  std::vector<Point<2>> sample = tall_points();
  PointsToCut<2> points = told(sample);
  EXPECT_EQ(AxisRule<2>(Division::kConstantAxis).choose(points)->axis, 0);
  for (const std::size_t depth : {0, 1, 2, 3}) {
    points.depth = depth;
    EXPECT_EQ(AxisRule<2>(Division::kCyclingAxis).choose(points)->axis,
              static_cast<int>(depth % 2));
  }
}

TEST(AxisRule, CutsTheLongestAxisWhereTheSchemesHasNoExtent) {
  std::vector<Point<2>> column = {{5, 1}, {5, 2}, {5, 3}};
  EXPECT_EQ(AxisRule<2>(Division::kConstantAxis).choose(told(column))->axis, 1);
}

}  // namespace
}  // namespace spillway::test
