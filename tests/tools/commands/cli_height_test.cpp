#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A slope of ground (class 2), z = x + y, and points above it (class 5), whose height is in their
/// intensity; the last two lie beside it.
std::string forest() {
  std::mt19937 random(3);
  std::string text = "x,y,z,classification,intensity\n";
  const auto add = [&](int x, int y, int height, int code) {
    text += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(x + y + height) +
            "," + std::to_string(code) + "," + std::to_string(height) + "\n";
  };
  for (int y = 0; y <= 40; y += 4) {
    for (int x = 0; x <= 40; x += 4) add(x, y, 0, 2);
  }
  for (int i = 0; i < 300; ++i) {
    add(static_cast<int>(random() % 41), static_cast<int>(random() % 41),
        static_cast<int>(random() % 30), 5);
  }
  add(60, 60, 9, 5);
  add(-3, 2, 9, 5);
  return text;
}

/// The rows of a CSV by column, without its first line.
std::vector<std::vector<double>> rows_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows.push_back(row);
  }
  return rows;
}

struct Refusal {
  const char* arguments;
  const char* message;
};

class Height : public ::testing::Test {
 protected:
  Height() {
    space.write("forest.csv", forest());
    space.succeed("spillway convert forest.csv -o forest.laz --scale 0.01");
  }

  /// The rows of x, y, z, class, intensity and height in a CSV are right.
  void check(const std::string& name, std::size_t count) {
    const auto rows = rows_of(space.read(name));
    EXPECT_EQ(rows.size(), count);
    for (const std::vector<double>& row : rows) {
      const bool beside = row[0] < 0 || row[0] > 40;
      EXPECT_EQ(row.back(), beside ? -9999 : row[2] - row[0] - row[1]);
    }
  }

  Workspace space;
};

TEST_F(Height, IsWrittenForEveryPointInItsOrder) {
  space.succeed("spillway height forest.csv --ground-class 2 -o out.csv");
  check("out.csv", 423);
  EXPECT_THAT(space.read("out.csv"), HasSubstr("HeightAboveGround"));
  const auto before = rows_of(forest());
  const auto after = rows_of(space.read("out.csv"));
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < before[i].size(); ++k) EXPECT_EQ(after[i][k], before[i][k]);
  }
}

TEST_F(Height, IsCarriedInLasAsExtraBytesThatGoOn) {
  space.succeed("spillway height forest.laz --ground-class 2 -o out.laz");
  space.succeed(
      "spillway convert out.laz -o out.csv --attributes classification,HeightAboveGround");
  check("out.csv", 423);
}

TEST_F(Height, TellsPointsBesideTheGround) {
  const Result result = space.run("spillway height forest.laz --ground-class 2 -o out.laz");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("2 points lie over no triangle of the ground"));
  EXPECT_THAT(result.err, HasSubstr("423 points in out.laz, heights from 0 to 29, 0 below"));
}

TEST_F(Height, IsTheSameFromAPipeAsFromAFile) {
  space.succeed("spillway height forest.laz --ground-class 2 -o file.spp --keep-class 5");
  space.succeed(
      "cat forest.laz | spillway height - --ground-class 2 -o pipe.csv --keep-class 5 "
      "--attributes classification");
  space.succeed(
      "spillway convert file.spp -o file.csv --attributes classification,HeightAboveGround");
  EXPECT_EQ(space.read("pipe.csv"), space.read("file.csv"));
  check("pipe.csv", 302);
  space.succeed(
      "cat forest.laz | spillway height - --ground-class 2 -o - | spillway info - > info");
  EXPECT_THAT(space.read("info"), HasSubstr("HeightAboveGround"));
}

/// The ground is there whatever is wanted of the other points.
TEST_F(Height, OfPointsThatAreClippedIsTheSame) {
  space.succeed("spillway height forest.csv --ground-class 2 -o out.csv --z-range 30,60");
  const auto rows = rows_of(space.read("out.csv"));
  EXPECT_GT(rows.size(), 100U);
  check("out.csv", rows.size());
  for (const auto& row : rows) EXPECT_TRUE(row[2] >= 30 && row[2] <= 60) << row[2];
  space.succeed(
      "tr , ';' < forest.csv | spillway height - --ground-class 2 -o pipe.csv --z-range 30,60 "
      "--separator semicolon --columns x,y,z");
  EXPECT_EQ(space.read("pipe.csv"), space.read("out.csv"));
  if (build_lacks("GDAL")) return;
  space.write("area.csv", "n,WKT\n1,\"POLYGON ((10 10,20 10,20 20,10 20,10 10))\"\n");
  space.succeed("spillway height forest.csv --ground-class 2 -o out.csv --clip area.csv");
  check("out.csv", rows_of(space.read("out.csv")).size());
  EXPECT_GT(rows_of(space.read("out.csv")).size(), 10U);
  const Result moved = space.run(
      "spillway height forest.csv --ground-class 2 -o out.csv --crs EPSG:32633 --to-crs EPSG:3857 "
      "--multiply-z 2");
  // Points and ground are both brought there.
  EXPECT_THAT(moved.err, HasSubstr("423 points in out.csv, heights from"));
  EXPECT_THAT(moved.err, HasSubstr(" to 58, "));
}

