#include "src/runtime/memory_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "src/error.h"
#include "tests/error_facts.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

TEST(MemorySize, IsReadWithAndWithoutUnits) {
  EXPECT_EQ(parse_memory_size("1000000"), 1'000'000U);
  EXPECT_EQ(parse_memory_size("512M"), 512 * kMiB);
  EXPECT_EQ(parse_memory_size("512MiB"), 512 * kMiB);
  EXPECT_EQ(parse_memory_size("1.5g"), 1536 * kMiB);
  EXPECT_EQ(parse_memory_size("2kb"), 2048U);
  EXPECT_EQ(parse_memory_size("7B"), 7U);
}

TEST(MemorySize, RefusesWhatIsNone) {
  for (const char* text : {"", "M", "-1", "1X", "1MX", "0", "nan", "inf", "1e30T", "12 M"}) {
    EXPECT_THROW(parse_memory_size(text), InvalidArgument) << text;
  }
}

TEST(MemorySize, IsWrittenInTheUnitThatPeopleWouldTake) {
  EXPECT_EQ(memory_size_text(512 * kMiB), "512 MiB");
  EXPECT_EQ(memory_size_text(1536 * kMiB), "1.5 GiB");
  EXPECT_EQ(memory_size_text(kMiB / 2), "0.5 MiB");
  for (const std::uint64_t mebibytes : {1, 48, 1000, 1024, 3072}) {
    std::string text = memory_size_text(mebibytes * kMiB);
    std::erase(text, ' ');
    EXPECT_EQ(parse_memory_size(text), mebibytes * kMiB);
  }
}

TEST(MemoryBudget, GivesBackWhatALeaseHeld) {
  MemoryBudget budget(100);
  {
    const MemoryLease lease(budget, 60, "one thing");
    EXPECT_EQ(budget.used(), 60U);
    EXPECT_THROW(MemoryLease(budget, 60, "another"), Failure);
    EXPECT_EQ(budget.used(), 60U);
  }
  EXPECT_EQ(budget.used(), 0U);
}

TEST(MemoryBudget, NamesWhatMayBeEnoughAndWhatIs) {
  MemoryBudget budget(32 * kMiB);
  budget.set_enough(100 * kMiB - 1);
  const MemoryLease lease(budget, 20 * kMiB, "one thing");
  const auto facts = [&](std::uint64_t bytes) {
    return facts_of([&] { const MemoryLease more(budget, bytes, "another"); });
  };
  EXPECT_EQ(facts(12 * kMiB).remedy, Remedy::kNone);
  EXPECT_EQ(facts(20 * kMiB).remedy, Remedy::kMemory);
  EXPECT_EQ(facts(20 * kMiB).perhaps, 0U) << "nobody knows";
  EXPECT_EQ(facts(20 * kMiB).enough, 100 * kMiB);
  std::uint64_t estimate = 60 * kMiB - 1;
  std::uint64_t wanted = 0;
  budget.set_estimate([&](const MemoryBudget::Refusal& refusal) {
    EXPECT_EQ(refusal.used, 20 * kMiB);
    wanted = refusal.used + refusal.bytes;
    return estimate;
  });
  EXPECT_EQ(facts(20 * kMiB).perhaps, 60 * kMiB);
  EXPECT_EQ(wanted, 40 * kMiB);
  EXPECT_EQ(facts(20 * kMiB).enough, 100 * kMiB);
  EXPECT_EQ(facts(36 * kMiB).perhaps, 71 * kMiB) << "a quarter above what was wanted, at least";
  EXPECT_EQ(facts(70 * kMiB).perhaps, 0U);
  EXPECT_EQ(facts(70 * kMiB).enough, 100 * kMiB);
  estimate = 0;
  EXPECT_EQ(facts(20 * kMiB).perhaps, 0U);
  EXPECT_EQ(facts(100 * kMiB).perhaps, 151 * kMiB);
  EXPECT_EQ(facts(100 * kMiB).enough, 0U);
}

TEST(MemoryBudget, SpeaksOfTheWholeThatItIsAPartOf) {
  MemoryBudget budget(24 * kMiB, 32 * kMiB);
  budget.set_enough(60 * kMiB);
  budget.set_estimate(
      [](const MemoryBudget::Refusal& refusal) { return refusal.used + refusal.bytes; });
  try {
    const MemoryLease lease(budget, 40 * kMiB, "one thing");
    FAIL();
  } catch (const Failure& error) {
    EXPECT_STREQ(error.what(), "32 MiB of memory are too little for one thing");
    EXPECT_EQ(error.code(), ErrorCode::kOutOfBudget);
    EXPECT_EQ(error.facts().perhaps, 67 * kMiB);
    EXPECT_EQ(error.facts().enough, 81 * kMiB);
  }
}

TEST(MemoryBudget, TheDefaultIsAtMostTwoGibibytesAndSharedByProcesses) {
  EXPECT_GT(default_memory_limit(), 0U);
  EXPECT_LE(default_memory_limit(), 2048 * kMiB);
  EXPECT_LE(default_memory_limit(1000), default_memory_limit());
  EXPECT_GT(default_memory_limit(1000), 0U);
}

TEST(MemoryBudget, WhatIsRefusedChangesNothing) {
  MemoryBudget budget(100);
  EXPECT_TRUE(budget.try_take(40));
  EXPECT_FALSE(budget.try_take(61));
  EXPECT_EQ(budget.used(), 40U);
  EXPECT_TRUE(budget.try_take(60)) << "the limit itself may be used";
  EXPECT_THROW(budget.take(1, "one more"), Failure);
  EXPECT_EQ(budget.used(), 100U);
}

TEST(MemoryBudget, ThreadsBesideEachOtherNeverHoldMoreThanTheLimit) {
  constexpr std::uint64_t kShare = 40;  // two fit
  MemoryBudget budget(100);
  std::atomic<int> holders = 0;
  std::atomic<int> too_many = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int round = 0; round < 2000; ++round) {
        if (!budget.try_take(kShare)) continue;
        if (++holders > 2) ++too_many;
        --holders;
        budget.give_back(kShare);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(too_many, 0);
  EXPECT_EQ(budget.used(), 0U);
}

TEST(MemoryLease, IsGivenBackOnceByWhomItWasMovedTo) {
  MemoryBudget budget(100);
  {
    MemoryLease to(budget, 5, "a little");
    {
      MemoryLease from(budget, 60, "much");
      MemoryLease between(std::move(from));
      to = std::move(between);
      EXPECT_EQ(budget.used(), 65U);
    }
    EXPECT_EQ(budget.used(), 60U) << "what it held before goes with whom it was moved from";
  }
  EXPECT_EQ(budget.used(), 0U);
}

TEST(ShrinkingLease, GivesBackNoMoreThanItHas) {
  MemoryBudget budget(100);
  {
    ShrinkingLease lease(budget);
    lease.take(60, "all");
    lease.give_back(20);
    EXPECT_EQ(budget.used(), 40U);
    lease.give_back(50);
    EXPECT_EQ(budget.used(), 0U);
    lease.take(10, "more");
  }
  EXPECT_EQ(budget.used(), 0U);
}

}  // namespace
}  // namespace spillway::test
