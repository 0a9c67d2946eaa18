// Whole runs, so small that their times can be found by hand.

#include "tools/simulate/run_player.h"

#include <gtest/gtest.h>

#include "tests/tools/simulate/run_samples.h"

namespace spillway::test {
namespace {

RunModel batches_of(std::size_t count, const BatchCost& batch) {
  RunModel run;
  run.limits = no_limits();
  run.batches.assign(count, batch);
  run.read_batches = count;
  return run;
}

TEST(RunPlayer, OneCoreTakesAsLongAsAllStepsTogether) {
  RunModel run = tiles_of(4, {leaf(0.5), leaf(0.5), merge(2)});
  run.begin = 1;
  run.end = 2;
  run.batches.assign(5, {.fetch = 1, .deal = 2, .append = 0.5, .encode = 0.25, .write = 0.25});
  run.read_batches = 3;
  add_merge_of_tiles(run, {0, 1}, 3);
  EXPECT_DOUBLE_EQ(run.total_seconds(), 3 + 5 * 4 + 4 * 5 + 3);
  EXPECT_DOUBLE_EQ(play(run, {1, 0}), run.total_seconds());
}

TEST(RunPlayer, BatchesAreFetchedOneByOneAndDealtManyAtATime) {
  const RunModel run = batches_of(10, {.fetch = 1, .deal = 4});
  EXPECT_DOUBLE_EQ(play(run, {1, 0}), 50);
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 14);
}

TEST(RunPlayer, SoManyBatchesAreUnderWay) {
  RunModel run = batches_of(10, {.fetch = 1, .deal = 4});
  run.limits.batches = 1;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 50);
  run.limits.batches = 2;  // fetched at 0 1 5 6 10 11 15 16 20 21
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 26);
}

TEST(RunPlayer, BatchesAreAppendedInOrder) {
  RunModel run = batches_of(3, {.deal = 1, .append = 1});
  run.batches[0].deal = 5;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 8);
}

TEST(RunPlayer, WhatIsDealtAgainWaitsForAllToBeRead) {
  RunModel run = batches_of(4, {.deal = 1});
  run.read_batches = 2;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 2);
}

TEST(RunPlayer, TheDiskIsSharedByAllThatReadAndWrite) {
  RunModel run = batches_of(2, {.fetched_bytes = 30, .written_bytes = 10});
  EXPECT_DOUBLE_EQ(play(run, {4, 10}), 8);
  run = tiles_of(2, {leaf(0, 20)});
  run.output_bytes = 0.5;
  run.costs[0].read_bytes = 40;
  // Read for 4, work for 1, write for 1; meanwhile the other is read.
  EXPECT_DOUBLE_EQ(play(run, {4, 10}), 10);
}

TEST(RunPlayer, SoManyTilesAreWorkedOnAtATime) {
  RunModel run = tiles_of(8, {leaf()});
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 1);
  run.limits.loaded_points = 20;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 4);
  EXPECT_DOUBLE_EQ(play(run, {1, 0}), 8);
}

TEST(RunPlayer, ThereIsMemoryForSoManyThreads) {
  RunModel run = tiles_of(8, {leaf()});
  run.limits.threads = 4;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 2);
}

TEST(RunPlayer, AMergeWaitsForItsParts) {
  RunModel run = tiles_of(1, {leaf(), leaf(), merge(2), leaf(), leaf(), merge(3), merge(4)});
  EXPECT_DOUBLE_EQ(play(run, {4, 0}), 1 + 3 + 4);
  EXPECT_DOUBLE_EQ(play(run, {1, 0}), 4 + 2 + 3 + 4);
}

TEST(RunPlayer, AMergeOfTilesLeavesItsRoomToOtherTiles) {
  RunModel run = tiles_of(2, {leaf()});
  add_merge_of_tiles(run, {0, 1}, 5);
  run.nodes.insert(run.nodes.end(), 2, {.cost = 0});
  run.limits.loaded_points = 20;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 6);
  run.limits.loaded_points = 10;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 7);
}

TEST(RunPlayer, BlocksAreWrittenOneByOne) {
  const RunModel run = tiles_of(4, {leaf(2)});
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 1 + 8);
}

TEST(RunPlayer, ATileIsNotBegunWithoutRoomForItsOutput) {
  RunModel run = tiles_of(3, {leaf(2, 10)});
  run.limits.loaded_points = 10;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 7);
  run.end = 1;  // comes after the last block
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 8);
  // Tiles are done at 1, 4 and 7, when the one before has been written.
  run.limits.waiting_bytes = 0;
  EXPECT_DOUBLE_EQ(play(run, {100, 0}), 10);
}

TEST(RunPlayer, TheNextTileIsReadWhileOneIsWorkedOn) {
  RunModel run = tiles_of(3, {leaf()});
  run.costs[0].read = 1;
  run.costs[0].read_bytes = 1;
  run.limits.loaded_points = 10;
  EXPECT_DOUBLE_EQ(play(run, {2, 0}), 4);
  run.costs[0].read_bytes = 0;  // nothing of it is on the disk
  EXPECT_DOUBLE_EQ(play(run, {2, 0}), 6);
}

TEST(RunPlayer, CompleteTilesAreWorkedOnWhileOthersAreRead) {
  RunModel run = batches_of(4, {.fetch = 1});
  run.costs = tiles_of(1, {leaf()}).costs;
  for (std::uint32_t b = 1; b <= 4; ++b) run.nodes.push_back({.cost = 0, .after_batches = b});
  run.limits.loaded_points = 20;
  EXPECT_DOUBLE_EQ(play(run, {2, 0}), 5);
  EXPECT_DOUBLE_EQ(play(run, {1, 0}), 8);
  for (RunNode& node : run.nodes) node.after_batches = 4;
  EXPECT_DOUBLE_EQ(play(run, {2, 0}), 6);
}

TEST(RunPlayer, WhoReadsLendsAHandWhereTooMuchIsReady) {
  RunModel run = batches_of(2, {.fetch = 1});
  run.costs = tiles_of(1, {leaf()}).costs;
  for (int i = 0; i < 4; ++i) run.nodes.push_back({.cost = 0, .after_batches = 1});
  run.limits.loaded_points = 20;
  run.limits.batches = 1;
  // Tiles are ready at 1; who reads takes every other one, and goes on at 3.
  EXPECT_DOUBLE_EQ(play(run, {4, 0}), 4);
}

}  // namespace
}  // namespace spillway::test
