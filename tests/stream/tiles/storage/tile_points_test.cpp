#include "stream/tiles/storage/tile_points.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

TEST(TilePoints, InThePlaneHeightsStandApart) {
  TilePoints<2> plane;
  plane.resize(2, true, 3);
  plane.set(1, {3, 4, 5});
  EXPECT_EQ(plane.points[1], (Point<2>{3, 4}));
  EXPECT_EQ(plane.heights[1], 5);
  EXPECT_EQ(plane.index.size(), 2U);
  EXPECT_EQ(plane.attributes.size(), 6U);
  TilePoints<3> space;
  space.resize(2, false, 0);
  space.set(0, {3, 4, 5});
  EXPECT_EQ(space.points[0], (LatticePoint{3, 4, 5}));
  EXPECT_TRUE(space.heights.empty());
  EXPECT_TRUE(space.index.empty());
}

}  // namespace
}  // namespace spillway::test
