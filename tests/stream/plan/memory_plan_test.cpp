// Sizes as people write them, the budget that refuses, and the plan that shares it out.

#include <gtest/gtest.h>

#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "stream/plan/memory_plan.h"
#include "tests/error_facts.h"

namespace spillway::detail {
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

TEST(MemoryBudget, GivesBackWhatALeaseHeld) {
  MemoryBudget budget(100);
  {
    const MemoryLease lease(budget, 60, "one thing");
    EXPECT_EQ(budget.used(), 60U);
    EXPECT_THROW(MemoryLease(budget, 60, "another"), Error);
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
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "32 MiB of memory are too little for one thing");
    EXPECT_EQ(error.code(), ErrorCode::kOutOfBudget);
    EXPECT_EQ(error.facts().perhaps, 67 * kMiB);
    EXPECT_EQ(error.facts().enough, 81 * kMiB);
  }
}

TEST(MemoryBudget, TheDefaultIsAtMostTwoGibibytes) {
  EXPECT_GT(default_memory_limit(), 0U);
  EXPECT_LE(default_memory_limit(), 2048 * kMiB);
}

TEST(MemoryPlan, RefusesTooSmallALimitAndNamesTheLeast) {
  try {
    plan_memory(8 * kMiB, 2, 1);
    FAIL() << "8 MiB were accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("MiB are the least"), std::string::npos);
  }
}

TEST(MemoryPlan, NamesTheLeastOfTheWhole) {
  const auto least = [](std::uint64_t limit, int dimension, std::uint64_t whole) {
    return facts_of([&] { plan_memory(limit, dimension, 1, whole); }).enough;
  };
  EXPECT_EQ(least(8 * kMiB, 2, 0), 32 * kMiB);
  EXPECT_EQ(least(24 * kMiB, 2, 32 * kMiB), 43 * kMiB);
  EXPECT_EQ(least(50 * kMiB, 3, 100 * kMiB), 192 * kMiB);
}

TEST(MemoryPlan, LoadsMoreTilesAtATimeWhereThereIsRoomForThem) {
  const MemoryPlan little = plan_memory(64 * kMiB, 2, 2);
  EXPECT_EQ(little.tile_capacity, little.tile_room);
  const MemoryPlan much = plan_memory(2048 * kMiB, 2, 2);
  EXPECT_EQ(much.tile_capacity, 750'000U);
  EXPECT_GT(much.tile_room, 10 * much.tile_capacity);
  const MemoryPlan space = plan_memory(2048 * kMiB, 3, 2);
  EXPECT_EQ(space.tile_capacity, space.tile_room);
}

TEST(MemoryPlan, MakesLargerTilesOfVeryManyPoints) {
  const MemoryPlan plan = plan_memory(1024 * kMiB, 2, 2);
  EXPECT_EQ(tile_capacity_for(1'000'000, plan), plan.tile_capacity);
  EXPECT_EQ(tile_capacity_for(8'192'000'000, plan), 1'000'000U);
  EXPECT_EQ(tile_capacity_for(1ULL << 60, plan), plan.tile_room);
}

TEST(MemoryPlan, HasMoreBatchesForMoreThreads) {
  EXPECT_EQ(plan_memory(2048 * kMiB, 2, 1).batches, 6U);
  EXPECT_EQ(plan_memory(2048 * kMiB, 2, 64).batches, 128U);
  EXPECT_EQ(plan_memory(32 * kMiB, 2, 64).batches, 3U);
}

TEST(MemoryPlan, KeepsSomeMebibytesBackAndMoreBesideReading) {
  const auto shared_out = [](std::uint64_t limit, bool early) {
    return plan_memory(limit, 2, 2, 0, early).waiting_bytes * 10;  // a tenth of it
  };
  for (const std::uint64_t limit : {32 * kMiB, 256 * kMiB}) {
    EXPECT_LE(shared_out(limit, false), limit - 4 * kMiB);
    EXPECT_GT(shared_out(limit, false), limit - 5 * kMiB);
    EXPECT_LT(shared_out(limit, true), shared_out(limit, false));
  }
  EXPECT_EQ(plan_memory(32 * kMiB, 2, 2).batches, 3U);
  EXPECT_EQ(plan_memory(32 * kMiB, 2, 2, 0, true).batches, 2U);
}

TEST(MemoryPlan, DependsOnThreadsOnlyInTheirNumber) {
  for (const int dimension : {2, 3}) {
    const MemoryPlan one = plan_memory(256 * kMiB, dimension, 1);
    const MemoryPlan many = plan_memory(256 * kMiB, dimension, 64);
    EXPECT_EQ(one.tile_capacity, many.tile_capacity);
    EXPECT_EQ(one.leaf_size, many.leaf_size);
    EXPECT_EQ(one.buffered_points, many.buffered_points);
    EXPECT_GE(many.threads, 2U);
    EXPECT_LE(many.leaf_size, many.tile_capacity);
  }
}

}  // namespace
}  // namespace spillway::detail
