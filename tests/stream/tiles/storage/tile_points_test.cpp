#include "stream/tiles/storage/tile_points.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

TEST(TilePoints, InThePlaneHeightsStandApart) {
  const std::vector<LatticePoint> point = {{3, 4, 5}};
  const std::vector<std::uint64_t> index = {7};
  const std::vector<std::byte> record(3, std::byte{9});
  TilePoints<2> plane;
  plane.resize(2, true, 3);
  plane.set(1, {point, index, record});
  EXPECT_EQ(plane.points[1], (Point<2>{3, 4}));
  EXPECT_EQ(plane.heights[1], 5);
  EXPECT_EQ(plane.index[1], 7U);
  EXPECT_EQ(plane.attributes[5], std::byte{9});
  TilePoints<3> space;
  space.resize(2, false, 0);
  space.set(0, {point, {}, {}});
  EXPECT_EQ(space.points[0], (LatticePoint{3, 4, 5}));
  EXPECT_TRUE(space.heights.empty());
  EXPECT_TRUE(space.index.empty());
}

TEST(TilePoints, OfFiveDimensionsTakeTheFirstNumbersOfTheirRecords) {
  const std::vector<LatticePoint> points = {{1, 2, 3}, {6, 7, 8}};
  std::vector<std::byte> records;
  for (const Point<5>& point : {Point<5>{1, 2, 3, 4, 5}, Point<5>{6, 7, 8, 9, 10}}) {
    append_further_coordinates<5>(point, records);
    records.push_back(std::byte{11});
  }
  TilePoints<5> all;
  all.resize(2, false, 17);
  all.set(0, {points, {}, records});
  EXPECT_EQ(all.points[0], (Point<5>{1, 2, 3, 4, 5}));
  EXPECT_EQ(all.points[1], (Point<5>{6, 7, 8, 9, 10}));
  EXPECT_EQ(all.attributes, records);
}

}  // namespace
}  // namespace spillway::test
