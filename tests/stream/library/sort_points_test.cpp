// Point files that convert() sorts: <spillway/points.h>, SortOptions.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/generate.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "formats/inputs/open_points.h"
#include "stream/tiles/regions/region_plan.h"
#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using test::OwnPoints;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Sort : public test::CallTest {
 protected:
  PointConversion sort(PointSource& source, const std::string& name, const SortOptions& how = {},
                       const std::string& memory = "32M", std::vector<double> scale = {}) {
    ContextOptions limits = options();
    limits.memory = memory;
    const Context context(limits);
    return convert(source,
                   *create_points(file(name), {.scale = std::move(scale), .sorted = how}, context),
                   context);
  }

  std::vector<Point<3>> read(const std::string& name) {
    return test::all_of(*open_points({file(name)}, {}, Context(options())));
  }

  formats::PointHeader header_of(const std::string& name) {
    return formats::open_point_reader(formats::disk(), file(name), {})->header();
  }

  /// The reader proves that cells are what their table says.
  void expect_same_points(std::vector<Point<3>> expected, const std::string& name) {
    std::vector<Point<3>> found = read(name);
    std::ranges::sort(found);
    std::ranges::sort(expected);
    EXPECT_EQ(found, expected);
  }
};

TEST_F(Sort, KeepsAllPointsOfALattice) {
  const GenerateOptions hills{.family = "terrain", .count = 600'000};
  const PointConversion done = sort(*generate_points(hills), "hills.spp");
  EXPECT_EQ(done.written, 600'000U);
  EXPECT_EQ(done.points.read, 600'000U);
  EXPECT_GE(done.cells, 10U);
  EXPECT_GT(done.spilled_points, 0U);
  const formats::PointHeader header = header_of("hills.spp");
  EXPECT_TRUE(header.lattice.has_value());
  EXPECT_EQ(header.regions.size(), done.cells);
  for (const formats::PointRegion& cell : header.regions) EXPECT_LE(cell.count, 65'536U);
  expect_same_points(test::all_of(*generate_points(hills)), "hills.spp");
  EXPECT_EQ(phases_.front(), "read");
  EXPECT_EQ(phases_.back(), "write");
}

TEST_F(Sort, WritesCellsSoThatLargerOnesOfThemAreCompleteOneAfterTheOther) {
  const GenerateOptions hills{.family = "terrain", .count = 600'000};
  sort(*generate_points(hills), "told.spp", {.cell_points = 2'000});
  OwnPoints source(test::all_of(*generate_points(hills)));  // tells no extent
  sort(source, "untold.spp", {.cell_points = 2'000});
  for (const char* const name : {"told.spp", "untold.spp"}) {
    std::vector<stream::InputRegion> cells;
    for (const formats::PointRegion& cell : header_of(name).regions) {
      cells.push_back({0, cell.box, cell.count});
    }
    for (const double most_points : {8'000, 32'000}) {
      const stream::RegionPlan plan =
          stream::plan_regions(cells, {.most_points = most_points, .any_order = false});
      EXPECT_LT(plan.most_waiting, 6 * most_points) << name;
    }
  }
}

TEST_F(Sort, DividesSpaceWhereThatIsWanted) {
  const GenerateOptions cloud{.family = "uniform", .count = 100'000, .dimension = 3};
  sort(*generate_points(cloud), "columns.spp", {.cell_points = 2'000});
  sort(*generate_points(cloud), "cubes.spp", {.dimension = 3, .cell_points = 2'000});
  const auto all_reach_through = [&](const std::string& name) {
    return std::ranges::all_of(header_of(name).regions, [](const formats::PointRegion& cell) {
      return cell.box.extent(2) > 0.9;
    });
  };
  EXPECT_TRUE(all_reach_through("columns.spp"));
  EXPECT_FALSE(all_reach_through("cubes.spp"));
  expect_same_points(test::all_of(*generate_points(cloud)), "columns.spp");
  expect_same_points(test::all_of(*generate_points(cloud)), "cubes.spp");
}

TEST_F(Sort, PointsWithoutHeightsStayWithout) {
  const GenerateOptions plane{.family = "uniform", .count = 5'000};
  sort(*generate_points(plane), "plane.spp", {.cell_points = 100});
  EXPECT_EQ(header_of("plane.spp").coordinates, 2);
  EXPECT_GE(header_of("plane.spp").regions.size(), 50U);
  expect_same_points(test::all_of(*generate_points(plane)), "plane.spp");
}

TEST_F(Sort, AnyNumberOfPoints) {
  for (const std::size_t count : {0, 1, 2, 10}) {
    std::vector<Point<3>> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({double(i * 7 % 10), double(i), 0.5});
    for (const std::uint64_t cell_points : {0, 1, 3}) {
      const std::string name = fmt::format("{}-{}.spp", count, cell_points);
      OwnPoints source(points);
      const PointConversion done = sort(source, name, {.cell_points = cell_points});
      EXPECT_EQ(done.written, count);
      EXPECT_EQ(done.cells == 0, count == 0);
      expect_same_points(points, name);
    }
  }
}

TEST_F(Sort, EqualPointsStayInTheirOrderAndInOneCell) {
  std::vector<Point<3>> points;
  for (std::size_t i = 0; i < 700'000; ++i) {
    points.push_back({double(i * 7919 % 50), double(i * 104'729 % 40), double(i)});
  }
  OwnPoints source(points);
  sort(source, "places.spp", {.cell_points = 5'000});
  std::map<std::pair<double, double>, double> last;
  for (const Point<3>& point : read("places.spp")) {
    const auto [place, is_new] = last.try_emplace({point[0], point[1]}, point[2]);
    EXPECT_TRUE(is_new || place->second < point[2]);
    place->second = point[2];
  }
  expect_same_points(points, "places.spp");
}

TEST_F(Sort, MoreEqualPointsThanACellHasRoomFor) {
  std::vector<Point<3>> points(300'000, {1, 2, 3});
  points.push_back({5, 2, 3});
  OwnPoints source(points);
  EXPECT_EQ(sort(source, "equal.spp", {.cell_points = 1'000}).cells, 2U);
  expect_same_points(points, "equal.spp");
}

TEST_F(Sort, RoundsBeforeItDivides) {
  std::vector<Point<3>> points;
  for (std::size_t i = 0; i < 50'000; ++i) {
    points.push_back({double(i % 223) / 100, double(i % 227) / 100, double(i)});
  }
  OwnPoints source(points);  // tells no extent, so the first points decide where steps begin
  const PointConversion done = sort(source, "coarse.spp", {.cell_points = 500}, "32M", {0.5});
  EXPECT_TRUE(done.rounded);
  EXPECT_NEAR(done.farthest, 0.5, 0.5);
  std::map<std::pair<double, double>, std::size_t> cell_of;
  const auto reader = formats::open_point_reader(formats::disk(), file("coarse.spp"), {});
  formats::RawPoints raw;
  while (reader->fetch(raw)) {
    for (const geometry::LatticePoint& point : raw.decoded.points) {
      const auto [place, is_new] = cell_of.try_emplace({point[0], point[1]}, raw.region);
      EXPECT_EQ(place->second, raw.region);
    }
    raw.clear();
  }
  EXPECT_GT(header_of("coarse.spp").regions.size(), 5U);
}

TEST_F(Sort, SameBytesWithAnyThreads) {
  const GenerateOptions hills{.family = "terrain", .count = 400'000};
  for (const unsigned threads : {1U, 4U}) {
    ContextOptions limits = options();
    limits.memory = "32M";
    limits.threads = threads;
    const Context context(limits);
    const std::string name = fmt::format("{}.spp", threads);
    convert(*generate_points(hills),
            *create_points(file(name), {.sorted = SortOptions{.cell_points = 9'000}}, context),
            context);
  }
  EXPECT_EQ(read("1.spp"), read("4.spp"));
}

TEST_F(Sort, RefusesWhatCannotBe) {
  const Context context(options());
  const SortOptions sorted;
  EXPECT_EQ(code_of([&] { create_points(file("a.las"), {.sorted = sorted}, context); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] {
              create_points(file("a.spp"), {.sorted = SortOptions{.dimension = 4}}, context);
            }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_points(file("a.spp"), {.sorted = sorted}, context)->begin({}); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { sort(*generate_points({.count = 10}), "a.spp", {}, "1M"); }),
            ErrorCode::kOutOfBudget);
  EXPECT_FALSE(std::filesystem::exists(file("a.spp")));
}

TEST_F(Sort, LeavesNothingBehindIfItIsStopped) {
  const Context context(stopped());
  EXPECT_EQ(code_of([&] {
              convert(*generate_points({.count = 1000}),
                      *create_points(file("a.spp"), {.sorted = SortOptions{}}, context), context);
            }),
            ErrorCode::kInterrupted);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace spillway
