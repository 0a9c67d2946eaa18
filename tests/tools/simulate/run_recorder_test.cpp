// A model of a run, made of what that tells.

#include "tools/simulate/run_recorder.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

/// Times are much longer than what the test itself takes.
StageStep step(std::string_view stage, bool in_order, double seconds, std::uint64_t bytes = 0) {
  return {.stage = stage,
          .in_order = in_order,
          .seconds = seconds,
          .processor_time = seconds,
          .bytes = bytes};
}

constexpr double kNear = 0.5;

TEST(RunRecorder, PutsStepsWhereTheyBelong) {
  RunRecorder recorder;
  recorder.limits({.batches = 3, .loaded_points = 2, .threads = 7});
  for (int batch = 0; batch < 2; ++batch) {
    recorder.step(step("read", true, 100, 10));
    recorder.step(step("read", false, 200, 3));
    recorder.step(step("deal", false, 300));
    recorder.step(step("deal", true, 400));
    recorder.step(step("spill", false, 500));
    recorder.step(step("spill", true, 600, 20));
  }
  recorder.step(step("deal", false, 700));  // dealt again
  recorder.step(step("deal", true, 800));

  Task base_case{.kind = TaskKind::kBaseCase, .seconds = 111};
  Task tile{.kind = TaskKind::kNode, .children = {base_case, base_case}};
  tile.before.push_back({.kind = TaskKind::kDivide, .seconds = 40, .grains = 4});
  tile.after.push_back({.kind = TaskKind::kBorder, .seconds = 15, .grains = 3});
  recorder.step(step("load", true, 10, 5));
  for (int grain = 0; grain < 3; ++grain) recorder.step(step("load", false, 20));
  recorder.step(step("divide", false, 50));
  for (int part = 0; part < 3; ++part) {
    recorder.step(step(part < 2 ? "leaves" : "merge", false, 30));
    recorder.step(step("finality", false, 60));
    recorder.step(step("encode", false, 70));
    recorder.step(step("write", true, 80, 1000));
  }
  recorder.node({.number = 0, .task = tile});
  recorder.step(step("merge", false, 90));
  recorder.step(step("write", true, 11, 1000));
  Task merge{.seconds = 90, .grains = 2};
  recorder.node({.number = 1, .level = 1, .children = {0}, .task = merge});
  RunStatistics statistics;
  statistics.mesh.points = 123;
  const RunModel run = recorder.take(statistics, 8000);

  EXPECT_EQ(run.limits.batches, 3U);
  EXPECT_EQ(run.points, 123U);
  EXPECT_DOUBLE_EQ(run.output_bytes, 2);
  ASSERT_EQ(run.batches.size(), 3U);
  EXPECT_EQ(run.read_batches, 2U);
  EXPECT_NEAR(run.batches[1].fetch, 100, kNear);
  EXPECT_NEAR(run.batches[1].deal, 500, kNear);
  EXPECT_NEAR(run.batches[1].append, 400, kNear);
  EXPECT_NEAR(run.batches[1].encode, 500, kNear);
  EXPECT_NEAR(run.batches[1].write, 600, kNear);
  EXPECT_EQ(run.batches[1].fetched_bytes, 13U);
  EXPECT_EQ(run.batches[1].written_bytes, 20U);
  EXPECT_NEAR(run.batches[2].deal, 700, kNear);

  ASSERT_EQ(run.nodes.size(), 2U);
  EXPECT_EQ(run.nodes[0].after_batches, 3U);
  const NodeCost& loaded = run.costs[run.nodes[0].cost];
  EXPECT_NEAR(loaded.read, 10, kNear);
  EXPECT_EQ(loaded.read_bytes, 5U);
  EXPECT_NEAR(loaded.decode, 60, kNear);
  EXPECT_EQ(loaded.decode_grains, 3U);
  EXPECT_NEAR(loaded.divide.total_seconds(), 40, kNear);
  EXPECT_NEAR(loaded.arrange, 10, kNear);  // what the task does not tell
  ASSERT_EQ(loaded.parts.size(), 3U);
  EXPECT_NEAR(loaded.parts[1].work.total_seconds(), 30, kNear);
  EXPECT_NEAR(loaded.parts[1].settle, 130, kNear);
  EXPECT_NEAR(loaded.parts[1].write, 80, kNear);
  EXPECT_EQ(loaded.parts[1].children, 0U);
  EXPECT_EQ(loaded.parts[2].children, 2U);
  EXPECT_NEAR(loaded.parts[2].work.total_seconds(), 15, kNear);
  EXPECT_NEAR(loaded.parts[2].settle, 145, kNear);

  const NodeCost& merged = run.costs[run.nodes[1].cost];
  EXPECT_EQ(run.nodes[1].children, std::vector<std::uint32_t>{0});
  ASSERT_EQ(merged.parts.size(), 1U);
  EXPECT_EQ(merged.parts[0].work.nodes[0].grains, 2U);
  EXPECT_NEAR(merged.parts[0].write, 11, kNear);
}

TEST(RunRecorder, ScalesTasksToTheirProcessorTime) {
  RunRecorder recorder;
  recorder.step(step("leaves", false, 1));
  recorder.node({.number = 0, .task = {.kind = TaskKind::kBaseCase}});
  StageStep slow = step("merge", false, 100);
  slow.processor_time = 50;
  recorder.step(slow);
  recorder.node({.number = 1, .children = {0}, .task = {.seconds = 80, .grains = 2}});
  const RunModel run = recorder.take({}, 0);
  const PartCost& merge = run.costs[run.nodes[1].cost].parts[0];
  EXPECT_NEAR(merge.work.total_seconds(), 40, kNear);
  EXPECT_NEAR(merge.settle, 10, kNear);
}

}  // namespace
}  // namespace spillway::test
