#include "formats/meshes/common/stream_vertices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "formats/meshes/common/import_check.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

MeshStreamBlock block_of(std::size_t fresh, std::vector<std::uint64_t> imported,
                         std::vector<std::uint32_t> finalized) {
  MeshStreamBlock block;
  block.vertices.resize(fresh);
  block.imported = std::move(imported);
  block.finalized = std::move(finalized);
  return block;
}

TEST(StreamVertices, AreThoseThatABlockAnnouncesAndNoneFinalizes) {
  StreamVertices<char> live;
  live.settle(block_of(4, {}, {1}), std::vector<char>{'a', 'b', 'c', 'd'});
  EXPECT_EQ(live.announced(), 4U);
  EXPECT_EQ(live.size(), 3U);
  EXPECT_FALSE(live.contains(1));
  const MeshStreamBlock next = block_of(1, {3, 0}, {0, 2});
  std::vector<char> values = {'e'};
  live.append_imported(next, values);
  EXPECT_THAT(values, ElementsAre('e', 'd', 'a'));
  live.settle(next, values);
  EXPECT_EQ(live.announced(), 5U);
  std::map<std::uint64_t, char> left;
  live.for_each([&left](std::uint64_t number, char value) { left.emplace(number, value); });
  EXPECT_EQ(left, (std::map<std::uint64_t, char>{{2, 'c'}, {3, 'd'}}));
}

TEST(StreamVertices, RefuseImportsOfOthers) {
  StreamVertices<char> live;
  live.settle(block_of(2, {}, {1}), std::vector<char>{'a', 'b'});
  std::vector<char> values;
  EXPECT_THROW(live.append_imported(block_of(0, {1}, {}), values), std::out_of_range);
  EXPECT_THROW(live.append_imported(block_of(0, {2}, {}), values), std::out_of_range);
  EXPECT_THROW(live.append_imported(block_of(0, {~std::uint64_t{0}}, {}), values),
               std::out_of_range);
}

TEST(StreamVertices, AreEnteredAndForgottenOneByOne) {
  StreamVertices<int> live;
  live.enter(7, 70);
  live.announce(10);
  EXPECT_EQ(live.announced(), 10U);
  ASSERT_NE(live.find(7), nullptr);
  *live.find(7) = 71;
  EXPECT_EQ(*std::as_const(live).find(7), 71);
  EXPECT_TRUE(live.forget(7));
  EXPECT_FALSE(live.forget(7));
  EXPECT_EQ(live.size(), 0U);
}

TEST(StreamVertices, OfALongStreamAreThoseOfASet) {
  StreamVertices<std::uint64_t> live;
  std::set<std::uint64_t> expected;
  std::mt19937 random(5);  // NOLINT(bugprone-random-generator-seed)
  for (int step = 0; step < 300; ++step) {
    MeshStreamBlock block = block_of(random() % 40, {}, {});
    const std::uint64_t first = live.announced();
    for (const std::uint64_t number : expected) {
      if (random() % 3 == 0) block.imported.push_back(number);
    }
    const std::size_t fresh = block.vertices.size();
    for (std::uint32_t v = 0; v < fresh + block.imported.size(); ++v) {
      const bool ends = random() % 2 == 0;
      if (ends) block.finalized.push_back(v);
      if (v < fresh && !ends) expected.insert(first + v);
      if (v >= fresh && ends) expected.erase(block.imported[v - fresh]);
    }
    live.settle(block, [first](std::uint32_t v) { return first + v; });
    ASSERT_EQ(live.size(), expected.size());
    for (const std::uint64_t number : expected) ASSERT_EQ(*live.find(number), number);
  }
}

TEST(ImportCheck, TakesEachLiveVertexOnceABlock) {
  ImportCheck imports;
  EXPECT_FALSE(imports.import(0));
  imports.settle(block_of(3, {}, {2}));
  EXPECT_EQ(imports.live(), 2U);
  EXPECT_TRUE(imports.import(1));
  EXPECT_FALSE(imports.import(1)) << "twice in a block";
  EXPECT_FALSE(imports.import(2)) << "finalized";
  EXPECT_FALSE(imports.import(3)) << "not announced";
  imports.settle(block_of(0, {1}, {}));
  EXPECT_TRUE(imports.import(1)) << "in a later block";
  imports.settle(block_of(0, {1}, {0}));
  EXPECT_FALSE(imports.import(1));
  EXPECT_EQ(imports.live(), 1U);
}

}  // namespace
}  // namespace spillway::test
