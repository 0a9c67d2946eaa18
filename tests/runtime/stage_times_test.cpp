#include "src/runtime/stage_times.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <thread>
#include <vector>

namespace spillway::test {
namespace {

using std::chrono::milliseconds;

TEST(StageTimes, NamesAreThoseOfTheStages) {
  const auto name = [](Stage stage) { return kStageNames.at(static_cast<std::size_t>(stage)); };
  EXPECT_EQ(name(Stage::kRead), "read");
  EXPECT_EQ(name(Stage::kExchange), "exchange");
  EXPECT_EQ(name(Stage::kSpill), "spill");
  EXPECT_EQ(name(Stage::kLeaves), "leaves");
  EXPECT_EQ(name(Stage::kMerge), "merge");
  EXPECT_EQ(name(Stage::kWrite), kStageNames.back());
}

TEST(StageTimes, AddUpWhatManyThreadsSpendOnAStageAndNoOther) {
  StageTimes times;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int step = 0; step < 1000; ++step) times.add(Stage::kMerge, milliseconds(1));
      times.add(Stage::kWrite, milliseconds(500));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_DOUBLE_EQ(times.seconds(Stage::kMerge), 4);
  EXPECT_DOUBLE_EQ(times.seconds(Stage::kWrite), 2);
  EXPECT_EQ(times.seconds(Stage::kEncode), 0);
}

TEST(StageTimer, TellsEachStepAsItIsAddedUp) {
  StageTimes times;
  std::vector<StageStep> steps;
  times.tell_steps([&](const StageStep& step) { steps.push_back(step); });
  {
    StageTimer timer(times, Stage::kSpill);
    timer.move_bytes(1000);
    timer.move_bytes(24);
  }
  { const StageTimer timer(times, Stage::kWrite, StepOrder::kInOrder); }
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].stage, "spill");
  EXPECT_FALSE(steps[0].in_order);
  EXPECT_EQ(steps[0].bytes, 1024U);
  EXPECT_EQ(steps[1].stage, "write");
  EXPECT_TRUE(steps[1].in_order);
  EXPECT_EQ(steps[1].bytes, 0U);
  EXPECT_NEAR(steps[0].seconds, times.seconds(Stage::kSpill), 1e-12);
  EXPECT_NEAR(steps[1].seconds, times.seconds(Stage::kWrite), 1e-12);
}

TEST(StageTimer, CountsTheThreadsProcessorTimeAndNotThatOfOthers) {
  StageTimes times;
  std::optional<StageStep> told;
  times.tell_steps([&](const StageStep& step) { told = step; });
  const double all_before = process_processor_seconds();
  {
    const StageTimer timer(times, Stage::kLeaves);
    std::thread([] {
      const double start = processor_seconds();
      while (processor_seconds() < start + 0.02) {
      }
    }).join();
  }
  ASSERT_TRUE(told);
  EXPECT_GE(told->seconds, 0.02);
  EXPECT_LT(told->processor_time, 0.02) << "of a thread that waits";
  EXPECT_GE(told->processor_time, 0);
  EXPECT_GE(process_processor_seconds(), all_before + 0.02);
}

TEST(StageTimes, StepsAreToldOneAtATime) {
  StageTimes times;
  std::atomic<int> at_once = 0;
  std::atomic<int> overlaps = 0;
  int told = 0;  // guarded by what is tested
  times.tell_steps([&](const StageStep&) {
    if (++at_once > 1) ++overlaps;
    ++told;
    std::this_thread::yield();
    --at_once;
  });
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int step = 0; step < 200; ++step) const StageTimer timer(times, Stage::kDeal);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(overlaps, 0);
  EXPECT_EQ(told, 800);
}

}  // namespace
}  // namespace spillway::test
