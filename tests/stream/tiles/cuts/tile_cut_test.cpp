// Where a tile is cut that has become too large.

#include "stream/tiles/cuts/tile_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace spillway::test {
namespace {

/// Random points in a box, with up to four segments on the disk.
struct RandomTile {
  std::vector<TileSegment> segments;
  CrowdedTile tile;

  RandomTile(int dimension, const Box<3>& box, unsigned seed, double step = 0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    tile.dimension = dimension;
    const auto add = [&](Box<3>& around) {
      LatticePoint point{};
      for (int k = 0; k < dimension; ++k) {
        point[k] = box.lo[k] + unit(random) * box.extent(k);
        if (step > 0) point[k] = step * std::floor(point[k] / step);
      }
      around.expand(point);
      tile.box.expand(point);
      return point;
    };
    for (int s = 0; s < static_cast<int>(seed % 5); ++s) {
      TileSegment segment;
      segment.points = 2 + random() % 100;
      add(segment.box);
      add(segment.box);
      segments.push_back(segment);
    }
    for (unsigned i = 0; i < 2 + seed % 97; ++i) {
      Box<3> around;
      tile.sample.push_back(add(around));
    }
    tile.weight = 1 + seed % 7;
    tile.segments = segments;
  }
};

Box<3> box_of(double x, double y, double z = 0) { return {{0, 0, 0}, {x, y, z}}; }

TileSegment segment_of(std::uint64_t points, double lo, double hi, double height = 1) {
  TileSegment segment;
  segment.points = points;
  segment.box = {{lo, 0, 0}, {hi, height, 0}};
  return segment;
}

TEST(ShareBelow, IsThatOfAnEvenDensity) {
  const Box<3> box{{10, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(share_below(box, {0, 9}), 0);
  EXPECT_EQ(share_below(box, {0, 10}), 0);
  EXPECT_EQ(share_below(box, {0, 12.5}), 0.25);
  EXPECT_EQ(share_below(box, {0, 21}), 1);
  EXPECT_EQ(share_below(box, {1, 0}), 0);  // of no extent: on the cut, thus above
  EXPECT_EQ(share_below(box, {1, 1}), 1);
}

TEST(SideOf, TakesPointsOnTheCutForAbove) {
  const Box<3> box{{-1, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(side_of(box, {0, -1}), 1);
  EXPECT_EQ(side_of(box, {0, 0}), std::nullopt);
  EXPECT_EQ(side_of(box, {0, 1}), std::nullopt);
  EXPECT_EQ(side_of(box, {0, std::nextafter(1.0, 0.0)}), std::nullopt);
  EXPECT_EQ(side_of(box, {0, std::nextafter(1.0, 2.0)}), 0);
  EXPECT_EQ(side_of(box, {1, 0}), 1);
}

TEST(Aspect, IsThatOfTheLongestSideToTheShortest) {
  EXPECT_EQ(aspect(Box<2>{{0, 0}, {6, 2}}), 3);
  EXPECT_EQ(aspect(Box<3>{{0, 0, 0}, {2, 8, 1}}), 8);
  EXPECT_EQ(aspect(Box<3>{{0, 0, 0}, {2, 8, 1}}, 2), 4);
  EXPECT_EQ(aspect(Box<2>{{3, 3}, {3, 3}}), 1);
  EXPECT_TRUE(std::isinf(aspect(Box<2>{{3, 3}, {3, 4}})));
}

TEST(AspectByCuts, IsNotThatOfSidesThatNoCutMadeShort) {
  const Box<3> box{{0, 0, 0}, {8, 2, 1}};
  Box<3> cell = whole_space<3>();
  EXPECT_LE(aspect_by_cuts(box, cell, 3), 1);
  cell.lo[1] = 0;
  EXPECT_EQ(aspect_by_cuts(box, cell, 3), 4);
  cell.hi[2] = 1;
  EXPECT_EQ(aspect_by_cuts(box, cell, 3), 8);
  EXPECT_EQ(aspect_by_cuts(box, cell, 2), 4);
}

TEST(TooLong, IsWhatMakesCompactTilesThatAreNotSmall) {
  EXPECT_FALSE(too_long(1000, 4, 1000));
  EXPECT_TRUE(too_long(1000, 5, 1000));
  EXPECT_TRUE(too_long(125, 8, 1000));
  EXPECT_FALSE(too_long(124, 8, 1000));
  EXPECT_FALSE(too_long(1000, std::numeric_limits<double>::infinity(), 1000));
}

TEST(PartOf, HasWhatACutLeavesOnASide) {
  const Box<3> box{{0, 0, 0}, {4, 4, 4}};
  EXPECT_EQ(part_of(box, {1, 3}, 1), (Box<3>{{0, 3, 0}, {4, 4, 4}}));
  EXPECT_EQ(part_of(box, {1, 3}, 0), (Box<3>{{0, 0, 0}, {4, std::nextafter(3, 0), 4}}));
  EXPECT_TRUE(part_of(box, {1, 5}, 1).empty());
  EXPECT_TRUE(part_of(box, {1, 0}, 0).empty());
  EXPECT_TRUE(part_of(Box<3>{}, {0, 1}, 0).empty());
}

TEST(HeavyPlace, IsWhereAQuarterOfTheSampleIs) {
  CrowdedTile tile;
  for (int i = 0; i < 12; ++i) tile.sample.push_back({1.0 * i, 2, 3});
  EXPECT_FALSE(heavy_place(tile));
  for (int i = 0; i < 4; ++i) tile.sample.push_back({20, 5, 1.0 * i});
  EXPECT_EQ(heavy_place(tile), (LatticePoint{20, 5, 0}));
  tile.dimension = 3;
  EXPECT_FALSE(heavy_place(tile));
}

TEST(CutBeside, LeavesOnePlaceAlone) {
  const LatticePoint place{1, 2, 0};
  Box<3> box{{0, 0, 0}, {3, 3, 3}};
  int cuts = 0;
  while (const auto cut = cut_beside(box, place, 2)) {
    box = part_of(box, *cut, place[cut->axis] >= cut->value ? 1 : 0);
    ASSERT_LE(++cuts, 4);
  }
  EXPECT_EQ(cuts, 4);
  EXPECT_EQ(box, (Box<3>{{1, 2, 0}, {1, 2, 3}}));
}

TEST(ChooseCut, LooksAtWherePointsAreStillToCome) {
  CrowdedTile tile{.box = box_of(1, 0.8)};  // longer in x, but for what comes above
  tile.expected = {{0, 0.8, 0}, {1, 3, 0}};
  for (int i = 0; i < 100; ++i) tile.sample.push_back({0.01 * i, 0.08 * (i % 11), 0});
  const auto cut = choose_cut(tile);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->axis, 1);
}

TEST(ChooseCut, LeavesPointsOnBothSides) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    for (const int dimension : {2, 3}) {
      const double step = seed % 3 == 0 ? 0.4 : 0;  // few different places
      const RandomTile random(dimension, box_of(1, seed % 10, 1), seed, step);
      const CrowdedTile& tile = random.tile;
      if (tile.box.lo == tile.box.hi) continue;
      const auto cut = choose_cut(tile);
      ASSERT_TRUE(cut) << seed;
      EXPECT_LT(cut->axis, dimension);
      EXPECT_GT(cut->value, tile.box.lo[cut->axis]);
      EXPECT_LE(cut->value, tile.box.hi[cut->axis]);
    }
  }
}

TEST(ChooseCut, FindsNoneBetweenEqualPoints) {
  CrowdedTile tile{.sample = std::vector<LatticePoint>(20, {1, 2, 3})};
  tile.box.expand(LatticePoint{1, 2, 3});
  EXPECT_FALSE(choose_cut(tile));
  tile.box.expand(LatticePoint{1, 2, 4});  // equal but for their height
  EXPECT_FALSE(choose_cut(tile));
  tile.dimension = 3;
  const auto cut = choose_cut(tile);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->axis, 2);
}

TEST(ChooseCut, SeparatesNeighbouringDoublesAtAnyOffset) {
  for (const double offset : {0.0, 1.0, -1.0, 1e9, -1e15, 1e300}) {
    const double next = std::nextafter(offset, 1e301);
    CrowdedTile tile{.sample = std::vector<LatticePoint>(20, {offset, 5, 0})};
    tile.box = {{offset, 5, 0}, {next, 5, 0}};
    const auto cut = choose_cut(tile);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->axis, 0);
    EXPECT_EQ(cut->value, next);
  }
}

