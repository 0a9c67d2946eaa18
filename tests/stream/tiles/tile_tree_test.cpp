// Points of any order and number end up in tiles of at most the capacity, all of them, once, in the
// order in which they came.

#include "stream/tiles/tile_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "tests/stream/tiles/dealt_tiles.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kCapacity = 1000;
constexpr std::size_t kBuffered = 40 * PointBuffer::kChunk;
constexpr std::size_t kMany = 200'000;
constexpr Knowledge kNothing{};
constexpr Knowledge kAll{true, true};

using Points = std::vector<LatticePoint>;

DealtTiles<2> deal(const Points& points, Knowledge known) {
  return deal_into_tiles<2>(points, {.known = known});
}

/// Where tiles don't hold the points that they say, each of them once; "" if they do.
template <int D>
std::string fault_of(const DealtTiles<D>& dealt, const Points& points) {
  std::vector<bool> found(points.size());
  for (const DealtTile<D>& tile : dealt.tiles) {
    Box<D> box;
    for (std::size_t i = 0; i < tile.points.points.size(); ++i) {
      const std::uint64_t index = tile.points.index[i];
      if (found.at(index)) return "a point comes twice";
      found[index] = true;
      for (int k = 0; k < D; ++k) {
        if (tile.points.points[i][k] != points[index][k]) return "a point is another one";
      }
      if constexpr (D == 2) {
        if (tile.points.heights[i] != points[index][2]) return "a height is another one";
      }
      box.expand(tile.points.points[i]);
    }
    if (box != tile.box) return "a box is not tight";
    if (box.lo != box.hi && tile.points.points.size() > kCapacity) return "a tile is too large";
  }
  return std::ranges::count(found, false) > 0 ? "a point is missing" : "";
}

/// Points that come before one that was read earlier, in the tiles that a tile is made of.
template <int D>
std::size_t out_of_order(const DealtTiles<D>& dealt) {
  std::size_t descents = 0;
  for (const DealtTile<D>& tile : dealt.tiles) {
    std::size_t here = 0;
    for (std::size_t i = 1; i < tile.points.index.size(); ++i) {
      here += tile.points.index[i] < tile.points.index[i - 1] ? 1 : 0;
    }
    descents += here - std::min(here, tile.stored - 1);
  }
  return descents;
}

/// The share of tiles whose box is longer than four times its width.
double share_of_long(const DealtTiles<2>& dealt) {
  const auto count = std::ranges::count_if(dealt.tiles, [](const DealtTile<2>& tile) {
    const auto [shorter, longer] = std::minmax(tile.box.extent(0), tile.box.extent(1));
    return longer > 4 * shorter;
  });
  return static_cast<double>(count) / static_cast<double>(dealt.tiles.size());
}

class TileTreeOfOrder : public testing::TestWithParam<Order> {};

TEST_P(TileTreeOfOrder, KeepsEveryPointInTilesOfTheCapacity) {
  const Points points = make_points(GetParam(), kMany);
  for (const Knowledge known : {kNothing, Knowledge{true, false}, kAll}) {
    SCOPED_TRACE(testing::Message()
                 << "count known " << known.count << ", extent " << known.extent);
    const DealtTiles<2> dealt = deal(points, known);
    EXPECT_EQ(fault_of(dealt, points), "");
    EXPECT_LE(dealt.writes(), 2.0);
    EXPECT_GE(dealt.divided, dealt.left_over);
  }
}

TEST_P(TileTreeOfOrder, GivesPointsInTheOrderInWhichTheyCame) {
  EXPECT_EQ(out_of_order(deal(make_points(GetParam(), kMany), kNothing)), 0U);
}

TEST_P(TileTreeOfOrder, GivesTheSameTilesForAnyNumberOfThreads) {
  const Points points = make_points(GetParam(), kMany / 2);
  const DealtTiles<2> one = deal_into_tiles<2>(points, {.threads = 1});
  const DealtTiles<2> three = deal_into_tiles<2>(points, {.threads = 3});
  EXPECT_EQ(one.written, three.written);
  ASSERT_EQ(one.tiles.size(), three.tiles.size());
  for (std::size_t t = 0; t < one.tiles.size(); ++t) {
    ASSERT_EQ(one.tiles[t].points.index, three.tiles[t].points.index) << "tile " << t;
  }
}

/// How many points lie in another tile than an equal one.
std::size_t apart_from_equal(const DealtTiles<2>& dealt) {
  std::vector<std::pair<Point<2>, std::size_t>> all;
  for (std::size_t t = 0; t < dealt.tiles.size(); ++t) {
    for (const Point<2>& p : dealt.tiles[t].points.points) all.emplace_back(p, t);
  }
  std::ranges::sort(all);
  std::size_t apart = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    apart += all[i].first == all[i - 1].first && all[i].second != all[i - 1].second ? 1 : 0;
  }
  return apart;
}

