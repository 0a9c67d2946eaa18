// The tree over tiles: balanced, with every tile once, the same in whatever order they come.

#include "stream/tiles/tile_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>

namespace spillway::test {
namespace {

template <typename Dimension>
class TreeOver : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TreeOver, Dimensions);

template <int D>
std::vector<TileNode<D>> random_tiles(std::uint32_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<TileNode<D>> tiles(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    Point<D> corner;
    for (double& x : corner) x = unit(random);
    tiles[t].box.expand(corner);
    for (double& x : corner) x += 0.05 * unit(random);
    tiles[t].box.expand(corner);
    tiles[t].points = 50 + random() % 50;
    tiles[t].stored = {t};
  }
  return tiles;
}

/// Puts the tiles of a tree into `stored`; boxes and points of nodes are those of what is below.
template <int D>
int check_below(const TileNode<D>& node, std::vector<std::uint32_t>& stored) {
  if (node.leaf()) {
    stored.insert(stored.end(), node.stored.begin(), node.stored.end());
    return 0;
  }
  EXPECT_EQ(node.children.size(), 2U);
  EXPECT_TRUE(node.stored.empty());
  Box<D> box;
  std::uint64_t points = 0;
  int depth = 0;
  for (const TileNode<D>& child : node.children) {
    depth = std::max(depth, 1 + check_below(child, stored));
    box.expand(child.box);
    points += child.points;
  }
  EXPECT_EQ(node.box, box);
  EXPECT_EQ(node.points, points);
  return depth;
}

template <int D>
int check(const TileNode<D>& root, std::size_t tiles) {
  std::vector<std::uint32_t> stored;
  const int depth = check_below(root, stored);
  std::ranges::sort(stored);
  EXPECT_EQ(stored.size(), tiles);
  for (std::uint32_t t = 0; t < stored.size(); ++t) EXPECT_EQ(stored[t], t);
  return depth;
}

template <int D>
void expect_equal(const TileNode<D>& a, const TileNode<D>& b) {
  EXPECT_EQ(a.box, b.box);
  EXPECT_EQ(a.stored, b.stored);
  ASSERT_EQ(a.children.size(), b.children.size());
  for (std::size_t i = 0; i < a.children.size(); ++i) expect_equal(a.children[i], b.children[i]);
}

TYPED_TEST(TreeOver, OneTileIsThatTile) {
  constexpr int D = TypeParam::value;
  const TileNode<D> tree = tree_over(random_tiles<D>(1, 1));
  EXPECT_TRUE(tree.leaf());
  EXPECT_EQ(check(tree, 1), 0);
}

TYPED_TEST(TreeOver, ManyIsBalancedAndHasEveryTileOnce) {
  constexpr int D = TypeParam::value;
  for (const std::uint32_t count : {2U, 3U, 10U, 100U, 1000U}) {
    const double most = 3 + 1.95 * std::log2(count);  // 0.7 of the points are below each node
    EXPECT_LE(check(tree_over(random_tiles<D>(count, count)), count), most);
  }
}

TYPED_TEST(TreeOver, DoesNotDependOnTheOrderOfTheTiles) {
  constexpr int D = TypeParam::value;
  std::vector<TileNode<D>> tiles = random_tiles<D>(200, 2);
  const TileNode<D> tree = tree_over(tiles);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::shuffle(tiles.begin(), tiles.end(), std::mt19937(seed));
    expect_equal(tree_over(tiles), tree);
  }
}

TYPED_TEST(TreeOver, PartsAGridWithoutOverlap) {
  constexpr int D = TypeParam::value;
  std::vector<TileNode<D>> tiles(64);
  for (std::uint32_t t = 0; t < 64; ++t) {
    Point<D> corner{};
    corner[0] = t % 8;
    corner[1] = t / 8;
    tiles[t].box.expand(corner);
    for (double& x : corner) x += 0.9;
    tiles[t].box.expand(corner);
    tiles[t].points = 10;
    tiles[t].stored = {t};
  }
  std::shuffle(tiles.begin(), tiles.end(), std::mt19937(1));
  const TileNode<D> tree = tree_over(std::move(tiles));
  EXPECT_EQ(check(tree, 64), 6);
  const auto visit = [](const auto& self, const TileNode<D>& node) -> void {
    if (node.leaf()) return;
    EXPECT_TRUE(common_part(node.children[0].box, node.children[1].box).empty());
    for (const TileNode<D>& child : node.children) self(self, child);
  };
  visit(visit, tree);
}

TYPED_TEST(TreeOver, EqualAndFlatBoxesIsBalanced) {
  constexpr int D = TypeParam::value;
  for (const bool points : {false, true}) {
    std::vector<TileNode<D>> tiles = random_tiles<D>(64, 3);
    for (TileNode<D>& tile : tiles) {
      tile.box.lo.fill(0);
      tile.box.hi.fill(0);
      if (!points) tile.box.hi[0] = 1;
      tile.points = 10;
    }
    EXPECT_EQ(check(tree_over(std::move(tiles)), 64), 6);
  }
}

}  // namespace
}  // namespace spillway::test
