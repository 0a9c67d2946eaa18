#include "src/parallel/thread_demand.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

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

}  // namespace
}  // namespace spillway::test
