#include "src/runtime/task.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

Task work(double seconds) { return {.seconds = seconds}; }

TEST(Task, TotalHasTheOwnTimeAndAllStepsBelow) {
  Task below = work(1);
  below.before.push_back(work(2));
  below.children = {work(4), work(8)};
  below.after.push_back(work(16));
  EXPECT_DOUBLE_EQ(below.total_seconds(), 31);

  Task task = work(32);
  task.before.push_back(below);
  EXPECT_DOUBLE_EQ(task.total_seconds(), 32 + 31);
  task.children.push_back(below);
  EXPECT_DOUBLE_EQ(task.total_seconds(), 32 + 2 * 31);
  task.after = {below, below};
  EXPECT_DOUBLE_EQ(task.total_seconds(), 32 + 4 * 31);
  EXPECT_DOUBLE_EQ(Task{}.total_seconds(), 0);
}

}  // namespace
}  // namespace spillway::test
