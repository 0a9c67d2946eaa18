// What a run that goes on knows of the nodes that were done before it was killed.

#include "stream/triangulate/nodes_before.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "formats/disk/private_file.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "stream/triangulate/merge_forest.h"

namespace spillway::test {
namespace {

struct WithBorder {
  Border<2> border;
};
using Forest = MergeForest<WithBorder>;

/// A border that is told by its number of vertices.
Border<2> border_of(std::size_t vertices) {
  Border<2> border;
  border.dimension = 2;
  border.vertices.resize(vertices);
  return border;
}

class NodesBeforeTest : public ::testing::Test {
 protected:
  NodesBeforeTest() {
    std::string name = ::testing::TempDir() + "nodes_before_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~NodesBeforeTest() override { std::filesystem::remove_all(folder_); }

  /// As an engine keeps them: how many nodes are done, and the borders of those left over.
  [[nodiscard]] NodesBefore<2> kept_of(Forest& forest, std::uint32_t done) const {
    const std::string path = (folder_ / "state").string();
    StateWriter writer(create_private_file(path, path));
    std::uint64_t kept = 0;
    forest.visit_left_over([&](const Forest::Node&) { ++kept; });
    writer(done, kept);
    forest.visit_left_over([&](Forest::Node& node) { writer(node.number, node.border); });
    writer.finish();
    return read(path);
  }

  /// As a run writes them that was killed before it added any node.
  [[nodiscard]] NodesBefore<2> kept_of(NodesBefore<2>& before) const {
    const std::string path = (folder_ / "again").string();
    StateWriter writer(create_private_file(path, path));
    writer(before);
    writer.finish();
    return read(path);
  }

 private:
  static NodesBefore<2> read(const std::string& path) {
    StateReader reader(disk().open(path), "the folder");
    NodesBefore<2> before;
    reader(before);
    reader.finish();
    return before;
  }

  std::filesystem::path folder_;
};

/// Leaves 0, 1, 3 and 4; 2 is above the first two, 5 above the others, and 6 above all.
struct Tree {
  Forest forest;
  std::vector<Forest::Node*> nodes;

  Tree() {
    add({});
    add({});
    add({nodes[0], nodes[1]});
    add({});
    add({});
    add({nodes[3], nodes[4]});
    add({nodes[2], nodes[5]});
  }
  void add(std::vector<Forest::Node*> children) {
    nodes.push_back(forest.add({border_of(10 + nodes.size())}, std::move(children)).node);
  }
  /// All below that number, as when work is at rest; those that went into others have no border.
  void do_all_below(std::uint32_t number) {
    for (std::uint32_t n = 0; n < number; ++n) {
      for (Forest::Node* child : nodes[n]->children) child->border = {};
      forest.done(*nodes[n]);
    }
  }
};

TEST_F(NodesBeforeTest, OfARunThatBeginsAreNone) {
  NodesBefore<2> before;
  EXPECT_FALSE(before.has(0));
  EXPECT_TRUE(before.take_border(0).vertices.empty());
}

TEST_F(NodesBeforeTest, HaveTheBordersThatStillGoIntoOthersAndNoMore) {
  const std::vector<std::vector<std::uint32_t>> left_over{{},     {0},       {0, 1}, {2},
                                                          {2, 3}, {2, 3, 4}, {2, 5}, {6}};
  for (std::uint32_t done = 0; done <= 7; ++done) {
    Tree tree;
    tree.do_all_below(done);
    NodesBefore<2> before = kept_of(tree.forest, done);
    std::vector<std::uint32_t> with_border;
    for (std::uint32_t n = 0; n < 8; ++n) {
      EXPECT_EQ(before.has(n), n < done) << n << " of " << done;
      const std::size_t vertices = before.take_border(n).vertices.size();
      if (vertices == 0) continue;
      EXPECT_EQ(vertices, 10 + n);
      with_border.push_back(n);
    }
    EXPECT_EQ(with_border, left_over[done]);
  }
}

TEST_F(NodesBeforeTest, GiveABorderOnce) {
  Tree tree;
  tree.do_all_below(3);
  NodesBefore<2> before = kept_of(tree.forest, 3);
  EXPECT_EQ(before.take_border(2).vertices.size(), 12U);
  EXPECT_TRUE(before.take_border(2).vertices.empty());
  EXPECT_TRUE(before.has(2));
}

TEST_F(NodesBeforeTest, AreTheSameInARunThatIsKilledOnceMore) {
  Tree tree;
  tree.do_all_below(5);
  NodesBefore<2> first = kept_of(tree.forest, 5);
  NodesBefore<2> second = kept_of(first);
  EXPECT_TRUE(second.has(4));
  EXPECT_FALSE(second.has(5));
  for (const std::uint32_t n : {2, 3, 4}) {
    EXPECT_EQ(second.take_border(n).vertices.size(), 10 + n);
  }
}

}  // namespace
}  // namespace spillway::test
