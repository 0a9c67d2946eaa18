// Sizes as people write them, the budget that refuses, and the plan that shares it out.

#include <gtest/gtest.h>

#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "stream/plan/memory_plan.h"

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
    EXPECT_THROW(parse_memory_size(text), UsageError) << text;
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
  const auto message = [&](std::uint64_t bytes) {
    try {
      const MemoryLease more(budget, bytes, "another");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(12 * kMiB), "");
  EXPECT_EQ(message(20 * kMiB),
            "32 MiB of memory are too little for another; --memory 51M may be enough, 100M is");
  EXPECT_EQ(message(70 * kMiB),
            "32 MiB of memory are too little for another; --memory 100M is enough");
  EXPECT_EQ(message(100 * kMiB),
            "32 MiB of memory are too little for another; --memory 151M may be enough");
}

TEST(MemoryBudget, SpeaksOfTheWholeThatItIsAPartOf) {
  MemoryBudget budget(24 * kMiB, 32 * kMiB);
  budget.set_enough(60 * kMiB);
  try {
    const MemoryLease lease(budget, 40 * kMiB, "one thing");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "32 MiB of memory are too little for one thing; --memory 67M may be enough, 81M is");
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
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("MiB are the least"), std::string::npos);
  }
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
