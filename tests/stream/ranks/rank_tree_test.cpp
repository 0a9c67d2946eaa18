// The tree over the tiles of all ranks: the same at all of them, with the ranks below each node as
// its members and everything else outside.

#include "stream/ranks/rank_tree.h"
#include "stream/tiles/cuts/sample_division.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "src/runtime/packing.h"
#include "tests/distributed/world.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Ranks side by side along x, one a unit.
RankDivision division_of(int ranks) {
  RankDivision division{CutTree(2), {}};
  std::vector<LatticePoint> sample;
  for (int i = 0; i < 100 * ranks; ++i) sample.push_back({i / 100.0, 0, 0});
  division.cuts.split(0, divide_sample_evenly(sample, static_cast<std::size_t>(ranks), 2));
  division.rank_of_tile.resize(division.cuts.tiles());
  for (int rank = 0; rank < ranks; ++rank) {
    const LatticePoint middle{rank + 0.5, 0, 0};
    std::uint32_t tile = 0;
    division.cuts.find_tiles(std::span(&middle, 1), std::span(&tile, 1));
    division.rank_of_tile[tile] = rank;
  }
  return division;
}

/// Two tiles of a rank, with 10 and 100 points for each rank up to it.
TileNode<2> tiles_of(int rank) {
  TileNode<2> root;
  for (const double x : {rank + 0.1, rank + 0.6}) {
    TileNode<2>& tile = root.children.emplace_back();
    tile.box.expand(Point<2>{x, 0});
    tile.box.expand(Point<2>{x + 0.3, 1});
    tile.points = static_cast<std::uint64_t>(rank + 1) * (root.children.size() == 1 ? 10 : 100);
    tile.stored = {static_cast<std::uint32_t>(root.children.size())};
    root.box.expand(tile.box);
    root.points += tile.points;
  }
  return root;
}

/// Points of the tiles outside and inside of a node.
std::uint64_t points_around(const RankTree<2>::Node& node) {
  std::uint64_t points = node.tiles->points;
  for (const TileNode<2>* tile : node.outside) points += tile->points;
  return points;
}

TEST(RankTree, CoversAllTilesOfAllRanks) {
  const int ranks = world().size();
  const RankTree<2> tree(division_of(ranks), tiles_of(world().rank()), world());
  const auto& nodes = tree.nodes();
  ASSERT_EQ(nodes.size(), static_cast<std::size_t>(2 * ranks - 1));
  const auto root_points = static_cast<std::uint64_t>(110 * ranks * (ranks + 1) / 2);
  EXPECT_EQ(nodes.back().tiles->points, root_points);
  EXPECT_EQ(nodes.back().tiles->box.lo[0], 0.1);
  EXPECT_EQ(nodes.back().tiles->box.hi[0], tiles_of(ranks - 1).box.hi[0]);
  EXPECT_THAT(nodes.back().outside, IsEmpty());
  std::vector<int> members_of_tiles;
  std::uint32_t sections = 0;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    EXPECT_EQ(points_around(nodes[n]), root_points) << "node " << n;
    EXPECT_EQ(nodes[n].first_section, sections) << "sections follow each other";
    sections += nodes[n].sections();
    if (!nodes[n].is_merge()) {
      EXPECT_EQ(nodes[n].end, nodes[n].first + 1);
      EXPECT_EQ(nodes[n].section(nodes[n].first), nodes[n].first_section);
      members_of_tiles.push_back(nodes[n].first);
      continue;
    }
    const auto& low = nodes[nodes[n].below[0]];
    const auto& high = nodes[nodes[n].below[1]];
    EXPECT_LT(nodes[n].below[0], nodes[n].below[1]);
    EXPECT_LT(nodes[n].below[1], n) << "children come before parents";
    EXPECT_EQ(nodes[n].first, low.first);
    EXPECT_EQ(low.end, high.first);
    EXPECT_EQ(nodes[n].end, high.end);
    EXPECT_EQ(nodes[n].section(nodes[n].end - 1, MergeStep::kFinalize), sections - 1);
    EXPECT_EQ(nodes[n].section(nodes[n].first, MergeStep::kEmit),
              nodes[n].section(nodes[n].end - 1, MergeStep::kAnnounce) + 1);
    EXPECT_EQ(nodes[n].level, std::max(low.level, high.level) + 1);
    EXPECT_EQ(nodes[n].tiles->points, low.tiles->points + high.tiles->points);
  }
  EXPECT_TRUE(std::is_sorted(members_of_tiles.begin(), members_of_tiles.end()));
  EXPECT_EQ(members_of_tiles.size(), static_cast<std::size_t>(ranks));
  EXPECT_EQ(tree.sections(), sections);
}

TEST(RankTree, IsTheSameAtAllRanks) {
  const RankTree<2> tree(division_of(world().size()), tiles_of(world().rank()), world());
  Packer packer;
  for (const auto& node : tree.nodes()) {
    packer.put(node.first);
    packer.put(node.end);
    packer.put(node.level);
    packer.put(node.tiles->box);
    packer.put(std::uint64_t{node.outside.size()});
  }
  for (const auto& bytes : world().gather(packer.bytes())) {
    EXPECT_TRUE(
        std::equal(bytes.begin(), bytes.end(), packer.bytes().begin(), packer.bytes().end()));
  }
}

TEST(RankTree, KnowsHowTheOwnTilesAreStoredAndNoOthers) {
  const RankTree<2> tree(division_of(world().size()), tiles_of(world().rank()), world());
  ASSERT_TRUE(tree.own_node());
  for (std::uint32_t n = 0; n < tree.nodes().size(); ++n) {
    const auto& node = tree.nodes()[n];
    if (node.is_merge()) continue;
    EXPECT_EQ(n == *tree.own_node(), tree.members()[node.first] == world().rank());
    if (n == *tree.own_node()) {
      EXPECT_THAT(node.tiles->children[1].stored, ElementsAre(2));
    } else {
      EXPECT_THAT(node.tiles->children[1].stored, IsEmpty());
    }
  }
}

TEST(RankTree, LeavesOutRanksWithoutPoints) {
  const int rank = world().rank();
  const std::optional<TileNode<2>> own =
      rank % 2 == 0 ? std::optional(tiles_of(rank)) : std::nullopt;
  const RankTree<2> tree(division_of(world().size()), own, world());
  const int with_points = (world().size() + 1) / 2;
  EXPECT_EQ(tree.nodes().size(), static_cast<std::size_t>(2 * with_points - 1));
  EXPECT_EQ(tree.own_node().has_value(), own.has_value());
  for (const int member : tree.members()) EXPECT_EQ(member % 2, 0);
}

TEST(RankTree, OfNoPointsIsEmpty) {
  const RankTree<3> tree(division_of(world().size()), std::nullopt, world());
  EXPECT_THAT(tree.nodes(), IsEmpty());
  EXPECT_FALSE(tree.own_node());
}

}  // namespace
}  // namespace spillway::test
