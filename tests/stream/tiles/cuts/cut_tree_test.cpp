#include "stream/tiles/cuts/cut_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "stream/tiles/cuts/sample_division.h"

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

std::vector<std::uint32_t> tiles_of(const CutTree& cuts, const std::vector<LatticePoint>& points) {
  std::vector<std::uint32_t> tiles(points.size());
  cuts.find_tiles(points, tiles);
  return tiles;
}

std::vector<LatticePoint> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

TEST(CutTree, OfNoCutsIsOneTile) {
  const CutTree cuts(2);
  EXPECT_EQ(cuts.tiles(), 1U);
  EXPECT_TRUE(CutTree::is_tile(cuts.root()));
  EXPECT_THAT(tiles_of(cuts, random_points(20, 1)), Each(0U));
}

TEST(CutTree, PointsOnACutGoUp) {
  CutTree cuts(2);
  cuts.cut(0, 0, 5);
  cuts.cut(1, 1, 2);
  EXPECT_EQ(cuts.tiles(), 3U);
  EXPECT_THAT(tiles_of(cuts, {{4.9, 9, 0}, {5, 1.9, 0}, {5, 2, 0}, {1e300, 1e300, 0}}),
              ElementsAre(0, 1, 2, 2));
  ASSERT_FALSE(CutTree::is_tile(cuts.root()));
  const auto [below, above] = cuts.sides(cuts.root());
  EXPECT_EQ(CutTree::tile_at(below), 0U);
  ASSERT_FALSE(CutTree::is_tile(above));
  EXPECT_EQ(CutTree::tile_at(cuts.sides(above)[1]), 2U);
}

TEST(CutTree, SplitsASampleIntoEqualShares) {
  CutTree cuts(3);
  const std::vector<LatticePoint> points = random_points(7000, 2);
  cuts.split(0, divide_sample_evenly(points, 7, 3));
  EXPECT_EQ(cuts.tiles(), 7U);
  std::vector<int> share(7);
  for (const std::uint32_t tile : tiles_of(cuts, points)) ++share[tile];
  for (const int points_of_tile : share) EXPECT_NEAR(points_of_tile, 1000, 10);
}

TEST(CutTree, CutsOnlyTheFirstAxes) {
  CutTree cuts(2);
  std::vector<LatticePoint> sample = random_points(100, 3);
  for (LatticePoint& point : sample) point[2] *= 1000;
  cuts.split(0, divide_sample_evenly(sample, 8, 2));
  for (LatticePoint point : sample) {
    const std::uint32_t tile = tiles_of(cuts, {point})[0];
    point[2] = -point[2];
    EXPECT_EQ(tiles_of(cuts, {point})[0], tile);
  }
}

TEST(CutTree, EqualPointsStayTogether) {
  CutTree cuts(2);
  std::vector<LatticePoint> equal(50, LatticePoint{1, 2, 3});
  cuts.split(0, divide_sample_evenly(equal, 4, 2));
  EXPECT_EQ(cuts.tiles(), 1U);
  std::vector<LatticePoint> two(50, LatticePoint{1, 2, 3});
  two.push_back({1, 7, 3});
  cuts.split(0, divide_sample_evenly(two, 4, 2));
  EXPECT_EQ(cuts.tiles(), 2U);
  EXPECT_THAT(tiles_of(cuts, {{1, 2, 3}, {1, 7, 3}}), ElementsAre(0, 1));
}

/// The tile that the cuts themselves lead to, where they are known by their references.
std::uint32_t walk(const CutTree& cuts, const std::vector<std::pair<int, double>>& planes,
                   const LatticePoint& point) {
  CutTree::NodeRef ref = cuts.root();
  while (!CutTree::is_tile(ref)) {
    const auto [axis, value] = planes[static_cast<std::size_t>(ref)];
    ref = cuts.sides(ref)[point[axis] >= value ? 1 : 0];
  }
  return CutTree::tile_at(ref);
}

TEST(CutTree, FindsTheSameAsAWalkAfterEachCutOfALongChain) {
  for (const int dimension : {2, 3}) {
    CutTree cuts(dimension);
    std::vector<std::pair<int, double>> planes;
    std::vector<LatticePoint> points = random_points(200, 5);
    for (LatticePoint& point : points) {
      for (double& x : point) x = std::floor(150 * x);  // many on cuts
    }
    for (int i = 0; i < 120; ++i) {
      planes.emplace_back(i % dimension, i);
      const std::uint32_t last = cuts.tiles() - 1;
      EXPECT_EQ(cuts.cut(last, i % dimension, i), i);
      const std::vector<std::uint32_t> tiles = tiles_of(cuts, points);
      for (std::size_t p = 0; p < points.size(); ++p) {
        ASSERT_EQ(tiles[p], walk(cuts, planes, points[p])) << "cut " << i;
      }
    }
  }
}

TEST(CutTree, FindsTheSameAsAWalkAfterCutsOfAnyTile) {
  CutTree cuts(2);
  std::mt19937 random(6);
  std::vector<std::pair<int, double>> planes;
  const std::vector<LatticePoint> points = random_points(300, 7);
  for (int i = 0; i < 150; ++i) {
    const LatticePoint& at = points[random() % points.size()];
    const int axis = static_cast<int>(random() % 2);
    cuts.cut(tiles_of(cuts, {at})[0], axis, at[axis]);
    planes.emplace_back(axis, at[axis]);
    const std::vector<std::uint32_t> tiles = tiles_of(cuts, points);
    for (std::size_t p = 0; p < points.size(); ++p) {
      ASSERT_EQ(tiles[p], walk(cuts, planes, points[p])) << "cut " << i;
    }
  }
}

}  // namespace
}  // namespace spillway::test
