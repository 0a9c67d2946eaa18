// The tiles of a survey: uneven, overlapping, and a place for each point.

#include "src/generators/survey_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace spillway::test {
namespace {

constexpr Box<3> kExtent{{1000, -500, 0}, {2000, 500, 50}};

std::size_t column_of(const SurveyGrid& grid, double x, std::uint64_t index, std::size_t columns) {
  return grid.tile_of({x, 0, 0}, index) % columns;
}

/// Where the lines of a grid without overlaps are, to a hundredth of a side.
std::vector<double> lines_of(const SurveyGrid& grid, std::size_t columns) {
  std::vector<double> lines;
  std::size_t last = 0;
  for (int i = 0; i <= 10'000; ++i) {
    const double x = 1000 + 0.1 * i;
    const std::size_t column = column_of(grid, x, 0, columns);
    EXPECT_TRUE(column == last || column == last + 1) << x;
    if (column != last) lines.push_back(x);
    last = column;
  }
  return lines;
}

TEST(SurveyGrid, HasLinesAtUnevenDistances) {
  const std::vector<double> lines = lines_of({kExtent, {.columns = 10, .rows = 3}, 1}, 10);
  ASSERT_EQ(lines.size(), 9U);
  double least = 1000;
  double most = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    least = std::min(least, lines[i] - lines[i - 1]);
    most = std::max(most, lines[i] - lines[i - 1]);
  }
  EXPECT_GE(least, 40);
  EXPECT_LE(most, 160);
  EXPECT_GT(most, 1.3 * least);
}

TEST(SurveyGrid, HasOtherLinesForAnotherSeed) {
  const SurveyGridShape shape{.columns = 10, .rows = 3};
  EXPECT_EQ(lines_of({kExtent, shape, 1}, 10), lines_of({kExtent, shape, 1}, 10));
  EXPECT_NE(lines_of({kExtent, shape, 1}, 10), lines_of({kExtent, shape, 2}, 10));
}

TEST(SurveyGrid, GivesThePointsOfAStripToBothNeighbours) {
  constexpr std::size_t kColumns = 10;
  const double line = lines_of({kExtent, {.columns = kColumns}, 7}, kColumns)[3];
  const SurveyGrid grid(kExtent, {.columns = kColumns, .rows = 1, .overlap = 0.2}, 7);
  const auto columns_at = [&](double x) {
    std::set<std::size_t> columns;
    for (std::uint64_t index = 0; index < 100; ++index) {
      columns.insert(column_of(grid, x, index, kColumns));
    }
    return columns;
  };
  EXPECT_EQ(columns_at(line - 10.2), (std::set<std::size_t>{3}));
  EXPECT_EQ(columns_at(line - 9.8), (std::set<std::size_t>{3, 4}));
  EXPECT_EQ(columns_at(line + 9.8), (std::set<std::size_t>{3, 4}));
  EXPECT_EQ(columns_at(line + 10.2), (std::set<std::size_t>{4}));
}

TEST(SurveyGrid, CountsTilesByRows) {
  const SurveyGrid grid(kExtent, {.columns = 4, .rows = 3}, 1);
  EXPECT_EQ(grid.size(), 12U);
  EXPECT_EQ(grid.tile_of({1000, -500, 0}, 0), 0U);
  EXPECT_EQ(grid.tile_of({2000, -500, 0}, 0), 3U);
  EXPECT_EQ(grid.tile_of({1000, 500, 0}, 0), 8U);
  EXPECT_EQ(grid.tile_of({2000, 500, 0}, 0), 11U);
}

TEST(SurveyGrid, TakesPointsThatAreAllEqual) {
  const SurveyGrid grid({{5, 5, 5}, {5, 5, 5}}, {.columns = 4, .rows = 3, .overlap = 0.1}, 1);
  const std::size_t tile = grid.tile_of({5, 5, 5}, 0);
  EXPECT_LT(tile, grid.size());
  EXPECT_EQ(grid.tile_of({5, 5, 5}, 1), tile);
}

}  // namespace
}  // namespace spillway::test
