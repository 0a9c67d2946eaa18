#include "stream/tiles/regions/reading_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ReadingOrder, FollowsTheCells) {
  const std::vector<WaitingCell> cells = {{{2}, 10}, {{0}, 10}, {{1}, 10}};
  EXPECT_THAT(reading_order(cells, std::vector<double>{10, 10, 10}), ElementsAre(2, 0, 1));
}

TEST(ReadingOrder, CompletesWhatIsBegunBeforeItBeginsElsewhere) {
  const std::vector<WaitingCell> cells = {{{0, 1}, 10}, {{3}, 10}, {{1, 2}, 10}};
  EXPECT_THAT(reading_order(cells, std::vector<double>{5, 10, 5, 10}), ElementsAre(0, 1, 2, 3));
}

TEST(ReadingOrder, TakesTheCheapestOfTheCellsThatAreBegun) {
  const std::vector<WaitingCell> cells = {{{0}, 10}, {{0, 1}, 10}, {{0, 2}, 10}, {{2, 1}, 10}};
  EXPECT_THAT(reading_order(cells, std::vector<double>{10, 100, 20}), ElementsAre(0, 2, 1));
}

/// Input 1 has more points than input 2, but completes a large cell.
TEST(ReadingOrder, CountsWhatIsCompleteThen) {
  const std::vector<WaitingCell> cells = {{{0}, 10}, {{0, 1}, 60}, {{0, 2}, 10}};
  EXPECT_THAT(reading_order(cells, std::vector<double>{10, 50, 20}), ElementsAre(0, 1, 2));
}

TEST(ReadingOrder, HasInputsWithoutCellsToo) {
  EXPECT_THAT(reading_order(std::vector<WaitingCell>{{{2}, 10}}, std::vector<double>{0, 0, 10, 0}),
              ElementsAre(2, 0, 1, 3));
  EXPECT_THAT(reading_order({}, {}), IsEmpty());
}

}  // namespace
}  // namespace spillway::test
