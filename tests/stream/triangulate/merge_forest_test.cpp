#include "stream/triangulate/merge_forest.h"

#include <gtest/gtest.h>

#include <string>

namespace spillway::detail {
namespace {

struct Named {
  std::string name;
};
using Forest = MergeForest<Named>;

TEST(MergeForest, NumbersNodesAsTheyCome) {
  Forest forest;
  Forest::Node* const a = forest.add({"a"}, {}).node;
  Forest::Node* const b = forest.add({"b"}, {}).node;
  Forest::Node* const both = forest.add({"both"}, {a, b}).node;
  EXPECT_EQ(a->number, 0U);
  EXPECT_EQ(b->number, 1U);
  EXPECT_EQ(both->number, 2U);
  EXPECT_EQ(both->name, "both");
  EXPECT_EQ(both->children, (std::vector<Forest::Node*>{a, b}));
}

TEST(MergeForest, LeadsToTheParentOnceAfterTheLastChild) {
  Forest forest;
  const auto a = forest.add({"a"}, {});
  const auto b = forest.add({"b"}, {});
  EXPECT_TRUE(a.ready);
  const auto both = forest.add({"both"}, {a.node, b.node});
  EXPECT_FALSE(both.ready);
  EXPECT_EQ(forest.done(*b.node), nullptr);
  EXPECT_EQ(forest.done(*a.node), both.node);
  EXPECT_EQ(forest.done(*both.node), nullptr);
}

TEST(MergeForest, AParentThatComesAfterItsChildrenAreDoneIsReady) {
  Forest forest;
  const auto a = forest.add({"a"}, {});
  const auto b = forest.add({"b"}, {});
  EXPECT_EQ(forest.done(*a.node), nullptr);
  EXPECT_EQ(forest.done(*b.node), nullptr);
  EXPECT_TRUE(forest.add({"both"}, {a.node, b.node}).ready);
}

TEST(MergeForest, AParentThatComesInBetweenWaitsForTheRest) {
  Forest forest;
  const auto a = forest.add({"a"}, {});
  const auto b = forest.add({"b"}, {});
  EXPECT_EQ(forest.done(*a.node), nullptr);
  const auto both = forest.add({"both"}, {a.node, b.node});
  EXPECT_FALSE(both.ready);
  EXPECT_EQ(forest.done(*b.node), both.node);
}

}  // namespace
}  // namespace spillway::detail
