// Points of any order and number end up in tiles of at most the capacity, all of them, once, in the
// order in which they came, where they are equal.

#include "stream/tiles/tile_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "tests/stream/tiles/dealt_tiles.h"
#include "tests/stream/tiles/ordered_points.h"

namespace spillway::test {
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

/// Points that come before an equal one that was read earlier.
template <int D>
std::size_t out_of_order(const DealtTiles<D>& dealt) {
  std::size_t descents = 0;
  for (const DealtTile<D>& tile : dealt.tiles) {
    std::map<Point<D>, std::uint64_t> last;
    for (std::size_t i = 0; i < tile.points.points.size(); ++i) {
      const auto [at, is_first] = last.try_emplace(tile.points.points[i], tile.points.index[i]);
      descents += tile.points.index[i] < at->second ? 1 : 0;
      at->second = tile.points.index[i];
    }
  }
  return descents;
}

/// How many times as long as its width a tile's box is.
double aspect_of(const DealtTile<2>& tile) { return aspect(tile.box); }

/// Tiles that are not compact.
std::size_t count_of_long(const DealtTiles<2>& dealt) {
  return static_cast<std::size_t>(std::ranges::count_if(
      dealt.tiles, [](const DealtTile<2>& tile) { return aspect_of(tile) > kMostAspect; }));
}

/// Those whose points are not thin themselves.
std::size_t count_of_too_long(const DealtTiles<2>& dealt, std::size_t capacity) {
  return static_cast<std::size_t>(std::ranges::count_if(dealt.tiles, [=](const DealtTile<2>& tile) {
    return too_long(static_cast<double>(tile.points.points.size()), aspect_of(tile), capacity);
  }));
}

class TileTreeOfOrder : public ::testing::TestWithParam<Order> {};

TEST_P(TileTreeOfOrder, KeepsEveryPointInTilesOfTheCapacity) {
  const Points points = make_points(GetParam(), kMany);
  for (const Knowledge known : {kNothing, Knowledge{true, false}, kAll}) {
    SCOPED_TRACE(::testing::Message()
                 << "count known " << known.count << ", extent " << known.extent);
    const DealtTiles<2> dealt = deal(points, known);
    EXPECT_EQ(fault_of(dealt, points), "");
    EXPECT_LE(dealt.writes(), 2.0);
    EXPECT_GE(dealt.divided, dealt.left_over);
  }
}

TEST_P(TileTreeOfOrder, GivesEqualPointsInTheOrderInWhichTheyCame) {
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

TEST_P(TileTreeOfOrder, DividedEvenlyKeepsEveryPointAndTheOrderOfEqualOnes) {
  const Points points = make_points(GetParam(), kMany / 4);
  for (Dealing dealing : {Dealing{.buffered = 20'000}, Dealing{.buffered = kMany},
                          Dealing{.capacity = 200, .buffered = 6'000, .block = 300}}) {
    dealing.evenly = true;
    const DealtTiles<2> dealt = deal_into_tiles<2>(points, dealing);
    EXPECT_EQ(fault_of(dealt, points), "");
    EXPECT_EQ(out_of_order(dealt), 0U);
    EXPECT_EQ(apart_from_equal(dealt), 0U);
    EXPECT_TRUE(dealt.nest) << dealing.buffered;
    EXPECT_LE(dealt.writes(), 3.0) << dealing.buffered;
    EXPECT_EQ(dealt.written == 0, dealing.buffered == kMany) << dealing.buffered;
  }
}

/// Through memory, through files that are read once and twice, and through tiles that are divided.
TEST_P(TileTreeOfOrder, KeepsWhatPointsCarry) {
  const Points points = make_points(GetParam(), 20'000);
  for (Dealing dealing : {Dealing{.buffered = kMany}, Dealing{.buffered = 10'000},
                          Dealing{.capacity = 200, .buffered = 6'000, .block = 300},
                          Dealing{.capacity = 200, .buffered = 6'000, .evenly = true}}) {
    dealing.carry = true;
    const DealtTiles<2> dealt = deal_into_tiles<2>(points, dealing);
    EXPECT_EQ(fault_of(dealt, points), "");
    for (const DealtTile<2>& tile : dealt.tiles) {
      std::vector<std::byte> carried;
      for (const std::uint64_t index : tile.points.index) {
        std::ranges::copy(carried_by(index), std::back_inserter(carried));
      }
      ASSERT_TRUE(tile.points.attributes == carried);
    }
  }
}

TEST_P(TileTreeOfOrder, DividedEvenlyIsTheSameForAnyNumberOfThreads) {
  const Points points = make_points(GetParam(), kMany / 8);
  Dealing dealing{.capacity = 300, .buffered = 6'000, .block = 300, .threads = 1, .evenly = true};
  const DealtTiles<2> one = deal_into_tiles<2>(points, dealing);
  dealing.threads = 4;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const DealtTiles<2> four = deal_into_tiles<2>(points, dealing);
    EXPECT_EQ(one.written, four.written);
    ASSERT_EQ(one.tiles.size(), four.tiles.size());
    for (std::size_t t = 0; t < one.tiles.size(); ++t) {
      ASSERT_EQ(one.tiles[t].points.index, four.tiles[t].points.index) << "tile " << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, TileTreeOfOrder,
                         ::testing::Values(Order::kRandom, Order::kSorted, Order::kFlightLines,
                                           Order::kStrips, Order::kOutwards, Order::kCurve,
                                           Order::kSkewed, Order::kCluster, Order::kEqual,
                                           Order::kRepeated),
                         ::testing::PrintToStringParamName());

/// Buffers that hold a third of the points, and very few.
constexpr std::array kDealings = {Dealing{.buffered = 20'000},
                                  Dealing{.capacity = 200, .buffered = 6'000, .block = 300}};

TEST_P(TileTreeOfOrder, MakesCompactTilesUnlessPointsAreThinAndWritesTwiceAtMost) {
  const Points points = make_points(GetParam(), 60'000);
  for (const Dealing& dealing : kDealings) {
    const DealtTiles<2> dealt = deal_into_tiles<2>(points, dealing);
    EXPECT_EQ(count_of_too_long(dealt, dealing.capacity), 0U) << dealing.buffered;
    EXPECT_LE(dealt.writes(), 2.0) << dealing.buffered;
  }
}

TEST(TileTree, MakesCompactTilesInWhateverOrderPointsCome) {
  for (const Order order : {Order::kRandom, Order::kSorted, Order::kFlightLines, Order::kStrips,
                            Order::kOutwards, Order::kCurve}) {
    EXPECT_EQ(count_of_long(deal(make_points(order, kMany), kNothing)), 0U)
        << ::testing::PrintToString(order);
  }
}

TEST(TileTree, NestsWhereTheHeaderTellsWherePointsLieAndAfterItIsDividedEvenly) {
  const Points sorted = make_points(Order::kSorted, 60'000);
  Dealing dealing{.capacity = 200, .buffered = 30'000, .evenly = true};
  const DealtTiles<2> dealt = deal_into_tiles<2>(sorted, dealing);
  EXPECT_FALSE(dealt.nest_at_first);
  EXPECT_TRUE(dealt.nest);
  dealing.known = kAll;
  EXPECT_TRUE(deal_into_tiles<2>(sorted, dealing).nest_at_first);
}

/// Five to fifty equal points at each of many places, which lie close together in some spots.
Points at_many_places(Order order) {
  Points points = make_points(order, 30'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = i - i % (5 + i / 50 % 45);
    const double spot = std::floor(20 * points[place][0]) / 20;
    points[i][0] = spot + (points[place][0] - spot) * (points[place][1] < 0.5 ? 0.02 : 1);
    points[i][1] = points[place][1];
  }
  std::mt19937_64 random(5);
  if (order == Order::kRandom) std::ranges::shuffle(points, random);
  for (std::size_t i = 0; i < points.size(); ++i) points[i][2] = static_cast<double>(i);
  return points;
}

TEST(TileTree, DividedEvenlyKeepsTheOrderOfEqualPointsWhereTilesAreCutAgain) {
  for (const Order order : {Order::kRandom, Order::kFlightLines, Order::kStrips}) {
    const Points points = at_many_places(order);
    for (const std::size_t buffered : {4'000, 9'000, 20'000}) {
      const DealtTiles<2> dealt = deal_into_tiles<2>(
          points, {.capacity = 200, .buffered = buffered, .block = 250, .evenly = true});
      EXPECT_EQ(fault_of(dealt, points), "") << ::testing::PrintToString(order) << buffered;
      EXPECT_EQ(out_of_order(dealt), 0U) << ::testing::PrintToString(order) << buffered;
      EXPECT_EQ(apart_from_equal(dealt), 0U) << ::testing::PrintToString(order) << buffered;
    }
  }
}

TEST(TileTree, DividedEvenlyKeepsThePointsOfSpace) {
  const Points points = make_points(Order::kStrips, kMany / 4, false);
  const DealtTiles<3> dealt = deal_into_tiles<3>(
      points, {.capacity = 300, .buffered = 9'000, .known = kAll, .evenly = true});
  EXPECT_EQ(fault_of(dealt, points), "");
  EXPECT_EQ(out_of_order(dealt), 0U);
}

/// On a long ellipse, in random order.
Points on_an_ellipse(std::size_t count) {
  Points points = make_points(Order::kRandom, count);
  for (LatticePoint& p : points) {
    const double angle = 2 * std::numbers::pi * p[0];
    p[0] = std::cos(angle);
    p[1] = 0.6 * std::sin(angle);
  }
  return points;
}

/// Whether a point lies in a box of a sketch, and in its plate.
bool holds(const PointSketch<2>& sketch, const Point<2>& point) {
  const auto boxes = sketch.boxes.level(0);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    Plate<2> plate = sketch.plates[b];
    plate.expand(point);
    const double more = plate.thickness - sketch.plates[b].thickness;
    if (boxes[b].contains(point) && more <= 1e-9 * plate.radius) return true;
  }
  return false;
}

TEST(TileTree, CutsACurveAcrossAndKnowsWhereItsPointsLie) {
  const Points points = on_an_ellipse(60'000);
  for (const std::size_t buffered : {std::size_t{200'000}, std::size_t{24'000}}) {
    const DealtTiles<2> dealt =
        deal_into_tiles<2>(points, {.capacity = 6000, .buffered = buffered, .known = kNothing});
    EXPECT_EQ(dealt.written > 0, buffered < points.size());
    EXPECT_EQ(out_of_order(dealt), 0U) << buffered;
    std::size_t dealt_points = 0;
    std::size_t across = 0;
    for (const DealtTile<2>& tile : dealt.tiles) {
      dealt_points += tile.points.points.size();
      across += tile.box.lo[1] * tile.box.hi[1] < 0 ? 1 : 0;
      ASSERT_NE(tile.sketch, nullptr) << buffered;
      for (const Point<2>& p : tile.points.points) EXPECT_TRUE(holds(*tile.sketch, p)) << buffered;
    }
    EXPECT_EQ(dealt_points, points.size());
    EXPECT_GE(across, dealt.tiles.size() * 4 / 5) << buffered;
  }
}

TEST(TileTree, KeepsWhatNoCutWouldPayForInOnePieceIfThatMayBe) {
  Points points = make_points(Order::kRandom, 20'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // On two lines that cross; pairs of points have the same place on both.
    const double place = points[i - i % 2][0];
    points[i][0] = i % 2 == 0 ? place : 1 - place;
    points[i][1] = i % 2 == 0 ? 0.1 + 0.9 * place : place;
  }
  const Dealing dealing{.capacity = 15'000, .buffered = 200'000, .known = kNothing};
  EXPECT_GT(deal_into_tiles<2>(points, dealing).tiles.size(), 1U);
  Dealing whole = dealing;
  whole.largest_undivided = 30'000;
  EXPECT_EQ(deal_into_tiles<2>(points, whole).tiles.size(), 1U);
  const Points even = make_points(Order::kRandom, 20'000);
  EXPECT_GT(deal_into_tiles<2>(even, whole).tiles.size(), 1U);
  EXPECT_EQ(deal_into_tiles<2>(even, whole).tiles[0].sketch, nullptr);
}

TEST(TileTree, LeavesLongWhatIsThinItself) {
  Points points = make_points(Order::kRandom, kMany / 4);
  for (LatticePoint& p : points) p[1] *= 1e-6;
  const DealtTiles<2> dealt = deal(points, kNothing);
  EXPECT_EQ(fault_of(dealt, points), "");
  EXPECT_LE(dealt.tiles.size(), 2 * points.size() / kCapacity);
}

TEST(TileTree, WritesPointsTwiceAtMostWhereManyAreEqualAtEachOfManyPlaces) {
  for (const std::size_t places : {20U, 100U, 300U}) {
    for (const bool in_random_order : {false, true}) {
      Points points = make_points(Order::kRandom, 60'000);
      for (std::size_t i = 0; i < points.size(); i += 2) {
        const std::size_t place = in_random_order ? i / 2 % places : i * places / points.size();
        points[i][0] = points[2 * place + 1][0];
        points[i][1] = points[2 * place + 1][1];
      }
      const DealtTiles<2> dealt =
          deal_into_tiles<2>(points, {.capacity = 200, .buffered = 4'000, .block = 150});
      EXPECT_LE(dealt.writes(), 2.0) << places << " places, at random " << in_random_order;
      EXPECT_EQ(fault_of(dealt, points), "");
      EXPECT_EQ(out_of_order(dealt), 0U);
      EXPECT_EQ(apart_from_equal(dealt), 0U);
    }
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
        << ::testing::PrintToString(order);
  }
}

TEST(TileTree, WritesLittleTwiceInTheOrderOfAScanner) {
  for (const Order order : {Order::kSorted, Order::kFlightLines, Order::kCurve}) {
    EXPECT_LE(deal(make_points(order, kMany), kNothing).writes(), 1.02)
        << ::testing::PrintToString(order);
  }
}

TEST(TileTree, DealsAgainWhatALaterCutPartedOnTheDisk) {
  const DealtTiles<2> dealt =
      deal_into_tiles<2>(make_points(Order::kRandom, kMany), {.buffered = 20'000});
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
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  TileTreeOptions options{.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered};
  options.expected = 10;
  options.extent = Box<3>{};
  options.extent->expand(LatticePoint{1000, 1000, 0});
  with_threads(2, [&] {
    DealingWatch nobody;
    TileTree tree(options, *scratch, times, nobody);
    bool given = false;
    tree.fill([&](PointBlock& block) {
      block.points = given ? Points() : points;
      return !std::exchange(given, true);
    });
    tree.divide_large();
    const std::optional<TileNode<2>> root = tree.take_nodes<2>();
    ASSERT_TRUE(root);
    EXPECT_EQ(root->points, points.size());
  });
}

/// Points dealt again, of points in an order that hides where the others will lie, and a sample.
std::uint64_t dealt_again(const Points& points, const Points& sample) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  StageTimes times;
  TileTreeOptions options{.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered};
  options.expected = points.size();
  std::uint64_t divided = 0;
  with_threads(2, [&] {
    DealingWatch nobody;
    TileTree tree(options, *scratch, times, nobody);
    Box<3> extent;
    for (const LatticePoint& p : points) extent.expand(p);
    tree.expect(extent, sample);
    bool given = false;
    tree.fill([&](PointBlock& block) {
      block.points = given ? Points() : points;
      return !std::exchange(given, true);
    });
    divided = tree.divide_large();
    const std::optional<TileNode<2>> root = tree.take_nodes<2>();
    ASSERT_TRUE(root);
    EXPECT_EQ(root->points, points.size());
  });
  return divided;
}

TEST(TileTree, OfASampleIsRightFromTheFirstPointOn) {
  Points points = make_points(Order::kSorted, 250'000);
  std::ranges::sort(points, {}, [](const LatticePoint& p) { return p[0]; });
  // The last ones among the first, so that the first lie at both ends.
  std::rotate(points.begin() + 20'000, points.end() - 5'000, points.end());
  Points sample;
  for (std::size_t i = 0; i < points.size(); i += 23) sample.push_back(points[i]);
  EXPECT_EQ(dealt_again(points, sample), 0U);
  dealt_again(points, Points(sample.size(), points.front()));  // a sample that lies loses nothing
}

TEST(TileTree, SaysWhenTheDiskIsFull) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 10'000);
  StageTimes times;
  const Points points = make_points(Order::kRandom, 300'000);
  with_threads(2, [&] {
    DealingWatch nobody;
    TileTree tree({.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered}, *scratch,
                  times, nobody);
    bool given = false;
    try {
      tree.fill([&](PointBlock& block) {
        block.points = given ? Points() : points;
        return !std::exchange(given, true);
      });
      tree.divide_large();
      FAIL() << "the cap was not kept";
    } catch (const Failure& error) {
      EXPECT_EQ(error.facts().remedy, Remedy::kScratchLimit) << error.what();
    }
  });
}

}  // namespace
}  // namespace spillway::test