TEST_F(Height, IsMeasuredAboveOtherPointsAndMeshesToo) {
  space.succeed("spillway convert forest.csv -o ground.csv --keep-class 2");
  space.succeed("spillway triangulate ground.csv -o ground.spm");
  space.succeed("spillway height forest.csv --ground-class 2 -o class.csv");
  space.succeed("spillway height forest.csv --ground ground.csv -o points.csv");
  space.succeed("spillway height forest.csv --ground ground.spm -o mesh.csv");
  space.succeed("spillway height forest.csv --ground - -o pipe.csv < ground.spm");
  space.succeed("spillway height forest.csv --ground forest.csv --ground-class 2 -o both.csv");
  for (const char* const name : {"points.csv", "mesh.csv", "pipe.csv", "both.csv"}) {
    EXPECT_EQ(space.read(name), space.read("class.csv")) << name;
  }
}

TEST_F(Height, TakesThePlaceOfZ) {
  space.succeed(
      "spillway height forest.laz --ground-class 2 -o out.las --replace-z --min-height 1 "
      "--max-height 20");
  space.succeed("spillway convert out.las -o out.csv --attributes intensity");
  const auto rows = rows_of(space.read("out.csv"));
  EXPECT_GT(rows.size(), 100U);
  for (const auto& row : rows) {
    EXPECT_EQ(row[2], row[3]);
    EXPECT_GE(row[2], 1);
    EXPECT_LE(row[2], 20);
  }
  EXPECT_THAT(space.succeed("spillway info out.las"), Not(HasSubstr("HeightAboveGround")));
}

TEST_F(Height, HasTheSameBytesForAllThreadsAndMemories) {
  space.succeed("spillway generate scan --count 120000 --seed 4 -o scan.las");
  space.succeed("spillway convert scan.las -o ground.las --every 7");
  for (const char* const how : {"--threads 1 --memory 2G", "--threads 2 --memory 64M",
                                "--threads 2 --memory 64M --leaf-points 500"}) {
    space.succeed(std::string("spillway height scan.las --ground ground.las -o out.las ") + how);
    if (!space.has("first.las")) space.succeed("cp out.las first.las");
    space.succeed("cmp out.las first.las");
  }
}

TEST_F(Height, MakesACanopyInOneCommand) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed("spillway dem forest.laz -o chm.tif --resolution 1 --product chm");
  // The same in steps.
  space.succeed(
      "spillway height forest.laz --ground-class 2 -o heights.spp --replace-z --min-height 0");
  space.succeed("spillway dem heights.spp -o steps.tif --resolution 1 --heights highest");
  space.succeed("cmp chm.tif steps.tif");
  space.succeed("cat forest.laz | spillway dem - -o pipe.tif --resolution 1 --product chm");
  space.succeed("cmp chm.tif pipe.tif");
  const Result told = space.run("spillway dem forest.laz -o chm.tif --resolution 1 --product chm");
  EXPECT_THAT(told.err, HasSubstr("421 points above a ground of 200 triangles; 0 below it and 2 "
                                  "over no triangle left out"));
  const Refusal refusals[] = {{"--product chm,height", "chm is a raster of its own"},
                              {"--product height --ground-class 2", "without --product chm"},
                              {"--product chm --resume folder", "takes two runs"}};
  for (const auto& [arguments, message] : refusals) {
    const Result result =
        space.run(std::string("spillway dem forest.laz -o a.tif --resolution 1 ") + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
  }
}

TEST_F(Height, IsTheSameFromANamedPipe) {
  space.succeed("spillway height forest.laz --ground-class 2 -o file.csv --attributes none");
  space.succeed(
      "mkfifo pipe && (cat forest.laz > pipe &) && "
      "spillway height pipe --ground-class 2 -o pipe.csv --attributes none");
  EXPECT_EQ(space.read("pipe.csv"), space.read("file.csv"));
}

TEST_F(Height, IsWrittenToTextThatHasNoOtherAttributes) {
  space.succeed("spillway height forest.csv --ground-class 2 -o out.xyz");
  std::istringstream first(space.read("out.xyz"));
  std::vector<std::string> words;
  for (std::string line, word; words.empty() && std::getline(first, line);) {
    std::istringstream parts(line);
    while (parts >> word) words.push_back(word);
  }
  EXPECT_EQ(words.size(), 4U);
}

