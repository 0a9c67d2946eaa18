#include "stream/triangulate/cell_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Four unit squares side by side, a cell each: numbers 0 to 3 from the left.
RegionPlan four_cells() {
  std::vector<InputRegion> regions;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto x = static_cast<double>(i);
    regions.push_back({i, Box<3>{{x, 0, 0}, {x + 1, 1, 0}}, 100});
  }
  return plan_regions(regions, {.most_points = 120});
}

std::uint32_t cell_at(const RegionPlan& plan, double x) {
  std::uint32_t cell = 0;
  plan.cuts.find_tiles(std::vector<LatticePoint>{{x, 0.5, 0}}, std::span(&cell, 1));
  return cell;
}

TileNode<2> tile(double x) {
  TileNode<2> node;
  node.box = {{x, 0.25}, {x + 0.5, 0.75}};
  node.points = 10;
  return node;
}

TEST(CellTree, TellsOfOthersWhatIsKnown) {
  const RegionPlan plan = four_cells();
  CellTree<2> tree(plan);
  const auto first = tree.complete(cell_at(plan, 0.5), tile(0.2));
  EXPECT_EQ(first.node->box, tile(0.2).box);
  EXPECT_THAT(first.joins, IsEmpty());
  ASSERT_THAT(first.outside, SizeIs(2));
  EXPECT_EQ(first.outside[0]->box.hi, (Point<2>{std::nextafter(2.0, 0), 1})) << "not complete";
  EXPECT_EQ(first.outside[1]->box, (Box<2>{{2, 0}, {4, 1}}));
  EXPECT_THAT(first.outside[1]->children, SizeIs(2));
  const auto third = tree.complete(cell_at(plan, 2.5), tile(2.2));
  ASSERT_THAT(third.outside, SizeIs(2));
  EXPECT_EQ(third.outside[1]->box.lo, (Point<2>{0.2, 0}));
  EXPECT_EQ(third.outside[1]->children[0].box, tile(0.2).box) << "complete";
  EXPECT_EQ(first.outside[1]->children[0].box.lo[0], 2) << "as it was";
}

TEST(CellTree, JoinsWhatIsCompleteFromBelowUpwards) {
  const RegionPlan plan = four_cells();
  CellTree<2> tree(plan);
  std::vector<std::size_t> parts;
  for (const double x : {0.5, 1.5, 2.5}) {
    parts.push_back(tree.complete(cell_at(plan, x), tile(x)).part);
  }
  const auto last = tree.complete(cell_at(plan, 3.5), tile(3.5));
  ASSERT_THAT(last.joins, SizeIs(2));
  EXPECT_THAT(last.joins[0].below, ElementsAre(parts[2], last.part));
  EXPECT_EQ(last.joins[0].node->box, (Box<2>{{2.5, 0.25}, {4, 0.75}}));
  EXPECT_THAT(last.joins[0].outside, SizeIs(1));
  EXPECT_EQ(last.joins[1].node->points, 40U);
  EXPECT_EQ(last.joins[1].below[1], last.joins[0].part);
  EXPECT_THAT(last.joins[1].outside, IsEmpty());
}

TEST(CellTree, CellsWithoutPointsDropOut) {
  const RegionPlan plan = four_cells();
  CellTree<2> tree(plan);
  const auto first = tree.complete(cell_at(plan, 0.5), tile(0.2));
  tree.complete(cell_at(plan, 2.5), std::nullopt);
  EXPECT_FALSE(tree.complete(cell_at(plan, 1.5), std::nullopt).node);
  const auto last = tree.complete(cell_at(plan, 3.5), tile(3.2));
  ASSERT_THAT(last.outside, SizeIs(1));
  EXPECT_EQ(last.outside[0], first.node);
  ASSERT_THAT(last.joins, SizeIs(1));
  EXPECT_THAT(last.joins[0].below, ElementsAre(first.part, last.part));
}

TEST(CellTree, WhatIsLeftAloneIsSettledOnceMore) {
  const RegionPlan plan = four_cells();
  CellTree<2> tree(plan);
  tree.complete(cell_at(plan, 0.5), tile(0.2));
  const auto second = tree.complete(cell_at(plan, 1.5), tile(1.2));
  ASSERT_THAT(second.joins, SizeIs(1));
  EXPECT_THAT(second.joins[0].outside, SizeIs(1));
  tree.complete(cell_at(plan, 2.5), std::nullopt);
  const auto last = tree.complete(cell_at(plan, 3.5), std::nullopt);
  ASSERT_THAT(last.joins, SizeIs(1));
  EXPECT_THAT(last.joins[0].below, ElementsAre(second.joins[0].part));
  EXPECT_THAT(last.joins[0].node->children, SizeIs(1));
  EXPECT_THAT(last.joins[0].outside, IsEmpty());
  EXPECT_LT(last.joins[0].part, tree.parts());
}

TEST(CellTree, WhatKnewThatItIsAloneIsNotSettledAgain) {
  const RegionPlan plan = four_cells();
  CellTree<2> tree(plan);
  for (const double x : {0.5, 1.5, 2.5}) tree.complete(cell_at(plan, x), std::nullopt);
  const auto last = tree.complete(cell_at(plan, 3.5), tile(3.2));
  EXPECT_THAT(last.outside, IsEmpty());
  EXPECT_THAT(last.joins, IsEmpty());
}

}  // namespace
}  // namespace spillway::test
