// Cores and a disk in simulated time, and tasks that are played on them.

#include "tools/simulate/machine.h"

#include <gtest/gtest.h>

#include <string>

#include "src/delaunay/common/schedule.h"
#include "tools/simulate/task_player.h"

namespace spillway::test {
namespace {

Task task_of(double seconds, std::size_t grains = 1) {
  Task task;
  task.seconds = seconds;
  task.grains = grains;
  return task;
}

double played(const Task& task, unsigned cores) {
  SimulatedMachine machine(cores, 0);
  TaskPlayer player(machine);
  const FlatTask flat = flatten(task, 1);
  bool done = false;
  player.play(flat, Urgency::kLeaf, [&] { done = true; });
  const double seconds = machine.run();
  EXPECT_TRUE(done);
  return seconds;
}

TEST(SimulatedMachine, EachCoreDoesOnePieceAtATime) {
  SimulatedMachine machine(2, 0);
  for (int i = 0; i < 5; ++i) machine.compute(1, Urgency::kLeaf, [] {});
  EXPECT_DOUBLE_EQ(machine.run(), 3);
}

TEST(SimulatedMachine, GrainsRunAtTheSameTime) {
  SimulatedMachine machine(3, 0);
  machine.compute(6, 6, Urgency::kLeaf, [] {});
  EXPECT_DOUBLE_EQ(machine.run(), 2);
}

TEST(SimulatedMachine, WhatIsUrgentComesFirst) {
  SimulatedMachine machine(1, 0);
  std::string order;
  machine.compute(1, Urgency::kLeaf, [&] { order += 'a'; });
  machine.compute(1, Urgency::kLeaf, [&] { order += 'b'; });
  machine.compute(1, Urgency::kInOrder, [&] { order += 'c'; });
  machine.run();
  EXPECT_EQ(order, "cab");
}

TEST(SimulatedMachine, TheDiskMovesOneThingAfterTheOtherBesideTheCores) {
  SimulatedMachine machine(1, 10);
  machine.move(20, [] {});
  machine.move(30, [] {});
  machine.compute(4, Urgency::kLeaf, [] {});
  EXPECT_DOUBLE_EQ(machine.run(), 5);
}

TEST(SimulatedMachine, NoDiskSpeedIsAnyThatIsNeeded) {
  SimulatedMachine machine(1, 0);
  machine.move(1e12, [] {});
  EXPECT_DOUBLE_EQ(machine.run(), 0);
}

TEST(FlatTask, WhatIsSerialIsOneNode) {
  Task task = task_of(1);
  task.before.push_back(task_of(2));
  task.children.push_back(task_of(3));
  task.after.push_back(task_of(4));
  const FlatTask flat = flatten(task, 0.5);
  ASSERT_EQ(flat.nodes.size(), 1U);
  EXPECT_FLOAT_EQ(flat.nodes[0].seconds, 5);
  EXPECT_FLOAT_EQ(flatten(task, 1, false).nodes[0].seconds, 7);
}

TEST(FlatTask, LargerIsLongerAndHasMoreGrains) {
  Task task = task_of(1, 4);
  task.after.push_back(task_of(2));
  const FlatTask flat = enlarge(flatten(task, 1), 1.5);
  ASSERT_EQ(flat.nodes.size(), 2U);
  EXPECT_EQ(flat.nodes[0].grains, 6U);
  EXPECT_EQ(flat.nodes[1].grains, 1U);
  EXPECT_DOUBLE_EQ(flat.total_seconds(), 4.5);
}

TEST(TaskPlayer, StepsFollowAndChildrenRunBesideEachOther) {
  Task task = task_of(2, 2);
  task.before.push_back(task_of(1));
  for (int i = 0; i < 4; ++i) task.children.push_back(task_of(3, 1));
  task.after.push_back(task_of(4, 4));
  task.after.push_back(task_of(0.5));
  EXPECT_DOUBLE_EQ(played(task, 1), 1 + 2 + 12 + 4 + 0.5);
  EXPECT_DOUBLE_EQ(played(task, 2), 1 + 1 + 6 + 2 + 0.5);
  EXPECT_DOUBLE_EQ(played(task, 4), 1 + 1 + 3 + 1 + 0.5);
}

TEST(TaskPlayer, PlaysAsTheGreedyScheduleDoes) {
  Task task = task_of(1, 3);
  Task child = task_of(0.5, 2);
  child.after.push_back(task_of(1, 2));
  child.children.assign(3, task_of(0.25));
  task.children.assign(3, child);
  task.after.push_back(task_of(2, 4));
  for (const unsigned cores : {1U, 2U, 4U, 64U}) {
    EXPECT_NEAR(played(task, cores), greedy_makespan(task, cores), cores == 2 ? 0.5 : 1e-6);
  }
}

}  // namespace
}  // namespace spillway::test
