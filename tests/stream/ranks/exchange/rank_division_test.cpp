// Which rank gets which part of space: about as many points each, and the same word everywhere.

#include "stream/ranks/exchange/rank_division.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/runtime/packing.h"
#include "tests/stream/ranks/shared_inputs.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

RankDivision divide(const std::vector<std::string>& paths, int dimension,
                    PointCounts* counts = nullptr) {
  const auto source =
      open_shared_source(disk(), paths, {.dimension = dimension, .index = true}, world());
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  PieceTable pieces(*source, world(), *scratch, times, [] {});
  RankDivision division = dimension == 2 ? divide_among_ranks<2>(pieces, world()).division
                                         : divide_among_ranks<3>(pieces, world()).division;
  if (counts != nullptr) *counts = source->counts();
  world().barrier();
  return division;
}

/// How many of the points each rank would get.
std::vector<std::size_t> shares(const RankDivision& division,
                                const std::vector<LatticePoint>& points) {
  std::vector<std::uint32_t> tiles(points.size());
  division.cuts.find_tiles(points, tiles);
  std::vector<std::size_t> shares(static_cast<std::size_t>(world().size()));
  for (const std::uint32_t tile : tiles) {
    ++shares.at(static_cast<std::size_t>(division.rank_of_tile.at(tile)));
  }
  return shares;
}

void expect_equal_shares(const RankDivision& division, const std::vector<LatticePoint>& points) {
  const double fair = static_cast<double>(points.size()) / world().size();
  for (const std::size_t share : shares(division, points)) {
    EXPECT_NEAR(static_cast<double>(share), fair, 0.05 * fair);
  }
}

/// Most of them crowd near the origin.
std::vector<LatticePoint> crowded(std::size_t count, unsigned seed) {
  std::vector<LatticePoint> points = points_of_seed(count, seed);
  for (LatticePoint& point : points) {
    for (double& x : point) x = std::pow(x, 6);
  }
  return points;
}

TEST(RankDivision, GivesAllRanksAboutAsManyPoints) {
  const SharedFolder folder;
  for (const int dimension : {2, 3}) {
    const auto points = crowded(50'000, 1);
    expect_equal_shares(divide(write_inputs(folder, points, 3, "npy"), dimension), points);
  }
}

/// A sample of the first input alone would know nothing of the second one's half of the plane.
TEST(RankDivision, LooksAtAllInputsAlikeAndAtThoseOfOneRankAlone) {
  const SharedFolder folder;
  std::vector<LatticePoint> points = points_of_seed(40'000, 2);
  for (std::size_t i = points.size() / 2; i < points.size(); ++i) points[i][0] += 10;
  expect_equal_shares(divide(write_inputs(folder, points, 2, "npy"), 2), points);
  expect_equal_shares(divide(write_inputs(folder, points, 2, "spp"), 2), points);
}

/// Every n-th point would be of one place alone.
TEST(RankDivision, SeesAllPlacesThatTheInputSendsInTurns) {
  const SharedFolder folder;
  std::vector<LatticePoint> points = points_of_seed(4 * 65'536, 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i][0] += static_cast<double>(i % 4);
    points[i][1] *= 0.9;
  }
  expect_equal_shares(divide(write_inputs(folder, points, 1, "npy"), 2), points);
}

TEST(RankDivision, CountsNoPointsSinceTheyAreReadAgain) {
  const SharedFolder folder;
  PointCounts counts;
  divide(write_inputs(folder, points_of_seed(1000, 3), 1, "npy"), 2, &counts);
  EXPECT_EQ(counts, PointCounts{});
}

TEST(RankDivision, IsTheSameAtAllRanks) {
  const SharedFolder folder;
  const auto points = points_of_seed(20'000, 4);
  const RankDivision division = divide(write_inputs(folder, points, 2, "npy"), 3);
  std::vector<std::uint32_t> tiles(points.size());
  division.cuts.find_tiles(points, tiles);
  Packer packer;
  packer.put_list(division.rank_of_tile);
  packer.put_list(tiles);
  for (const auto& bytes : world().gather(packer.bytes())) {
    EXPECT_TRUE(std::ranges::equal(bytes, packer.bytes()));
  }
}

/// Appends the ranks below a node, in the order of the tree.
void append_ranks(const RankDivision& division, CutTree::NodeRef node, std::vector<int>& ranks) {
  if (CutTree::is_tile(node)) {
    ranks.push_back(division.rank_of_tile.at(CutTree::tile_at(node)));
    return;
  }
  for (const CutTree::NodeRef side : division.cuts.sides(node)) {
    append_ranks(division, side, ranks);
  }
}

TEST(RankDivision, GivesEachRankTheSampleOfItsOwnCell) {
  const SharedFolder folder;
  const auto points = points_of_seed(20'000, 7);
  const auto source = open_shared_source(disk(), write_inputs(folder, points, 2, "npy"),
                                         {.dimension = 2, .index = true}, world());
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  PieceTable pieces(*source, world(), *scratch, times, [] {});
  const auto [division, own] = divide_among_ranks<2>(pieces, world());
  const Box<3> cell = *division.cell_of(world().rank());
  for (const LatticePoint& p : own) {
    for (int k = 0; k < 2; ++k) {
      EXPECT_GE(p[k], cell.lo[k]);
      EXPECT_LT(p[k], cell.hi[k]);
    }
  }
  std::uint64_t all = own.size();
  world().reduce(std::span(&all, 1), distributed::Reduction::kSum);
  EXPECT_GT(all, points.size() / 4) << "of so few points much is the sample";
  EXPECT_FALSE(division.cell_of(world().size())) << "nobody's";
}

TEST(RankDivision, NumbersRanksInTheOrderOfTheTree) {
  const SharedFolder folder;
  const RankDivision division = divide(write_inputs(folder, points_of_seed(5000, 5), 1, "npy"), 2);
  std::vector<int> ranks;
  append_ranks(division, division.cuts.root(), ranks);
  ASSERT_EQ(ranks.size(), static_cast<std::size_t>(world().size()));
  for (std::size_t r = 0; r < ranks.size(); ++r) EXPECT_EQ(ranks[r], static_cast<int>(r));
}

TEST(RankDivision, OfEqualPointsLeavesRanksWithoutATile) {
  const SharedFolder folder;
  const std::vector<LatticePoint> points(3000, LatticePoint{0.5, 0.25, 0});
  const RankDivision division = divide(write_inputs(folder, points, 1, "npy"), 2);
  EXPECT_THAT(division.rank_of_tile, ElementsAre(0));
  EXPECT_EQ(shares(division, points)[0], 3000U);
}

TEST(RankDivision, HasARankForPointsOutsideOfAllItHasSeen) {
  const SharedFolder folder;
  const RankDivision division = divide(write_inputs(folder, points_of_seed(3000, 6), 1, "npy"), 3);
  const std::vector<LatticePoint> far = {{-1e9, 0, 0}, {1e9, 1e9, 1e9}, {0, -1e300, 0}};
  std::size_t all = 0;
  for (const std::size_t share : shares(division, far)) all += share;
  EXPECT_EQ(all, far.size());
}

}  // namespace
}  // namespace spillway::test
