#include "stream/triangulate/merge_forest.h"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace spillway::test {
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

std::string left_over(Forest& forest) {
  std::string names;
  forest.visit_left_over([&](const Forest::Node& node) { names += node.name; });
  return names;
}

TEST(MergeForest, WhatIsDoneIsLeftOverUntilWhatIsAboveIsDone) {
  Forest forest;
  EXPECT_TRUE(forest.empty());
  const auto a = forest.add({"a"}, {});
  const auto b = forest.add({"b"}, {});
  const auto both = forest.add({"+"}, {a.node, b.node});
  EXPECT_FALSE(forest.empty());
  EXPECT_EQ(left_over(forest), "");
  forest.done(*b.node);
  EXPECT_EQ(left_over(forest), "b");
  forest.done(*a.node);
  EXPECT_EQ(left_over(forest), "ab") << "in the order of their numbers";
  forest.done(*both.node);
  EXPECT_EQ(left_over(forest), "+");
  const auto c = forest.add({"c"}, {});
  const auto top = forest.add({"*"}, {both.node, c.node});
  forest.done(*c.node);
  EXPECT_EQ(left_over(forest), "+c");
  forest.done(*top.node);
  EXPECT_EQ(left_over(forest), "*");
}

TEST(MergeForest, ManyThreadsLeadToEachParentOnceThoughItIsJustBeingAdded) {
  for (int round = 0; round < 20; ++round) {
    constexpr int kLeaves = 64;
    Forest forest;
    std::vector<std::thread> threads;
    std::atomic<int> merged = 0;
    const auto work_off = [&](Forest::Node* node) {
      for (node = forest.done(*node); node != nullptr; node = forest.done(*node)) ++merged;
    };
    std::mutex mutex;
    std::deque<Forest::Node*> ready;  // guarded by mutex
    std::atomic<bool> all_added = false;
    for (int t = 0; t < 3; ++t) {
      threads.emplace_back([&] {
        for (;;) {
          const bool is_last_look = all_added;
          Forest::Node* node = nullptr;
          {
            const std::lock_guard lock(mutex);
            if (!ready.empty()) {
              node = ready.front();
              ready.pop_front();
            }
          }
          if (node != nullptr) {
            work_off(node);
          } else if (is_last_look) {
            return;
          }
        }
      });
    }
    Forest::Node* top = nullptr;
    int parents_ready = 0;
    for (int leaf = 0; leaf < kLeaves; ++leaf) {
      Forest::Node* const node = forest.add({"leaf"}, {}).node;
      {
        const std::lock_guard lock(mutex);
        ready.push_back(node);
      }
      if (top == nullptr) {
        top = node;
        continue;
      }
      const Forest::Added above = forest.add({"above"}, {top, node});
      top = above.node;
      if (!above.ready) continue;
      ++parents_ready;
      work_off(top);
    }
    all_added = true;
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(merged + parents_ready, kLeaves - 1);
    std::vector<Forest::Node*> left;
    forest.visit_left_over([&](Forest::Node& node) { left.push_back(&node); });
    EXPECT_EQ(left, std::vector<Forest::Node*>{top});
  }
}

}  // namespace
}  // namespace spillway::test
