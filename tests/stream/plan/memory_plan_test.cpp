#include "stream/plan/memory_plan.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "src/error.h"
#include "tests/error_facts.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

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
  EXPECT_EQ(little.tile_points, little.tile_room);
  const MemoryPlan much = plan_memory(2048 * kMiB, 2, 2);
  EXPECT_EQ(much.tile_points, 750'000U);
  EXPECT_GT(much.tile_room, 10 * much.tile_points);
  const MemoryPlan space = plan_memory(2048 * kMiB, 3, 2);
  EXPECT_EQ(space.tile_points, space.tile_room);
}

TEST(MemoryPlan, MakesLargerTilesOfVeryManyPoints) {
  const MemoryPlan plan = plan_memory(1024 * kMiB, 2, 2);
  EXPECT_EQ(tile_points_for(1'000'000, plan), plan.tile_points);
  EXPECT_EQ(tile_points_for(8'192'000'000, plan), 1'000'000U);
  EXPECT_EQ(tile_points_for(1ULL << 60, plan), plan.tile_room);
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
    EXPECT_EQ(one.tile_points, many.tile_points);
    EXPECT_EQ(one.leaf_points, many.leaf_points);
    EXPECT_EQ(one.buffered_points, many.buffered_points);
    EXPECT_GE(many.threads, 2U);
    EXPECT_LE(many.leaf_points, many.tile_points);
  }
}

}  // namespace
}  // namespace spillway::test
