#include "stream/ground/tile_index.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

namespace spillway::test {
namespace {

Box<2> box(double x, double y, double width, double height) {
  Box<2> made;
  made.expand(Point<2>{x, y});
  made.expand(Point<2>{x + width, y + height});
  return made;
}

TEST(TileIndex, FindsAllTilesOfABoxAndNoOthers) {
  std::mt19937 random(3);
  const auto number = [&](int most) {
    return static_cast<double>(random() % static_cast<unsigned>(most));
  };
  std::vector<TileNode<2>> leaves;
  for (int i = 0; i < 300; ++i) {
    TileNode<2> leaf;
    leaf.box = box(number(1000), number(1000), number(90), number(90));
    leaf.points = 1 + static_cast<std::uint64_t>(number(50));
    leaves.push_back(leaf);
  }
  const TileNode<2> root = tree_over(leaves);
  const TileIndex index(root);
  ASSERT_EQ(index.tiles().size(), leaves.size());
  for (const int most : {5, 100, 2000}) {  // some lie in one tile, others reach over all of them
    std::vector<NumberedBox> boxes;
    for (std::uint32_t b = 0; b < 40; ++b) {
      boxes.push_back({box(number(1200) - 100, number(1200) - 100, number(most), number(most)), b});
    }
    std::map<std::uint32_t, std::set<std::uint32_t>> found;
    index.visit(boxes, [&](std::uint32_t tile, std::span<const NumberedBox> some) {
      EXPECT_FALSE(some.empty());
      for (const NumberedBox& one : some) EXPECT_TRUE(found[tile].insert(one.number).second);
    });
    for (std::uint32_t t = 0; t < index.tiles().size(); ++t) {
      std::set<std::uint32_t> expected;
      for (const NumberedBox& one : boxes) {
        if (!common_part(index.tiles()[t]->box, one.box).empty()) expected.insert(one.number);
      }
      EXPECT_EQ(found[t], expected) << "tile " << t;
    }
  }
}

TEST(TileIndex, HasNothingToFindWhereThereIsNothing) {
  const TileIndex none;
  const std::vector<NumberedBox> boxes = {{box(0, 0, 1, 1), 0}};
  none.visit(boxes, [](std::uint32_t, std::span<const NumberedBox>) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace spillway::test
