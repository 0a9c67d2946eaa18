#include "formats/points/copc/writing/hierarchy_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

namespace spillway::test {
namespace {

constexpr std::uint64_t kBegin = 1000;

/// A tree with deep branches, which hierarchy_pages() gets in any order.
std::vector<HierarchyEntry> random_tree(std::size_t nodes) {
  std::mt19937 random(4);
  std::vector<HierarchyEntry> tree = {{.key = {}, .offset = 1, .bytes = 7, .count = 3}};
  std::set<NodeKey> keys = {NodeKey{}};
  while (tree.size() < nodes) {
    NodeKey key = tree[random() % tree.size()].key;
    ++key.level;
    for (std::int32_t& cell : key.cell) cell = 2 * cell + static_cast<std::int32_t>(random() % 2);
    if (key.level > 20 || !keys.insert(key).second) continue;
    tree.push_back({key, tree.size() + 1, 7, 3});
  }
  std::ranges::shuffle(tree, random);
  return tree;
}

struct ReadPages {
  std::map<NodeKey, std::uint64_t> offsets;  // of nodes
  std::size_t pages = 0;
};

void read_page(const HierarchyPages& all, std::uint64_t begin, std::size_t size, ReadPages& read) {
  ++read.pages;
  for (std::size_t at = begin - kBegin; at < begin - kBegin + size; at += HierarchyEntry::kSize) {
    const HierarchyEntry entry = load_entry(&all.bytes[at]);
    if (entry.count == HierarchyEntry::kInOtherPage) {
      read_page(all, entry.offset, static_cast<std::size_t>(entry.bytes), read);
    } else {
      EXPECT_TRUE(read.offsets.emplace(entry.key, entry.offset).second);
    }
  }
}

void expect_all_nodes(const std::vector<HierarchyEntry>& nodes, const HierarchyPages& all,
                      std::size_t least_pages) {
  ReadPages read;
  read_page(all, kBegin, all.root_size, read);
  EXPECT_EQ(read.offsets.size(), nodes.size());
  for (const HierarchyEntry& node : nodes) EXPECT_EQ(read.offsets.at(node.key), node.offset);
  EXPECT_GE(read.pages, least_pages);
}

TEST(HierarchyPages, FewNodesAreOnePage) {
  const std::vector<HierarchyEntry> nodes = random_tree(100);
  const HierarchyPages all = hierarchy_pages(nodes, kBegin, 100);
  EXPECT_EQ(all.root_size, all.bytes.size());
  expect_all_nodes(nodes, all, 1);
}

TEST(HierarchyPages, ManyNodesArePagesOfSubtrees) {
  const std::vector<HierarchyEntry> nodes = random_tree(3000);
  const HierarchyPages all = hierarchy_pages(nodes, kBegin, 100);
  EXPECT_LT(all.root_size, all.bytes.size() / 2);
  expect_all_nodes(nodes, all, 10);
}

TEST(HierarchyPages, NoNodesAreAnEmptyRoot) {
  const HierarchyPages all = hierarchy_pages({}, kBegin);
  ASSERT_EQ(all.bytes.size(), HierarchyEntry::kSize);
  EXPECT_EQ(all.root_size, HierarchyEntry::kSize);
  EXPECT_EQ(all.bytes, std::vector<std::byte>(HierarchyEntry::kSize));
}

}  // namespace
}  // namespace spillway::test
