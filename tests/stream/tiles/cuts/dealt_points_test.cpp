#include "stream/tiles/cuts/dealt_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

TEST(DealtPoints, AreGroupedByTileInTheOrderInWhichTheyCame) {
  CutTree cuts(2);
  cuts.cut(0, 0, 1);
  cuts.cut(0, 0, -5);  // nothing is below: tile 0 gets no point
  PointBlock block;
  block.points = {{2, 0, 0}, {0, 1, 0}, {3, 2, 0}, {0, 3, 0}, {2, 4, 0}};
  block.index = {10, 11, 12, 13, 14};
  DealtPoints dealt;
  for (int again = 0; again < 2; ++again) {
    dealt.deal(cuts, block);
    EXPECT_THAT(dealt.points.index, ElementsAre(10, 12, 14, 11, 13));
    EXPECT_EQ(dealt.points.points[3], block.points[1]);
    ASSERT_EQ(dealt.runs.size(), 2U);
    EXPECT_EQ(dealt.runs[0].tile, 1U);
    EXPECT_EQ(dealt.runs[0].begin, 0U);
    EXPECT_EQ(dealt.runs[0].end, 3U);
    EXPECT_EQ(dealt.runs[0].box.lo, (LatticePoint{2, 0, 0}));
    EXPECT_EQ(dealt.runs[0].box.hi, (LatticePoint{3, 4, 0}));
    EXPECT_EQ(dealt.runs[1].tile, 2U);
    EXPECT_EQ(dealt.runs[1].end, 5U);
  }
}

TEST(DealtPoints, HaveNoIndicesIfTheBlockHasNone) {
  PointBlock block;
  for (int i = 0; i < 9; ++i) block.points.push_back({1.0 * i, 0.5 * i, 0});
  DealtPoints dealt;
  dealt.deal(CutTree(2), block);
  EXPECT_EQ(dealt.points.points, block.points);
  EXPECT_TRUE(dealt.points.index.empty());
}

}  // namespace
}  // namespace spillway::test
