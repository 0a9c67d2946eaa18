// What runs would take on other cores, what they wait for there, and larger runs.

#include "tools/simulate/core_simulation.h"

#include <gtest/gtest.h>

#include "tests/tools/simulate/run_samples.h"
#include "tools/simulate/resource.h"
#include "tools/simulate/run_player.h"

namespace spillway::test {
namespace {

std::string_view bottleneck_of(const RunModel& run, unsigned cores, double disk_speed = 0) {
  return simulate_cores(run, {cores}, disk_speed).front().bottlenecks.front().name;
}

TEST(CoreSimulation, SpeedUpIsOverOneCore) {
  const auto runs = simulate_cores(tiles_of(4, {leaf()}), {1, 2, 8}, 0);
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_DOUBLE_EQ(runs[0].speed_up, 1);
  EXPECT_DOUBLE_EQ(runs[1].speed_up, 2);
  EXPECT_DOUBLE_EQ(runs[2].speed_up, 4);
  EXPECT_EQ(runs[1].bottlenecks[0].name, name_of(Resource::kCores));
  EXPECT_DOUBLE_EQ(runs[1].bottlenecks[0].seconds, 1);
}

TEST(CoreSimulation, TheBottleneckIsWhatShortensTheRunMost) {
  RunModel run = tiles_of(4, {leaf(0.1F, 100)});
  EXPECT_EQ(bottleneck_of(run, 2), name_of(Resource::kCores));
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kWrite));
  EXPECT_EQ(bottleneck_of(run, 16, 100), name_of(Resource::kDisk));
  run.limits.threads = 1;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kMemory));
  run = tiles_of(4, {leaf()});
  run.limits.loaded_points = 10;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kTiles));
  run.limits = no_limits();
  add_merge_of_tiles(run, {0, 1}, 5);
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kTopMerges));
  run.end = 10;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kEnds));
  run.costs[0].arrange = 20;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kLoading));
  run = {};
  run.limits = no_limits();
  run.batches.assign(10, {.fetch = 1, .deal = 1, .append = 0.5});
  run.read_batches = 10;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kFetch));
  for (BatchCost& batch : run.batches) batch.append = 2;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kAppend));
  for (BatchCost& batch : run.batches) batch.write = 3;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kSpill));
  for (BatchCost& batch : run.batches) batch.deal = 50;
  run.limits.batches = 2;
  EXPECT_EQ(bottleneck_of(run, 16), name_of(Resource::kBatches));
}

TEST(CoreSimulation, BehindABottleneckIsTheNext) {
  RunModel run = tiles_of(8, {leaf(0.25F)});
  run.limits.loaded_points = 10;
  const auto found = simulate_cores(run, {4}, 0).front().bottlenecks;
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, name_of(Resource::kTiles));
  // Without writing, two rounds on four cores.
  EXPECT_EQ(found[1].name, name_of(Resource::kWrite));
  EXPECT_DOUBLE_EQ(found[1].seconds, 2);
  EXPECT_EQ(found[2].name, name_of(Resource::kCores));
  EXPECT_DOUBLE_EQ(found[2].seconds, 1);
}

TEST(LargerRun, IsMadeOfWholeCopies) {
  RunModel run = tiles_of(2, {leaf()});
  add_merge_of_tiles(run, {0, 1}, 1);
  run.batches.assign(3, {.fetch = 1});
  run.batches.push_back({.fetch = 2});
  run.read_batches = 3;
  for (RunNode& node : run.nodes) node.after_batches = 4;
  EXPECT_EQ(enlarge(run, 149).nodes.size(), 3U);
  const RunModel large = enlarge(run, 350);
  EXPECT_EQ(large.points, 400U);
  EXPECT_EQ(large.batches.size(), 16U);
  EXPECT_EQ(large.read_batches, 12U);
  EXPECT_FLOAT_EQ(large.batches[11].fetch, 1);
  EXPECT_FLOAT_EQ(large.batches[12].fetch, 2);
  ASSERT_EQ(large.nodes.size(), 4 * 3 + 3U);
  EXPECT_EQ(large.nodes[4].children.size(), 0U);
  EXPECT_EQ(large.nodes[5].children, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(large.nodes[6].children, (std::vector<std::uint32_t>{2, 5}));
  EXPECT_EQ(large.nodes[14].children, (std::vector<std::uint32_t>{6, 13}));
  // Of one level only nothing is known of growth: merges double.
  EXPECT_DOUBLE_EQ(play(large, {1, 0}), 4 * (3 + 2 + 2 + 1) + 2 * 2 + 4);
  for (const RunNode& node : large.nodes) EXPECT_EQ(node.after_batches, 16U);
}

TEST(LargerRun, MergesGoOnGrowingAsTheyDid) {
  RunModel run = tiles_of(2, {leaf()});
  add_merge_of_tiles(run, {0, 1}, 1);
  run.nodes.insert(run.nodes.end(), 2, {.cost = 0});
  add_merge_of_tiles(run, {3, 4}, 1);
  add_merge_of_tiles(run, {2, 5}, 1.5);
  const RunModel large = enlarge(run, 200);
  EXPECT_FLOAT_EQ(large.costs[large.nodes.back().cost].parts[0].work.total_seconds(), 2.25);
}

TEST(LargerRun, TilesOfALaterCopyAreCompleteLater) {
  RunModel run = tiles_of(3, {leaf()});
  run.batches.assign(4, {.fetch = 1});
  run.read_batches = 4;
  run.nodes[0].after_batches = 1;
  run.nodes[1].after_batches = 2;
  run.nodes[2].after_batches = 4;
  const RunModel large = enlarge(run, 200);
  ASSERT_EQ(large.nodes.size(), 7U);
  EXPECT_EQ(large.nodes[2].after_batches, 4U);
  EXPECT_EQ(large.nodes[3].after_batches, 5U);
  EXPECT_EQ(large.nodes[5].after_batches, 8U);
  EXPECT_EQ(large.nodes[6].after_batches, 8U);
}

}  // namespace
}  // namespace spillway::test