TEST(ChooseCut, KeepsEvenPointsCompact) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const int dimension : {2, 3}) {
    for (const double width : {0.26, 0.4, 0.6, 1.0}) {
      CrowdedTile tile{.dimension = dimension};
      for (int i = 0; i < 250; ++i) {
        tile.sample.push_back({width * unit(random), unit(random), unit(random)});
        tile.box.expand(tile.sample.back());
      }
      const auto cut = choose_cut(tile);
      ASSERT_TRUE(cut);
      for (const bool upper : {false, true}) {
        Box<3> half = tile.box;
        (upper ? half.lo : half.hi)[cut->axis] = cut->value;
        double shortest = half.extent(0);
        double longest = half.extent(0);
        for (int k = 1; k < dimension; ++k) {
          shortest = std::min(shortest, half.extent(k));
          longest = std::max(longest, half.extent(k));
        }
        EXPECT_LE(longest, 4 * shortest) << "width " << width << ", axis " << cut->axis;
      }
    }
  }
}

TEST(ChooseCut, GoesBetweenSegmentsRatherThanThroughOne) {
  const std::vector<TileSegment> segments = {segment_of(300, 0, 0.36), segment_of(300, 0.38, 0.7),
                                             segment_of(300, 0.7, 1)};
  CrowdedTile tile{.box = box_of(1, 1), .segments = segments};
  const auto cut = choose_cut(tile);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->axis, 0);
  for (const TileSegment& segment : segments) EXPECT_TRUE(side_of(segment.box, *cut));
}

TEST(ChooseCut, GoesThroughASegmentRatherThanLeaveAFewPointsAlone) {
  const std::vector<TileSegment> segments = {segment_of(10, 0, 0.01), segment_of(990, 0.02, 1)};
  const auto cut = choose_cut({.box = box_of(1, 1), .segments = segments});
  ASSERT_TRUE(cut);
  double below = 0;
  for (const TileSegment& segment : segments) {
    below += static_cast<double>(segment.points) * share_below(segment.box, *cut) / 1000;
  }
  EXPECT_GE(below, 0.2);
  EXPECT_LE(below, 0.8);
}

}  // namespace
}  // namespace spillway::test
