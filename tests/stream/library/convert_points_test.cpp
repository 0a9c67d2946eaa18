// From a source of points to a sink, and point files: <spillway/convert.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/generate.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using test::OwnPoints;
using test::OwnSink;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Convert : public test::CallTest {
 protected:
  PointConversion write(PointSource& source, const std::string& name,
                        const PointFileOptions& how = {}) {
    const Context context(options());
    return convert(source, *create_points(file(name), how, context), context);
  }

  std::vector<Point<3>> read(const std::string& name) {
    return test::all_of(*open_points({file(name)}, {}, Context(options())));
  }

  std::string content(const std::string& name) {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const std::vector<Point<3>> points_{{0.1234, 7, 1}, {5, 0.5, 2}, {3, 3, 3.25}};
};

TEST_F(Convert, KeepsPointsOfAProgramAsTheyAre) {
  OwnPoints source(points_);
  const PointConversion done = write(source, "points.spp");
  EXPECT_EQ(done.written, 3U);
  EXPECT_EQ(done.points.read, 3U);
  EXPECT_FALSE(done.rounded);
  EXPECT_THAT(done.lost, IsEmpty());
  EXPECT_EQ(read("points.spp"), points_);
  EXPECT_THAT(phases_, ElementsAre("convert"));
}

TEST_F(Convert, RoundsWhatLasCannotHold) {
  OwnPoints source(points_);
  const PointConversion done = write(source, "points.las");
  EXPECT_TRUE(done.rounded);
  EXPECT_EQ(done.scale, (std::array<double, 3>{1e-7, 1e-7, 0.001}));
  EXPECT_LT(done.farthest, 1e-7);
  OwnPoints again(points_);
  EXPECT_NEAR(write(again, "coarse.las", {.scale = {0.5}}).farthest, 0.25, 0.13);
  EXPECT_EQ(read("coarse.las").front(), (Point<3>{0, 7, 1}));
}

TEST_F(Convert, RoundsByNoChoiceOfItsOwnWhereThatIsRefused) {
  OwnPoints source(points_);
  EXPECT_THROW(write(source, "points.las", {.exact = true}), Error);
  EXPECT_FALSE(std::filesystem::exists(file("points.las")));
  const auto integers = generate_points({.family = "lattice", .count = 100});
  EXPECT_FALSE(write(*integers, "integers.las", {.exact = true}).rounded);
  EXPECT_THAT(phases_, Contains("generate"));
}

TEST_F(Convert, GivesAProgramOutputCoordinates) {
  const GenerateOptions hills{.family = "terrain", .count = 70'000};
  const auto expected = test::all_of(*generate_points(hills));
  write(*generate_points(hills), "hills.las");
  const Context context(options());
  OwnSink sink;
  const auto done = convert(*open_points({file("hills.las")}, {}, context), sink, context);
  EXPECT_EQ(done.written, 70'000U);
  EXPECT_EQ(sink.points, expected);
  EXPECT_EQ(sink.header.count, 70'000U);
  EXPECT_TRUE(sink.header.extent.has_value());
  EXPECT_TRUE(sink.is_finished);
}

TEST_F(Convert, TellsWhatIsLostAndWhatIsAdded) {
  const auto flat = generate_points({.family = "lattice", .count = 9});
  EXPECT_TRUE(write(*flat, "flat.las").adds_heights);
  const Context context(options());
  PointOptions how;
  how.metadata = true;
  EXPECT_THAT(write(*open_points({file("flat.las")}, how, context), "flat.xyz").lost,
              Contains("classification"));
  const auto kept = write(*open_points({file("flat.las")}, how, context), "again.las").lost;
  EXPECT_TRUE(kept.empty());
}

TEST_F(Convert, WritesAFileThatAProgramFillsByItself) {
  const Context context(options());
  const auto sink = create_points(file("points.xyz"), {}, context);
  EXPECT_EQ(code_of([&] { sink->write(points_); }), ErrorCode::kInvalidArgument);
  sink->begin({});
  sink->write(points_);
  EXPECT_FALSE(std::filesystem::exists(file("points.xyz")));
  sink->finish();
  EXPECT_EQ(read("points.xyz"), points_);
}

TEST_F(Convert, LazHasTheSameBytesWithAnyNumberOfThreads) {
  const GenerateOptions hills{.family = "terrain", .count = 230'000};
  std::vector<std::string> contents;
  for (const unsigned threads : {1U, 2U, 5U}) {
    ContextOptions how = options();
    how.threads = threads;
    const Context context(how);
    convert(*generate_points(hills), *create_points(file("hills.laz"), {}, context), context);
    contents.push_back(content("hills.laz"));
  }
  EXPECT_EQ(read("hills.laz"), test::all_of(*generate_points(hills)));
  EXPECT_TRUE(contents[1] == contents[0]);
  EXPECT_TRUE(contents[2] == contents[0]);
}

TEST_F(Convert, AProgramFillsLazOnAllThreads) {
  const auto all = test::all_of(*generate_points({.family = "terrain", .count = 210'000}));
  const Context context(options());
  const auto sink = create_points(file("hills.laz"), {.scale = {0.01}}, context);
  sink->begin({});
  for (std::span<const Point<3>> rest = all; !rest.empty();) {
    const std::size_t some = std::min<std::size_t>(rest.size(), 9'999);
    sink->write(rest.first(some));
    rest = rest.subspan(some);
  }
  sink->finish();
  const auto back = read("hills.laz");
  ASSERT_EQ(back.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_NEAR(back[i][2], all[i][2], 0.0051) << i;
}

TEST_F(Convert, RefusesOptionsThatCannotBe) {
  const Context context(options());
  const auto code = [&](const char* name, const PointFileOptions& how) {
    return code_of([&] { create_points(file(name), how, context); });
  };
  EXPECT_EQ(code("points.doc", {}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code("points.xyz", {.las_version = "1.4"}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code("points.las", {.las_version = "1.3"}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code("points.las", {.scale = {1, 2}}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code("points.las", {.scale = {0}}), ErrorCode::kInvalidArgument);
}

TEST_F(Convert, NamesThePointThatALatticeCannotHold) {
  OwnPoints source({{1, 1, 1}, {3e9, 1, 1}});
  try {
    write(source, "points.las", {.scale = {1}, .offset = {0}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_EQ(error.facts().remedy, Remedy::kPointLattice);
    EXPECT_EQ(error.facts().place.number, 1U);
  }
}

class Breaks : public OwnPoints {
 public:
  using OwnPoints::OwnPoints;
  bool read(std::vector<Point<3>>& points) override {
    if (OwnPoints::read(points)) return true;
    throw std::runtime_error("the sensor is off");
  }
};

TEST_F(Convert, LeavesNothingOfWhatWasNotFinished) {
  Breaks source(points_);
  EXPECT_THROW(write(source, "points.spp"), std::runtime_error);
  const Context context(stopped());
  OwnPoints points(points_);
  const auto sink = create_points(file("points.spp"), {}, context);
  EXPECT_EQ(code_of([&] { convert(points, *sink, context); }), ErrorCode::kInterrupted);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace spillway
