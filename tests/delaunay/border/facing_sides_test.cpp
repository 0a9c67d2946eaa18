#include "src/delaunay/border/facing_sides.h"

#include <gtest/gtest.h>

#include <vector>

namespace spillway::test {
namespace {

constexpr VertexId kInf = kInfiniteVertex;

/// Corners of the box from (0, 0) to (4, 4), and others in it.
const std::vector<Point<2>> kPoints{{0, 1}, {4, 2}, {2, 0}, {1, 4}, {2, 2}, {4, 4}};

TEST(FacingSides, AreThoseBeyondWhichOthersLie) {
  FacingSides<2> sides({{0, 0}, {4, 4}});
  EXPECT_FALSE(sides.have_corner({0, 1, 2}, kPoints)) << "alone";
  EXPECT_TRUE(sides.add({{5, 0}, {6, 4}}));
  EXPECT_TRUE(sides.have_corner({4, 1, 2}, kPoints));
  EXPECT_TRUE(sides.have_corner({5, kInf, 0}, kPoints));
  EXPECT_FALSE(sides.have_corner({0, 2, 3}, kPoints));
  EXPECT_FALSE(sides.have_corner({4, kInf, 2}, kPoints));
  EXPECT_TRUE(sides.add({{1, -3}, {2, -1}}));
  EXPECT_TRUE(sides.have_corner({4, kInf, 2}, kPoints));
  EXPECT_FALSE(sides.have_corner({0, kInf, 3}, kPoints));
}

/// Boxes of a division lie apart on some axis, which is looked at from the first one on.
TEST(FacingSides, OneThatLiesApartOnTwoAxesFacesOneSide) {
  FacingSides<2> sides({{0, 0}, {4, 4}});
  EXPECT_TRUE(sides.add({{-2, -2}, {-1, -1}}));
  EXPECT_TRUE(sides.have_corner({0, 4, 5}, kPoints));
  EXPECT_FALSE(sides.have_corner({2, 4, 5}, kPoints));
}

TEST(FacingSides, BoxesThatOverlapOrTouchFaceNone) {
  FacingSides<3> sides({{0, 0, 0}, {4, 4, 4}});
  EXPECT_FALSE(sides.add({{1, 1, 1}, {9, 9, 9}}));
  EXPECT_FALSE(sides.add({{4, 0, 0}, {5, 4, 4}}));
  EXPECT_FALSE(sides.add({{0, -1, 0}, {4, 0, 4}}));
  EXPECT_TRUE(sides.add({{0, 0, 4.5}, {4, 4, 5}}));
}

}  // namespace
}  // namespace spillway::test
