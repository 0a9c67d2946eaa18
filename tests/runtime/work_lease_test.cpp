#include "src/runtime/work_lease.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

constexpr WorkForecast kForecast{.points = 10, .bytes = 100, .exponent = 2};

/// Long enough for another thread to go wrong.
void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

TEST(WorkLease, WaitsForWorkThatIsUnderWay) {
  MemoryBudget budget(100);
  std::optional<WorkLease> first(std::in_place, budget, 80, "the first");
  std::atomic<bool> has_begun = false;
  std::thread other([&] {
    const WorkLease second(budget, 60, "the second");
    has_begun = true;
  });
  pause();
  EXPECT_FALSE(has_begun);
  first.reset();
  other.join();
  EXPECT_TRUE(has_begun);
  EXPECT_EQ(budget.used(), 0U);
}

TEST(WorkLease, FailsWhereNothingIsLeftToWaitFor) {
  MemoryBudget budget(100);
  const MemoryLease held(budget, 50, "what is held for long");
  EXPECT_THROW(WorkLease(budget, 60, "too much"), Failure);
  EXPECT_EQ(budget.used(), 50U);
}

TEST(WorkLease, IsGivenBackByWhomItWasMovedTo) {
  MemoryBudget budget(100);
  {
    WorkLease to;
    {
      WorkLease from(budget, 10, "work");
      from.grow(5, kForecast);
      to = std::move(from);
    }
    EXPECT_EQ(budget.used(), 15U);
    EXPECT_TRUE(to.grown());
    to.extend(80, "more work");
  }
  EXPECT_EQ(budget.used(), 0U);
}

TEST(WorkLease, WorkThatWaitsForMoreDoesNotKeepOthersFromFailing) {
  MemoryBudget budget(100);
  std::atomic<int> failed = 0;
  std::vector<std::thread> both;
  std::atomic<int> begun = 0;
  for (int i = 0; i < 2; ++i) {
    both.emplace_back([&] {
      WorkLease lease(budget, 45, "work");
      for (++begun; begun < 2;) std::this_thread::yield();
      try {
        lease.extend(60, "more than there will be");
      } catch (const Failure&) {
        ++failed;
      }
    });
  }
  for (std::thread& thread : both) thread.join();
  EXPECT_EQ(failed, 2);
  EXPECT_EQ(budget.used(), 0U);
}

TEST(WorkLease, GrowsOneAtATimeSoThatEachCanBeDone) {
  constexpr int kThreads = 4;
  MemoryBudget budget(100);
  std::vector<std::thread> threads;
  std::atomic<int> begun = 0;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      WorkLease lease(budget, 10, "work");
      for (++begun; begun < kThreads;) std::this_thread::yield();
      // Each needs 70 in the end: beside three that have 10 each, but not beside one that grew.
      for (int step = 0; step < 6; ++step) {
        lease.grow(10, kForecast);
        std::this_thread::yield();
      }
      EXPECT_TRUE(lease.grown());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(budget.used(), 0U);
}

TEST(WorkLease, ARefusalReachesAllThatWait) {
  MemoryBudget budget(100);
  std::atomic<int> refused = 0;
  std::vector<std::thread> threads;
  std::atomic<int> begun = 0;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      WorkLease lease(budget, 10, "work");
      for (++begun; begun < 3;) std::this_thread::yield();
      try {
        for (;;) lease.grow(10, kForecast);
      } catch (const Failure& error) {
        EXPECT_EQ(error.code(), ErrorCode::kOutOfBudget);
        ++refused;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(refused, 3);
}

TEST(WorkLease, ARefusalIsToldWhatIsForecast) {
  MemoryBudget budget(100);
  double told = 0;
  budget.set_estimate([&](const MemoryBudget::Refusal& refusal) {
    if (refusal.forecast != nullptr) told = refusal.forecast->bytes_for(40);
    return std::uint64_t{0};
  });
  WorkLease lease(budget, 90, "work");
  EXPECT_THROW(lease.grow(20, kForecast), Failure);
  EXPECT_EQ(told, 1600) << "four times the points, by the square";
}

}  // namespace
}  // namespace spillway::test
