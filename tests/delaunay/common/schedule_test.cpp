#include "src/delaunay/common/schedule.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

Task work(double seconds, std::size_t grains = 1) {
  Task task;
  task.seconds = seconds;
  task.grains = grains;
  return task;
}

Task node(std::vector<Task> before, std::vector<Task> children, std::vector<Task> after) {
  Task task;
  task.before = std::move(before);
  task.children = std::move(children);
  task.after = std::move(after);
  return task;
}

TEST(GreedyMakespan, OfOneCoreIsTheTotal) {
  const Task task = node({work(1)}, {work(2), work(3, 4)}, {work(4), work(5)});
  EXPECT_DOUBLE_EQ(task.total_seconds(), 15);
  EXPECT_DOUBLE_EQ(greedy_makespan(task, 1), 15);
}

TEST(GreedyMakespan, RunsChildrenBesideEachOtherAndStepsInOrder) {
  const Task task = node({work(1)}, {work(2), work(3)}, {work(4), work(5)});
  EXPECT_DOUBLE_EQ(greedy_makespan(task, 2), 1 + 3 + 4 + 5);
  EXPECT_DOUBLE_EQ(greedy_makespan(task, 100), 13);
}

TEST(GreedyMakespan, SharesPiecesAmongCores) {
  EXPECT_DOUBLE_EQ(greedy_makespan(work(12, 6), 4), 4);
  EXPECT_DOUBLE_EQ(greedy_makespan(work(12, 6), 6), 2);
  EXPECT_DOUBLE_EQ(greedy_makespan(work(12, 6), 1000), 2);
}

TEST(GreedyMakespan, WaitsForBothSubtreesBeforeMerging) {
  const Task left = node({}, {work(1), work(1)}, {work(2)});
  const Task right = node({}, {work(5), work(1)}, {work(1)});
  EXPECT_DOUBLE_EQ(greedy_makespan(node({}, {left, right}, {work(3)}), 8), 9);
}

TEST(GreedyMakespan, TakesTheDeepestWorkFirst) {
  Task task = work(1);
  for (int depth = 0; depth < 200; ++depth) task = node({}, {task, work(1)}, {work(1)});
  EXPECT_LE(greedy_makespan(task, 2), 203);
}

}  // namespace
}  // namespace spillway::test
