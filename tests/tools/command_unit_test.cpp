// The parts of the command that need no process: lists of cores, counts, progress lines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "src/error.h"
#include "tools/options/command_options.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/json_text.h"
#include "tools/report/progress.h"
#include "tools/report/progress_line.h"
#include "tools/report/speed_up_estimate.h"

namespace spillway::test {
namespace {

std::vector<std::string> long_names(const CommandLine& app) {
  std::vector<std::string> names;
  for (const OptionInfo& option : app.options()) names.push_back(option.names.back());
  return names;
}

TEST(CoreList, DotsStandForDoubling) {
  using List = std::vector<unsigned>;
  EXPECT_EQ(parse_core_list("1"), List{1});
  EXPECT_EQ(parse_core_list("1,3,8"), (List{1, 3, 8}));
  EXPECT_EQ(parse_core_list("1,2,4,...,64"), (List{1, 2, 4, 8, 16, 32, 64}));
  EXPECT_EQ(parse_core_list("3,...,20"), (List{3, 6, 12, 20}));
}

TEST(CoreList, NonsenseIsAnInvalidArgument) {
  for (const char* text : {"", ",", "0", "-1", "1,", "1,,2", "...", "...,4", "1,...", "1,...,...,8",
                           "two", "1;2", "1e3", "99999999999"}) {
    EXPECT_THROW(parse_core_list(text), InvalidArgument) << text;
  }
}

TEST(Count, TakesDigitsAndExponents) {
  EXPECT_EQ(parse_point_count("0"), 0U);
  EXPECT_EQ(parse_point_count("123456789012"), 123456789012U);
  EXPECT_EQ(parse_point_count("1e6"), 1000000U);
  EXPECT_EQ(parse_point_count("2.5e3"), 2500U);
  for (const char* text : {"", "-1", "1.5", "1e-3", "1e400", "nan", "ten", "5 ", "1e6x"}) {
    EXPECT_THROW(parse_point_count(text), InvalidArgument) << text;
  }
}

TEST(OptionNames, AreThoseThatThereAre) {
  CommandLine input;
  InputOptions input_options;
  add_input_options(input, input_options);
  std::vector<std::string> known(kPointOptionNames.begin(), kPointOptionNames.end());
  known.emplace_back("--max-expansion");  // of meshes, too
  EXPECT_THAT(long_names(input), ::testing::UnorderedElementsAreArray(known));
  CommandLine all;
  TriangulationOptions options;
  add_triangulation_options(all, options);
  known.insert(known.end(), kTriangulationOptionNames.begin(), kTriangulationOptionNames.end());
  // These have an effect on a mesh, or are settings for any work.
  known.insert(known.end(),
               {"--max-edge", "--threads", "--memory", "--scratch-folder", "--max-tmp"});
  EXPECT_THAT(long_names(all), ::testing::UnorderedElementsAreArray(known));
}

TEST(ProgressLine, ShowsWhatIsKnown) {
  PhaseState state{
      .phase = "read", .unit = "points", .done = 1200000, .fraction = 0.25, .seconds = 3};
  EXPECT_EQ(progress_line(state), "read: 1.20M points, 400k/s, 25%, 0:09 left");
  state.finished = true;
  EXPECT_EQ(progress_line(state), "read: 1.20M points, 400k/s, 3.00 s");
  state.seconds = 0.001;
  EXPECT_EQ(progress_line(state), "read: 1.20M points, 0.00 s");
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

TEST(ProgressOnATerminal, OfARunThatFillsAPipeIsTheEndsOfPhases) {
  ::testing::internal::CaptureStderr();
  {
    ProgressLine progress(ProgressStyle::kEndsOnTerminal, false, false);
    for (const char* const phase : {"read", "divide"}) {
      progress.begin(phase, "points");
      progress.update(200, 0.5);
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
      progress.end(400);
    }
  }
  const std::string shown = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(shown, ::testing::Not(::testing::HasSubstr("200 points")));
  EXPECT_THAT(shown, ::testing::HasSubstr("\r\x1b[Kspillway: read: 400 points"));
  EXPECT_THAT(shown, ::testing::HasSubstr("\r\x1b[Kspillway: divide: 400 points"));
  EXPECT_TRUE(shown.ends_with("s\n"));
}

TEST(ProgressOfThreads, TheMostCountsInWhateverOrderTheySayIt) {
  ::testing::internal::CaptureStderr();
  {
    ProgressLine progress(ProgressStyle::kJson, false, false);
    progress.begin("triangulate", "points");
    progress.update(200, 0.5);
    progress.update(100, 0.25);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    progress.end(400);
  }
  std::istringstream lines(::testing::internal::GetCapturedStderr());
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto state = nlohmann::json::parse(line);
  EXPECT_EQ(state["done"], 200);
  EXPECT_EQ(state["fraction"], 0.5);
  EXPECT_EQ(state["finished"], false);
  ASSERT_TRUE(std::getline(lines, line));
  const auto last = nlohmann::json::parse(line);
  EXPECT_EQ(last["done"], 400);
  EXPECT_EQ(last["fraction"], 1);
  EXPECT_EQ(last["finished"], true);
}

TEST(JsonText, BytesThatAreNoTextDoNotFail) {
  EXPECT_EQ(json_text({{"name", "a\xff"}}), "{\"name\":\"a\xEF\xBF\xBD\"}");
}

}  // namespace
}  // namespace spillway::test
