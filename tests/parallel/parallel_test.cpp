#include "src/parallel/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

namespace spillway::test {
namespace {

class Parallel : public ::testing::TestWithParam<unsigned> {};

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

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, ::testing::Values(1, 2, 4));

}  // namespace
}  // namespace spillway::test
