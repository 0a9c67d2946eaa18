#include "stream/triangulate/merge_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>

#include "src/geometry/box.h"
#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Shape {
  std::vector<Shape> children;
  Box<2> box{};

  [[nodiscard]] std::uint64_t size() const {
    std::uint64_t leaves = leaf() ? 1 : 0;
    for (const Shape& child : children) leaves += child.size();
    return leaves;
  }
  [[nodiscard]] bool leaf() const { return children.empty(); }
};

struct Visit {
  int merges = 0;
};
using Tree = MergeTree<Shape, Visit>;

/// Numbers in post-order: (0 1)2 (3 4 5)6, root 7.
Shape two_and_three() { return {{{{{}, {}}}, {{{}, {}, {}}}}}; }

/// A tree of so many levels above its leaves.
Shape full(int levels, std::size_t children) {
  Shape shape;
  if (levels > 0) shape.children.assign(children, full(levels - 1, children));
  return shape;
}

TEST(MergeTree, NumbersNodesInPostOrder) {
  const Shape shape = two_and_three();
  Tree tree(shape);
  std::vector<std::uint32_t> numbers;
  for (const Tree::Node& node : tree.nodes()) numbers.push_back(node.number);
  EXPECT_THAT(numbers, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(&tree.root(), &tree.nodes()[7]);
  EXPECT_EQ(tree.root().tree, &shape);
  EXPECT_THAT(tree.root().children, ElementsAre(&tree.nodes()[2], &tree.nodes()[6]));
  std::vector<std::uint32_t> leaves;
  for (const Tree::Node* leaf : tree.leaves()) leaves.push_back(leaf->number);
  EXPECT_THAT(leaves, ElementsAre(0, 1, 3, 4, 5));
  EXPECT_EQ(tree.nodes()[4].parent, &tree.nodes()[6]);
  EXPECT_EQ(tree.root().parent, nullptr);
}

TEST(MergeTree, SiblingsUpAreTheRestOfTheTree) {
  const Shape shape = two_and_three();
  Tree tree(shape);
  const auto& [left, right] = std::tie(shape.children[0], shape.children[1]);
  EXPECT_THAT(tree.siblings_up(tree.nodes()[4]),
              ElementsAre(&right.children[0], &right.children[2], &left));
  EXPECT_THAT(tree.siblings_up(tree.nodes()[2]), ElementsAre(&right));
  EXPECT_THAT(tree.siblings_up(tree.root()), IsEmpty());
  EXPECT_THAT(tree.siblings_by_level(tree.nodes()[4]),
              ElementsAre(ElementsAre(&right.children[0], &right.children[2]), ElementsAre(&left)));
  EXPECT_THAT(tree.siblings_by_level(tree.root()), IsEmpty());
}

TEST(MergeTree, MergesWhenTheLastChildIsDone) {
  const Shape shape = two_and_three();
  Tree tree(shape);
  std::vector<std::uint32_t> merged;
  const auto merge = [&merged](const Tree::Node& node) { merged.push_back(node.number); };
  for (const int leaf : {1, 5, 3, 0}) tree.leaf_done(tree.nodes()[leaf], merge);
  EXPECT_THAT(merged, ElementsAre(2));
  tree.leaf_done(tree.nodes()[4], merge);
  EXPECT_THAT(merged, ElementsAre(2, 6, 7));
}

TEST(MergeTree, OfOneLeafHasNothingToMerge) {
  const Shape shape;
  Tree tree(shape);
  tree.leaf_done(*tree.leaves()[0], [](Tree::Node&) { FAIL(); });
  EXPECT_EQ(&tree.root(), tree.leaves()[0]);
}

TEST(MergeTree, EachNodeIsMergedOnceAfterItsChildrenByAnyThreads) {
  const Shape shape = full(5, 4);
  Tree tree(shape);
  with_threads(4, [&] {
    parallel_for(tree.leaves().size(), 1, [&](std::size_t, std::size_t begin, std::size_t) {
      Tree::Node& leaf = *tree.leaves()[begin];
      ++leaf.merges;
      tree.leaf_done(leaf, [](Tree::Node& node) {
        ++node.merges;
        for (const Tree::Node* child : node.children) EXPECT_EQ(child->merges, 1);
      });
    });
  });
  for (const Tree::Node& node : tree.nodes()) EXPECT_EQ(node.merges, 1);
}

}  // namespace
}  // namespace spillway::test
