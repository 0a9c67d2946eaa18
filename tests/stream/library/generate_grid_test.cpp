// Generated points as the files of a survey: <spillway/generate.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using ::testing::ElementsAre;

class GeneratedGrid : public test::CallTest {
 protected:
  /// The points of each file, by its name.
  std::map<std::string, std::vector<Point<3>>> files() {
    std::map<std::string, std::vector<Point<3>>> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const Context context(options());
      const auto source = open_points({entry.path()}, {}, context);
      const PointsHeader header = source->header();
      auto& points = all[entry.path().filename()] = test::all_of(*source);
      if (header.extent) {
        EXPECT_EQ(header.count, points.size());
        expect_tight(*header.extent, points);
      }
    }
    return all;
  }

  static void expect_tight(const Extent& extent, const std::vector<Point<3>>& points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [least, most] =
          std::ranges::minmax(points, {}, [&](const Point<3>& point) { return point[axis]; });
      EXPECT_EQ(extent.low[axis], least[axis]);
      EXPECT_EQ(extent.high[axis], most[axis]);
    }
  }

  static std::vector<Point<3>> sorted(std::vector<Point<3>> points) {
    std::ranges::sort(points);
    return points;
  }

  GridReport write(const GenerateOptions& what, const std::string& name, const GridOptions& grid) {
    const Context context(options());
    return generate_grid(what, file(name), grid, context);
  }
};

TEST_F(GeneratedGrid, HoldsEachPointOfAFamilyOnceAndInOrder) {
  for (const auto& [family, name] : std::map<std::string, std::string>{{"terrain", "a_#.las"},
                                                                       {"scan", "a_#.las"},
                                                                       {"lattice", "a_#.laz"},
                                                                       {"uniform", "a_#.spp"},
                                                                       {"circle", "a_#.npy"}}) {
    const GenerateOptions what{.family = family, .count = 70'000, .seed = 3};
    const GridReport report = write(what, name, {.columns = 4, .rows = 3, .overlap = 0.1});
    const auto tiles = files();
    EXPECT_EQ(report.points, 70'000U);
    EXPECT_EQ(report.files, tiles.size()) << family;
    const std::vector<Point<3>> all = test::all_of(*generate_points(what));
    std::vector<Point<3>> together;
    for (const auto& [tile, points] : tiles) {
      auto next = all.begin();
      for (const Point<3>& point : points) next = std::find(next, all.end(), point);
      EXPECT_NE(next, all.end()) << tile << " is in another order";
      together.insert(together.end(), points.begin(), points.end());
      std::filesystem::remove(file(tile));
    }
    EXPECT_EQ(sorted(together), sorted(all)) << family;
  }
}

TEST_F(GeneratedGrid, HasNeighboursThatOverlapAndTilesOfUnevenSizes) {
  write({.family = "terrain", .count = 50'000}, "a_#.las", {.columns = 3, .rows = 3});
  std::map<std::string, Extent> boxes;
  const Context context(options());
  for (const auto& [name, points] : files()) {
    boxes[name] = *open_points({file(name)}, {}, context)->header().extent;
  }
  ASSERT_EQ(boxes.size(), 9U);
  for (const std::string row : {"00", "01", "02"}) {
    EXPECT_GT(boxes["a_00_" + row + ".las"].high[0], boxes["a_01_" + row + ".las"].low[0]);
    EXPECT_LT(boxes["a_00_" + row + ".las"].high[0], boxes["a_02_" + row + ".las"].low[0]);
    EXPECT_GT(boxes["a_" + row + "_01.las"].high[1], boxes["a_" + row + "_02.las"].low[1]);
  }
  std::vector<double> areas;
  for (const auto& [name, box] : boxes) {
    areas.push_back((box.high[0] - box.low[0]) * (box.high[1] - box.low[1]));
  }
  EXPECT_GT(std::ranges::max(areas), 1.3 * std::ranges::min(areas));
}

TEST_F(GeneratedGrid, IsTriangulatedAsOneFileIs) {
  const GenerateOptions what{.family = "terrain", .count = 30'000};
  write(what, "a_#.las", {.columns = 5, .rows = 4, .overlap = 0.2});
  const Context context(options());
  MeshInMemory of_one;
  MeshInMemory of_many;
  const Report one = triangulate(*generate_points(what), of_one, {}, context);
  const Report many =
      triangulate(*open_points({file("a_*.las")}, {}, context), of_many, {}, context);
  EXPECT_EQ(one.mesh.canonical_hash, many.mesh.canonical_hash);
}

TEST_F(GeneratedGrid, HasNoFilesForTilesWithoutPoints) {
  const GridReport report =
      write({.family = "circle", .count = 2000}, "a_#.npy", {.columns = 20, .rows = 20});
  EXPECT_LT(report.files, 200U);
  EXPECT_EQ(files().size(), report.files);
}

TEST_F(GeneratedGrid, IsWrittenInSeveralGroupsOfFiles) {
  const GenerateOptions what{.family = "lattice", .count = 40'000};
  const GridReport report = write(what, "a_#.npy", {.columns = 20, .rows = 20});
  EXPECT_EQ(report.files, 400U);
  EXPECT_THAT(phases_, ElementsAre("measure", "generate"));
  std::vector<Point<3>> together;
  for (const auto& [name, points] : files()) {
    together.insert(together.end(), points.begin(), points.end());
  }
  EXPECT_EQ(sorted(together), sorted(test::all_of(*generate_points(what))));
}

TEST_F(GeneratedGrid, RefusesWhatCannotBeAndLeavesNothing) {
  const GenerateOptions terrain{.family = "terrain", .count = 1000};
  const auto code = [&](const GenerateOptions& what, const std::string& name,
                        const GridOptions& grid) {
    return code_of([&] { write(what, name, grid); });
  };
  EXPECT_EQ(code(terrain, "a_#.las", {.columns = 0}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(terrain, "a_#.las", {.columns = 101, .rows = 100}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(terrain, "a_#.las", {.overlap = 0.41}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(terrain, "a.las", {}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.family = "uniform", .count = 9}, "a_#.las", {}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.family = "clouds"}, "a_#.las", {}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.family = "terrain", .count = 0}, "a_#.las", {}), ErrorCode::kInvalidArgument)
      << "there would be no file";
  EXPECT_EQ(code(terrain, "no/a_#.las", {}), ErrorCode::kInputOutput);
  EXPECT_EQ(files().size(), 0U);
  write(terrain, "a_#.las", {});
  EXPECT_EQ(code(terrain, "a_#.las", {.columns = 2}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(GeneratedGrid, LeavesNothingWhenItIsStopped) {
  const Context context(stopped());
  EXPECT_EQ(code_of([&] { generate_grid({.count = 100}, file("a_#.npy"), {}, context); }),
            ErrorCode::kInterrupted);
  EXPECT_EQ(files().size(), 0U);
}

}  // namespace
}  // namespace spillway
