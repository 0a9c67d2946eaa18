// Which z a vertex of several points gets.

#include "stream/output/heights.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

struct Stack {
  std::vector<VertexId> input_index;
  std::vector<DroppedDuplicate> duplicates;
};

/// Three points at one place, input indices 4, 2, 7 (the first is 2), and one elsewhere.
Stack stacked() {
  Stack t;
  t.input_index = {4, 2, 0, 7};
  t.duplicates = {{.dropped = 0, .kept = 1}, {.dropped = 3, .kept = 1}};
  return t;
}

TEST(Heights, LowestAndHighestTakeThePointThatHasIt) {
  std::vector<double> heights = {9, 0, 5, 0, 1, 0, 0, 8};
  auto lowest = stacked();
  choose_heights(lowest.duplicates, Heights::kLowest, lowest.input_index, heights);
  EXPECT_EQ(lowest.input_index[1], 4U);
  auto highest = stacked();
  choose_heights(highest.duplicates, Heights::kHighest, highest.input_index, heights);
  EXPECT_EQ(highest.input_index[1], 7U);
  auto first = stacked();
  choose_heights(first.duplicates, Heights::kFirst, first.input_index, heights);
  EXPECT_EQ(first.input_index[1], 2U);
}

TEST(Heights, OfEqualHeightsTheFirstPointOfTheInputIsTaken) {
  std::vector<double> heights(8, 3.0);
  auto t = stacked();
  choose_heights(t.duplicates, Heights::kHighest, t.input_index, heights);
  EXPECT_EQ(t.input_index[1], 2U);
}

TEST(Heights, MeanCountsEveryPointOnce) {
  std::vector<double> heights = {9, 0, 6, 0, 1, 0, 0, 8};
  auto t = stacked();
  choose_heights(t.duplicates, Heights::kMean, t.input_index, heights);
  EXPECT_EQ(heights[t.input_index[1]], 5);
  EXPECT_EQ(heights[t.input_index[2]], 9);
}

}  // namespace
}  // namespace spillway::test
