#include "src/parallel/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "src/delaunay/common/hash.h"
#include "src/parallel/thread_demand.h"

namespace spillway::detail {
namespace {

class Parallel : public testing::TestWithParam<unsigned> {};

TEST_P(Parallel, ForCoversEveryItemOnceInFixedGrains) {
  with_threads(GetParam(), [] {
    std::vector<std::atomic<int>> visits(1003);
    std::vector<std::size_t> begins(grain_count(visits.size(), 10));
    parallel_for(visits.size(), 10, [&](std::size_t g, std::size_t begin, std::size_t end) {
      begins[g] = begin;
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    for (std::size_t g = 0; g < begins.size(); ++g) EXPECT_EQ(begins[g], 10 * g);
  });
}

TEST_P(Parallel, WorkQueueReachesEverythingThatItemsLeadTo) {
  with_threads(GetParam(), [] {
    constexpr int kCount = 100'000;
    std::vector<std::atomic<bool>> reached(kCount);
    parallel_work_queue(std::vector<int>{1}, 16,
                        [&](std::span<const int> items, std::vector<int>& found) {
                          for (const int i : items) {
                            if (i >= kCount || reached[i].exchange(true)) continue;
                            found.push_back(2 * i);
                            found.push_back(2 * i + 1);
                          }
                        });
    for (int i = 1; i < kCount; ++i) EXPECT_TRUE(reached[i]);
  });
}

TEST_P(Parallel, ErrorsOfWorkersReachTheCaller) {
  const auto fail_in_group = [] {
    TaskGroup group;
    for (int i = 0; i < 8; ++i) {
      group.run([i] {
        if (i == 5) throw std::runtime_error("five");
      });
    }
    group.wait();
  };
  EXPECT_THROW(with_threads(GetParam(), fail_in_group), std::runtime_error);
}

TEST_P(Parallel, GroupsInsideOfATaskAreDoneThoughAnotherTaskFails) {
  constexpr int kTasks = 100;
  std::atomic<bool> failed = false;
  std::atomic<int> done = 0;
  std::atomic<int> done_when_it_returned = kTasks;
  const auto work = [&] {
    TaskGroup group;
    group.run([&] {  // begun first, by whichever thread: waits for the failure of the other one
      for (int i = 0; i < 200 && !failed; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      TaskGroup inside;
      for (int i = 0; i < kTasks; ++i) inside.run([&] { ++done; });
      inside.wait();
      done_when_it_returned = done.load();
    });
    group.run([&] {
      failed = true;
      throw std::runtime_error("the other one");
    });
    group.wait();
  };
  EXPECT_THROW(with_threads(GetParam(), work), std::runtime_error);
  EXPECT_EQ(done_when_it_returned, kTasks);
}

TEST_P(Parallel, IndexFindsAllItemsInsertedAtOnceInspiteOfEqualHashes) {
  with_threads(GetParam(), [] {
    constexpr std::size_t kCount = 20'000;
    ConcurrentIndex index(kCount);
    const auto hash = [](std::size_t i) { return mix64(i / 3); };
    parallel_for(kCount, 100, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        index.insert(hash(i), static_cast<std::uint32_t>(i));
      }
    });
    for (std::uint32_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(index.find(hash(i), [&](std::uint32_t item) { return item == i; }), i);
    }
    EXPECT_EQ(index.find(hash(0), [](std::uint32_t) { return false; }), ConcurrentIndex::kNotFound);
  });
}

TEST(ThreadDemands, HighestOfThoseBesideEachOtherCounts) {
  const unsigned least = available_threads();
  const ThreadDemand few(1);
  EXPECT_EQ(ThreadDemand::limit(), least);
  {
    const ThreadDemand many(least + 5);
    EXPECT_EQ(ThreadDemand::limit(), least + 5);
    const ThreadDemand more(least + 9);
    EXPECT_EQ(ThreadDemand::limit(), least + 9);
    { const ThreadDemand fewer(2); }
    EXPECT_EQ(ThreadDemand::limit(), least + 9);
  }
  EXPECT_EQ(ThreadDemand::limit(), least);
}

TEST(ThreadDemands, CallersBesideEachOtherKeepTheirOwnNumbers) {
  std::atomic<int> wrong = 0;
  const auto work = [&](unsigned threads) {
    for (int round = 0; round < 20; ++round) {
      std::atomic<unsigned> now = 0, most = 0;
      with_threads(threads, [&] {
        parallel_for(200, 1, [&](std::size_t, std::size_t, std::size_t) {
          const unsigned here = ++now;
          unsigned before = most;
          while (before < here && !most.compare_exchange_weak(before, here)) {
          }
          --now;
        });
      });
      wrong += most > threads ? 1 : 0;
    }
  };
  std::jthread other([&] { work(1); });
  std::jthread third([&] { work(5); });
  work(3);
  other.join();
  third.join();
  EXPECT_EQ(wrong, 0);
}

TEST(SimplexHash, SimplexesAreTheSameUpToEvenPermutationsOnly) {
  const std::array<VertexId, 4> simplex{7, 3, kInfiniteVertex, 0};
  std::array<int, 4> places{0, 1, 2, 3};
  do {
    int inversions = 0;
    std::array<VertexId, 4> other{};
    for (int i = 0; i < 4; ++i) {
      other[i] = simplex[places[i]];
      for (int j = 0; j < i; ++j) inversions += places[j] > places[i] ? 1 : 0;
    }
    EXPECT_EQ(same_simplex(simplex, other), inversions % 2 == 0);
    EXPECT_EQ(simplex_hash(simplex), simplex_hash(other));
    EXPECT_EQ(SortedVertices<4>(other).vertices,
              (std::array<VertexId, 4>{0, 3, 7, kInfiniteVertex}));
  } while (std::next_permutation(places.begin(), places.end()));
  EXPECT_FALSE(same_simplex<4>(simplex, {7, 3, kInfiniteVertex, 1}));
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 4));

}  // namespace
}  // namespace spillway::detail