TEST_F(Height, OfPointsOnAnotherFineLatticeIsThatOfTheirPlaces) {
  std::string points;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 30; ++x) {
      points += std::to_string(500000 + 0.37 * x) + " " + std::to_string(5000000 + 0.37 * y) + " " +
                std::to_string(x * y % 7) + "\n";
    }
  }
  space.write("grid.xyz", points);
  space.succeed(
      "spillway convert grid.xyz -o ground.las --scale 0.0001 --offset 499000.003,4999000.007,0");
  space.succeed("spillway height grid.xyz --ground ground.las -o out.csv");
  const auto rows = rows_of(space.read("out.csv"));
  EXPECT_EQ(rows.size(), 900U);
  for (const auto& row : rows) EXPECT_EQ(row.back(), 0);
}

TEST_F(Height, TellsStatistics) {
  space.succeed("spillway height forest.laz --ground-class 2 -o out.laz --stats stats.json");
  const auto stats = nlohmann::json::parse(space.read("stats.json"));
  EXPECT_EQ(stats["heights"]["written"], 423);
  EXPECT_EQ(stats["heights"]["without_ground"], 2);
  EXPECT_EQ(stats["heights"]["highest"], 29);
  EXPECT_EQ(stats["simplices"], 200);
}

TEST_F(Height, OfThinnedPointsIsMeasured) {
  space.succeed("spillway height forest.csv --ground-class 2 -o all.csv --thin 8:highest");
  const auto rows = rows_of(space.read("all.csv"));
  EXPECT_GT(rows.size(), 20U);
  EXPECT_LT(rows.size(), 60U);
  check("all.csv", rows.size());
}

TEST_F(Height, RefusesWhatCannotBe) {
  space.write("flat.csv", "x,y\n1,2\n3,4\n5,1\n");
  space.succeed("spillway triangulate forest.csv -o tin.spm");
  const Refusal usage[] = {
      {"forest.csv -o out.csv", "what is the ground?"},
      {"forest.csv -o out.csv --ground-class two", "--ground-class"},
      {"- --ground - -o out.csv", "either the points or the ground"},
      {"forest.csv --ground tin.spm --ground-class 2 -o out.csv", "--ground-class has no effect"},
      {"forest.csv --ground tin.spm --max-edge 3 -o out.csv", "--max-edge has no effect"},
      {"forest.csv --ground-class 2 -o out.csv --nodata none", "is not a height"},
      {"forest.csv --ground-class 2 -o out.csv --mesh-format ply", "without --ground"},
      {"forest.csv --ground-class 2 -o out.csv --min-height 2 --nodata 3",
       "--nodata has no effect"},
      {"forest.csv --ground tin.spm -o tin.spm --output-format spp", "--force"},
      {"forest.csv --ground-class 2 -o forest.csv --replace-z", "--force"},
  };
  for (const auto& [arguments, message] : usage) {
    const Result result = space.run(std::string("spillway height ") + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
  }
  const Refusal failures[] = {
      {"forest.csv --ground-class 9 -o out.csv", "no points"},
      {"forest.csv --ground none.las -o out.csv", "none.las"},
      {"flat.csv --ground forest.csv -o out.csv", "no z"},
      {"forest.csv --ground-class 2 -o out.csv --replace-z --nodata nan", "need a number as z"},
      {"forest.csv --ground-class 2 -o out.csv --min-height 3 --max-height 2", "no height is 3"},
      {"forest.csv --ground-class 2 -o out.csv --memory 40M", "--memory 64M"},
  };
  for (const auto& [arguments, message] : failures) {
    const Result result = space.run(std::string("spillway height ") + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
  }
  EXPECT_FALSE(space.has("out.csv"));
}

TEST_F(Height, RefusesAGroundInAnotherCoordinateSystem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed("spillway convert forest.csv -o points.laz --scale 0.01 --crs EPSG:25832");
  space.succeed(
      "spillway convert forest.csv -o ground.laz --scale 0.01 --crs EPSG:25833 --keep-class 2");
  const Result result = space.run("spillway height points.laz --ground ground.laz -o out.laz");
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("EPSG:25833"));
  EXPECT_THAT(result.err, HasSubstr("--force-crs"));
  EXPECT_FALSE(space.has("out.laz"));
  space.succeed(
      "spillway height points.laz --ground ground.laz -o out.laz --force-crs --crs EPSG:25832");
}

TEST_F(Height, OfASurveyIsWhatItWasMeasuredToBe) {
  const auto survey = shared_file("autzen_trim.laz");
  if (survey.empty()) GTEST_SKIP() << "the shared sample data is not there";
  const Result result =
      space.run("spillway height " + survey.string() + " --ground-class 2 -o out.laz");
  // Compared with a linear interpolation of scipy's over all points.
  EXPECT_THAT(result.err, HasSubstr("72 points lie over no triangle"));
  EXPECT_THAT(result.err, HasSubstr("110000 points in out.laz, heights from -1.9 to 108.48, 2753 "
                                    "below the ground of 52187 triangles"));
}

}  // namespace
}  // namespace spillway::test
