// Points of any order and number end up in tiles of at most the capacity, all of them, once.

#include "stream/tiles/tile_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kCapacity = 1000;
constexpr std::size_t kBuffered = 40 * PointBuffer::kChunk;

using Points = std::vector<LatticePoint>;

enum class Order { kRandom, kSorted, kFlightLines, kSkewed, kEqual };

void PrintTo(Order order, std::ostream* out) {
  constexpr std::array kNames = {"Random", "Sorted", "FlightLines", "Skewed", "Equal"};
  *out << kNames.at(static_cast<std::size_t>(order));
}

Points make_points(Order order, std::size_t count) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  Points points(count);
  for (LatticePoint& p : points) p = {unit(random), unit(random), 100 * unit(random)};
  switch (order) {
    case Order::kRandom:
      break;
    case Order::kSorted:
      std::sort(points.begin(), points.end());
      break;
    case Order::kFlightLines:
      std::sort(points.begin(), points.end(), [](const LatticePoint& a, const LatticePoint& b) {
        return std::floor(20 * a[0]) != std::floor(20 * b[0]) ? a[0] < b[0] : a[1] < b[1];
      });
      break;
    case Order::kSkewed:  // nine tenths in a hundredth of the area
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 10 == 0) continue;
        points[i][0] *= 0.1;
        points[i][1] *= 0.1;
      }
      break;
    case Order::kEqual:  // half of them
      for (std::size_t i = 0; i < count; i += 2) points[i] = {0.25, 0.75, points[i][2]};
      break;
  }
  return points;
}

struct Knowledge {
  bool count = false;
  bool extent = false;
};

struct Filled {
  Points points;  ///< of all tiles, sorted
  std::size_t largest = 0;
  std::size_t tiles = 0;
  double writes = 0;  ///< of a point, on average
  std::uint64_t to_divide = 0;
  std::uint64_t divided = 0;
};

Filled fill(const Points& points, Knowledge known, unsigned threads = 2) {
  const auto scratch = make_scratch_folder(testing::TempDir(), std::nullopt);
  StageTimes times;
  TileTreeOptions options{.dimension = 2, .capacity = kCapacity, .buffered_points = kBuffered};
  if (known.count) options.expected = points.size();
  if (known.extent) {
    options.extent = Box<3>();
    for (const LatticePoint& p : points) options.extent->expand(p);
  }
  Filled filled;
  with_threads(threads, [&] {
    TileTree tree(options, *scratch, times);
    std::size_t next = 0;
    tree.fill([&](PointBlock& block) {
      const std::size_t count = std::min<std::size_t>(777, points.size() - next);
      const auto begin = points.begin() + static_cast<std::ptrdiff_t>(next);
      block.points.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
      next += count;
      return count > 0;
    });
    std::uint64_t told = 0;
    double share = 0;
    filled.to_divide = tree.points_to_divide();
    filled.divided = tree.divide_large([&](std::uint64_t dealt, double fraction) {
      EXPECT_GE(dealt, told);
      EXPECT_GE(fraction, share);
      EXPECT_LE(fraction, 1);
      told = dealt;
      share = fraction;
    });
    EXPECT_LE(told, filled.divided);
    EXPECT_EQ(tree.points_to_divide(), 0U);
    const auto visit = [&](const auto& self, const TileNode<2>& node) -> void {
      for (const auto& child : node.children) self(self, child);
      if (!node.children.empty()) return;
      const TilePoints<2> tile = tree.decode<2>(tree.read(node));
      ++filled.tiles;
      EXPECT_EQ(tile.points.size(), node.points);
      Box<2> box;
      for (std::size_t i = 0; i < tile.points.size(); ++i) {
        box.expand(tile.points[i]);
        filled.points.push_back({tile.points[i][0], tile.points[i][1], tile.heights[i]});
      }
      EXPECT_EQ(box, node.box);
      if (box.lo != box.hi) filled.largest = std::max(filled.largest, tile.points.size());
    };
    if (const auto root = tree.nodes<2>()) visit(visit, *root);
    filled.writes = static_cast<double>(tree.points_written()) / static_cast<double>(points.size());
  });
  std::sort(filled.points.begin(), filled.points.end());
  return filled;
}

class TileTreeOfOrder : public testing::TestWithParam<Order> {};

TEST_P(TileTreeOfOrder, KeepsEveryPointInTilesOfTheCapacity) {
  Points points = make_points(GetParam(), 300'000);
  for (const Knowledge known : {Knowledge{}, Knowledge{true, false}, Knowledge{true, true}}) {
    SCOPED_TRACE(testing::Message()
                 << "count known " << known.count << ", extent " << known.extent);
    const Filled filled = fill(points, known);
    EXPECT_LE(filled.largest, kCapacity);
    EXPECT_LE(filled.writes, 2.0);
    EXPECT_GE(filled.divided, filled.to_divide);
    Points expected = points;
    std::sort(expected.begin(), expected.end());
    EXPECT_TRUE(filled.points == expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, TileTreeOfOrder,
                         testing::Values(Order::kRandom, Order::kSorted, Order::kFlightLines,
                                         Order::kSkewed, Order::kEqual),
                         testing::PrintToStringParamName());

TEST(TileTree, WritesEveryPointOnceWhenTheHeaderTellsTheTruth) {
  for (const Order order : {Order::kRandom, Order::kSorted, Order::kFlightLines}) {
    EXPECT_LE(fill(make_points(order, 300'000), {true, true}).writes, 1.02)
        << static_cast<int>(order);
  }
}

TEST(TileTree, DividesTilesAgainThatFillWithoutNotice) {
  const Filled filled = fill(make_points(Order::kSorted, 300'000), {});
  EXPECT_GT(filled.to_divide, kCapacity);
  EXPECT_EQ(fill(make_points(Order::kRandom, 5'000), {}).divided, 0U);
}

TEST(TileTree, WritesNothingIfEverythingFits) {
  const Filled filled = fill(make_points(Order::kRandom, 5'000), {});
  EXPECT_EQ(filled.writes, 0);
  EXPECT_GT(filled.tiles, 4U);
}

TEST(TileTree, TakesEqualPointsAsOneTileWhateverTheirNumber) {
  const Filled filled = fill(Points(200'000, LatticePoint{1, 2, 3}), {});
  EXPECT_EQ(filled.tiles, 1U);
  EXPECT_EQ(filled.points.size(), 200'000U);
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
