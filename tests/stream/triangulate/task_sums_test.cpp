#include "stream/triangulate/task_sums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::FieldsAre;

constexpr auto kInTile = TaskScope::kInTile;
constexpr auto kBetweenTiles = TaskScope::kBetweenTiles;

Task task(TaskKind kind, std::size_t points, double seconds, std::size_t grains = 1) {
  return {.kind = kind, .points = points, .seconds = seconds, .grains = grains};
}

/// A merge that finds a border, and triangulates it as one base case.
Task merge(std::size_t points, std::vector<Task> children) {
  Task merge = task(TaskKind::kNode, points, 0);
  merge.children = std::move(children);
  merge.after = {task(TaskKind::kBorder, 3, 0.5, 4), task(TaskKind::kBaseCase, 3, 0.25)};
  merge.after[1].before = {task(TaskKind::kDivide, 3, 0.125)};
  return merge;
}

TEST(TaskSums, OfATileAreByHeightOverItsLeaves) {
  TaskSums sums;
  Task tile =
      merge(30, {merge(20, {task(TaskKind::kBaseCase, 9, 1), task(TaskKind::kBaseCase, 11, 2)}),
                 task(TaskKind::kBaseCase, 10, 4)});
  tile.before = {task(TaskKind::kDivide, 30, 0.5)};
  tile.before[0].children = {task(TaskKind::kDivide, 20, 0.25), task(TaskKind::kDivide, 10, 0.25)};
  sums.add_tile(tile);
  EXPECT_THAT(sums.sums(), ElementsAre(FieldsAre(kInTile, 0, TaskKind::kBaseCase, 3, 30, 7.0, 3),
                                       FieldsAre(kInTile, 1, TaskKind::kNode, 1, 20, 0.0, 1),
                                       FieldsAre(kInTile, 1, TaskKind::kBaseCase, 1, 3, 0.25, 1),
                                       FieldsAre(kInTile, 1, TaskKind::kDivide, 1, 3, 0.125, 1),
                                       FieldsAre(kInTile, 1, TaskKind::kBorder, 1, 3, 0.5, 4),
                                       FieldsAre(kInTile, 2, TaskKind::kNode, 1, 30, 0.0, 1),
                                       FieldsAre(kInTile, 2, TaskKind::kBaseCase, 1, 3, 0.25, 1),
                                       FieldsAre(kInTile, 2, TaskKind::kDivide, 4, 63, 1.125, 4),
                                       FieldsAre(kInTile, 2, TaskKind::kBorder, 1, 3, 0.5, 4)));
}

TEST(TaskSums, OfMergesAreAtTheLevelThatIsGiven) {
  TaskSums sums;
  sums.add_merge(kBetweenTiles, 2, merge(50, {}));
  sums.add_merge(kBetweenTiles, 2, merge(40, {}));
  sums.add_tile(task(TaskKind::kBaseCase, 7, 1));
  const std::vector<TaskSum> all = sums.sums();
  ASSERT_EQ(all.size(), 5U);
  EXPECT_THAT(all[0], FieldsAre(kInTile, 0, TaskKind::kBaseCase, 1, 7, 1.0, 1));
  EXPECT_THAT(all[1], FieldsAre(kBetweenTiles, 2, TaskKind::kNode, 2, 90, 0.0, 2));
  EXPECT_THAT(all[4], FieldsAre(kBetweenTiles, 2, TaskKind::kBorder, 2, 6, 1.0, 8));
}

TEST(TaskSums, AddOthers) {
  TaskSums some;
  some.add_tile(task(TaskKind::kBaseCase, 7, 1));
  TaskSums others;
  others.add_tile(task(TaskKind::kBaseCase, 5, 2));
  others.add_merge(TaskScope::kBetweenRanks, 1, task(TaskKind::kNode, 12, 0));
  some.add(others.sums());
  EXPECT_THAT(some.sums(),
              ElementsAre(FieldsAre(kInTile, 0, TaskKind::kBaseCase, 2, 12, 3.0, 2),
                          FieldsAre(TaskScope::kBetweenRanks, 1, TaskKind::kNode, 1, 12, 0.0, 1)));
}

}  // namespace
}  // namespace spillway::test