TEST_P(TileTreeOfOrder, KeepsEqualPointsTogetherAndTheirOrderInLittleMemory) {
  // A fraction of the points fits: most tiles are cut when they have segments on the disk.
  const Dealing dealing{.capacity = 200, .buffered = 6'000, .block = 300};
  const Points points = make_points(GetParam(), 25'000);
  const DealtTiles<2> dealt = deal_into_tiles<2>(points, dealing);
  EXPECT_EQ(fault_of(dealt, points), "");
  EXPECT_EQ(out_of_order(dealt), 0U);
  EXPECT_EQ(apart_from_equal(dealt), 0U);
}

INSTANTIATE_TEST_SUITE_P(Orders, TileTreeOfOrder,
                         testing::Values(Order::kRandom, Order::kSorted, Order::kFlightLines,
                                         Order::kStrips, Order::kOutwards, Order::kCurve,
                                         Order::kSkewed, Order::kCluster, Order::kEqual,
                                         Order::kRepeated),
                         testing::PrintToStringParamName());

TEST(TileTree, MakesCompactTilesInWhateverOrderPointsCome) {
  for (const Order order : {Order::kRandom, Order::kSorted, Order::kFlightLines, Order::kStrips,
                            Order::kOutwards, Order::kCurve}) {
    EXPECT_LE(share_of_long(deal(make_points(order, kMany), kNothing)), 0.02)
        << testing::PrintToString(order);
  }
}

TEST(TileTree, KeepsPointsOfSpaceLikewise) {
  for (const Order order : {Order::kRandom, Order::kSorted}) {
    const Points points = make_points(order, kMany / 2, false);
    const DealtTiles<3> dealt = deal_into_tiles<3>(points, {});
    EXPECT_EQ(fault_of(dealt, points), "");
    EXPECT_EQ(out_of_order(dealt), 0U);
    EXPECT_LE(dealt.writes(), 2.0);
  }
}

TEST(TileTree, KeepsPointsFarFromTheOrigin) {
  Points points = make_points(Order::kFlightLines, kMany / 2);
  for (LatticePoint& p : points) p = {1e15 + std::floor(1000 * p[0]), std::floor(1e6 * p[1]), p[2]};
  EXPECT_EQ(fault_of(deal(points, kNothing), points), "");
}

TEST(TileTree, WritesEveryPointOnceWhenTheHeaderTellsTheTruth) {
  for (const Order order : {Order::kRandom, Order::kSorted, Order::kFlightLines}) {
    EXPECT_LE(deal(make_points(order, kMany), kAll).writes(), 1.02)
        << testing::PrintToString(order);
  }
}

TEST(TileTree, WritesLittleTwiceInTheOrderOfAScanner) {
  for (const Order order : {Order::kSorted, Order::kFlightLines, Order::kCurve}) {
    EXPECT_LE(deal(make_points(order, kMany), kNothing).writes(), 1.3)
        << testing::PrintToString(order);
  }
}

TEST(TileTree, DealsAgainWhatALaterCutPartedOnTheDisk) {
  const DealtTiles<2> dealt = deal(make_points(Order::kRandom, 250'000), kNothing);
  EXPECT_GT(dealt.left_over, kCapacity);
  EXPECT_GE(dealt.divided, dealt.left_over);
  EXPECT_EQ(deal(make_points(Order::kRandom, 5'000), kNothing).divided, 0U);
}

TEST(TileTree, WritesNothingIfEverythingFits) {
  const DealtTiles<2> dealt = deal(make_points(Order::kRandom, 5'000), kNothing);
  EXPECT_EQ(dealt.written, 0U);
  EXPECT_GT(dealt.tiles.size(), 4U);
}

TEST(TileTree, TakesEqualPointsAsOneTileWhateverTheirNumber) {
  const Points points(200'000, LatticePoint{1, 2, 3});
  const DealtTiles<2> dealt = deal(points, kNothing);
  EXPECT_EQ(dealt.tiles.size(), 1U);
  EXPECT_EQ(fault_of(dealt, points), "");
}

TEST(TileTree, SurvivesAHeaderThatLies) {
  const Points points = make_points(Order::kSorted, 250'000);
  const auto scratch = make_scratch_folder(testing::TempDir(), std::nullopt);
  StageTimes times;
  TileTreeOptions options{.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered};
  options.expected = 10;
  options.extent = Box<3>{};
  options.extent->expand(LatticePoint{1000, 1000, 0});
  with_threads(2, [&] {
    TileTree tree(options, *scratch, times);
    bool given = false;
    tree.fill([&](PointBlock& block) {
      block.points = given ? Points() : points;
      return !std::exchange(given, true);
    });
    tree.divide_large([](std::uint64_t, double) {});
    ASSERT_TRUE(tree.nodes<2>());
    EXPECT_EQ(tree.nodes<2>()->points, points.size());
  });
}

TEST(TileTree, SaysWhenTheDiskIsFull) {
  const auto scratch = make_scratch_folder(testing::TempDir(), 10'000);
  StageTimes times;
  const Points points = make_points(Order::kRandom, 300'000);
  with_threads(2, [&] {
    TileTree tree({.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered}, *scratch,
                  times);
    bool given = false;
    try {
      tree.fill([&](PointBlock& block) {
        block.points = given ? Points() : points;
        return !std::exchange(given, true);
      });
      tree.divide_large([](std::uint64_t, double) {});
      FAIL() << "the cap was not kept";
    } catch (const Error& error) {
      EXPECT_EQ(error.facts().remedy, Remedy::kScratchLimit) << error.what();
    }
  });
}

}  // namespace
}  // namespace spillway::detail
