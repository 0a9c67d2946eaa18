// What a run keeps belongs to it: to the thread that began it and those that work for it.

#include "src/runtime/run_memory.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

struct Kept {
  static inline std::atomic<int> alive = 0;
  Kept() { ++alive; }
  ~Kept() { --alive; }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
};

TEST(RunMemory, HasOneObjectOfATypeWhichGoesWithTheRun) {
  {
    const RunScope run;
    const auto kept = RunMemory::current().get<Kept>();
    EXPECT_EQ(RunMemory::current().get<Kept>(), kept);
    EXPECT_EQ(Kept::alive, 1);
  }
  EXPECT_EQ(Kept::alive, 0);
}

TEST(RunMemory, IsThatOfTheInnermostRunAndThenAsBefore) {
  const RunScope outer;
  const auto kept = RunMemory::current().get<Kept>();
  {
    const RunScope inner;
    EXPECT_NE(RunMemory::current().get<Kept>(), kept);
  }
  EXPECT_EQ(RunMemory::current().get<Kept>(), kept);
}

TEST(RunMemory, IsSharedByTheThreadsOfARunAndByNoOthers) {
  const RunScope run;
  RunMemory* const own = &RunMemory::current();
  std::atomic<int> others = 0;
  const auto look = [&](std::size_t, std::size_t, std::size_t) {
    if (&RunMemory::current() != own) ++others;
    std::this_thread::yield();
  };
  for (int round = 0; round < 20; ++round) {
    with_threads(4, [&] {
      parallel_for(1000, 1, look);
      with_threads(2, [&] { parallel_for(100, 1, look); });
      parallel_for(100, 1, look);
    });
  }
  EXPECT_EQ(others, 0);
  EXPECT_EQ(in_background([] { return &RunMemory::current(); }).get(), own);
  std::thread([&] { EXPECT_NE(&RunMemory::current(), own); }).join();
}

TEST(RunMemory, OfRunsBesideEachOtherIsNeverMixed) {
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&wrong] {
      for (int round = 0; round < 30; ++round) {
        const RunScope run;
        RunMemory* const own = &RunMemory::current();
        with_threads(3, [&] {
          parallel_for(200, 1, [&](std::size_t, std::size_t, std::size_t) {
            if (&RunMemory::current() != own) ++wrong;
          });
        });
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace spillway::test
