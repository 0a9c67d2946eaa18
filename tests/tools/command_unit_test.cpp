// The parts of the command that need no process: lists of cores, counts, progress lines, heights.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "src/error.h"
#include "tools/command_options.h"
#include "tools/core_simulation.h"
#include "tools/facet_count.h"
#include "tools/heights.h"
#include "tools/json_text.h"
#include "tools/progress_line.h"

namespace spillway {
namespace {

TEST(CoreList, DotsStandForDoubling) {
  using List = std::vector<unsigned>;
  EXPECT_EQ(parse_core_list("1"), List{1});
  EXPECT_EQ(parse_core_list("1,3,8"), (List{1, 3, 8}));
  EXPECT_EQ(parse_core_list("1,2,4,...,64"), (List{1, 2, 4, 8, 16, 32, 64}));
  EXPECT_EQ(parse_core_list("3,...,20"), (List{3, 6, 12, 20}));
}

TEST(CoreList, NonsenseIsAUsageError) {
  for (const char* text : {"", ",", "0", "-1", "1,", "1,,2", "...", "...,4", "1,...", "1,...,...,8",
                           "two", "1;2", "1e3", "99999999999"}) {
    EXPECT_THROW(parse_core_list(text), UsageError) << text;
  }
}

TEST(CoreSimulation, SpeedUpIsOverOneCore) {
  Task root;
  for (int i = 0; i < 4; ++i) {
    Task child;
    child.seconds = 1;
    root.children.push_back(child);
  }
  const auto runs = simulate_cores(root, {1, 2, 8});
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_DOUBLE_EQ(runs[0].speed_up, 1);
  EXPECT_DOUBLE_EQ(runs[1].speed_up, 2);
  EXPECT_DOUBLE_EQ(runs[2].speed_up, 4);
}

TEST(Count, TakesDigitsAndExponents) {
  EXPECT_EQ(parse_point_count("0"), 0U);
  EXPECT_EQ(parse_point_count("123456789012"), 123456789012U);
  EXPECT_EQ(parse_point_count("1e6"), 1000000U);
  EXPECT_EQ(parse_point_count("2.5e3"), 2500U);
  for (const char* text : {"", "-1", "1.5", "1e-3", "1e400", "nan", "ten", "5 ", "1e6x"}) {
    EXPECT_THROW(parse_point_count(text), UsageError) << text;
  }
}

TEST(ProgressLine, ShowsWhatIsKnown) {
  PhaseState state{
      .phase = "read", .unit = "points", .done = 1200000, .fraction = 0.25, .seconds = 3};
  EXPECT_EQ(progress_line(state), "read: 1.20M points, 400k/s, 25%, 0:09 left");
  state.finished = true;
  EXPECT_EQ(progress_line(state), "read: 1.20M points, 400k/s, 3.00 s");
  const PhaseState unknown{.phase = "triangulate", .unit = "points", .fraction = {}, .seconds = 75};
  EXPECT_EQ(progress_line(unknown), "triangulate: 1:15");
}

TEST(ProgressLine, NumbersKeepThreeDigits) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(999), "999");
  EXPECT_EQ(short_number(999.7), "1.00k");
  EXPECT_EQ(short_number(12345), "12.3k");
  EXPECT_EQ(short_number(9996), "10.0k");
  EXPECT_EQ(short_number(3.4e9), "3.40G");
  EXPECT_EQ(clock_time(3723), "1:02:03");
}

TEST(ProgressJson, LeavesUnknownsNull) {
  const PhaseState state{
      .phase = "read", .unit = "points", .done = 5, .fraction = {}, .seconds = 1};
  const auto json = nlohmann::json::parse(progress_json(state));
  EXPECT_TRUE(json["fraction"].is_null());
  EXPECT_TRUE(json["seconds_left"].is_null());
  EXPECT_EQ(json["rate"], 5.0);
}

TEST(JsonText, BytesThatAreNoTextDoNotFail) {
  EXPECT_EQ(json_text({{"name", "a\xff"}}), "{\"name\":\"a\xEF\xBF\xBD\"}");
}

/// Three points at one place, input indices 4, 2, 7 (the first is 2), and one elsewhere.
Triangulation<2> stacked() {
  Triangulation<2> t;
  t.points = {{0, 0}, {0, 0}, {1, 0}, {0, 0}};
  t.input_index = {4, 2, 0, 7};
  t.duplicates = {{.dropped = 0, .kept = 1}, {.dropped = 3, .kept = 1}};
  return t;
}

TEST(Heights, LowestAndHighestTakeThePointThatHasIt) {
  std::vector<double> heights = {9, 0, 5, 0, 1, 0, 0, 8};
  auto lowest = stacked();
  choose_heights(lowest, HeightChoice::kLowest, heights);
  EXPECT_EQ(lowest.input_index[1], 4U);
  auto highest = stacked();
  choose_heights(highest, HeightChoice::kHighest, heights);
  EXPECT_EQ(highest.input_index[1], 7U);
  auto first = stacked();
  choose_heights(first, HeightChoice::kFirst, heights);
  EXPECT_EQ(first.input_index[1], 2U);
}

TEST(Heights, OfEqualHeightsTheFirstPointOfTheInputIsTaken) {
  std::vector<double> heights(8, 3.0);
  auto t = stacked();
  choose_heights(t, HeightChoice::kHighest, heights);
  EXPECT_EQ(t.input_index[1], 2U);
}

TEST(Heights, MeanCountsEveryPointOnce) {
  std::vector<double> heights = {9, 0, 6, 0, 1, 0, 0, 8};
  auto t = stacked();
  choose_heights(t, HeightChoice::kMean, heights);
  EXPECT_EQ(heights[t.input_index[1]], 5);
  EXPECT_EQ(heights[t.input_index[2]], 9);
}

TEST(FacetCount, CountsWhatOneSimplexHasAlone) {
  Mesh square;
  square.header.dimension = 2;
  square.corners = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(count_boundary_facets(square), 4U);
  Mesh tetrahedra;
  tetrahedra.header.dimension = 3;
  tetrahedra.corners = {0, 1, 2, 3, 1, 2, 3, 4};
  EXPECT_EQ(count_boundary_facets(tetrahedra), 6U);
}

}  // namespace
}  // namespace spillway
