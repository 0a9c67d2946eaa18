// Jobs side by side: what they know of their neighbours, and who is told that they know nothing.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kPixel = 0.5;
constexpr int kSide = 50;  ///< points along a side of the whole, 2 apart

/// Values by column and row, counted from 0, 0 on: the same pixels in all aligned rasters.
using Pixels = std::map<std::pair<int, int>, float>;

Pixels pixels_of(const Workspace& space, const std::string& name) {
  const OpenedRaster raster(space, name);
  const std::vector<float> values = raster.pixels();
  const int west = static_cast<int>(std::lround(raster.transform[0] / kPixel));
  const int north = static_cast<int>(std::lround(raster.transform[3] / kPixel));
  Pixels pixels;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int row = static_cast<int>(i) / raster.columns();
    pixels[{west + static_cast<int>(i) % raster.columns(), north - row}] = values[i];
  }
  return pixels;
}

/// Four tiles of 50 x 50, a to d, in `in`: points about 2 apart, of which the last lie about 1
/// before the edges of the tiles. Those at the edge of the whole lie in line.
class Neighbours : public ::testing::Test {
 protected:
  Neighbours() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.4, 0.4);
    std::map<char, std::string> tiles;
    for (int i = 0; i < kSide * kSide; ++i) {
      const int column = i % kSide;
      const int row = i / kSide;
      const bool edge = column % (kSide - 1) == 0 || row % (kSide - 1) == 0;
      const double x = 2 * column + 1 + (edge ? 0 : shift(random));
      const double y = 2 * row + 1 + (edge ? 0 : shift(random));
      const char tile = static_cast<char>('a' + column / (kSide / 2) + row / (kSide / 2) * 2);
      tiles[tile] += fmt::format("{:.3f} {:.3f} {:.3f}\n", x, y, 5 * std::sin(x / 7 + y / 9));
    }
    space.succeed("mkdir in text");
    for (const auto& [name, points] : tiles) {
      space.write(fmt::format("text/{}.xyz", name), points);
      space.succeed(fmt::format(
          "spillway convert -q text/{0}.xyz -o in/{0}.las --scale 0.001 --offset 0", name));
    }
    space.succeed("spillway dem -q in -o whole.tif --resolution 0.5 --align");
  }

  void make_rasters(const std::string& inputs, int buffer) const {
    space.succeed(fmt::format(
        "spillway batch {} --output-dir out --buffer {} --to dem.tif --resolution {} -q", inputs,
        buffer, kPixel));
  }

  /// That the rasters of these jobs are those of the whole, overlap by a row of pixels at most,
  /// and leave out none.
  void expect_the_whole(const std::vector<std::string>& jobs,
                        const std::string& product = "dem") const {
    const Pixels whole = pixels_of(space, "whole.tif");
    std::map<std::pair<int, int>, int> times;
    for (const std::string& name : jobs) {
      for (const auto& [place, value] : pixels_of(space, "out/" + name + "." + product + ".tif")) {
        ++times[place];
        const auto found = whole.find(place);
        ASSERT_TRUE(found != whole.end()) << name;
        ASSERT_EQ(value, found->second) << name << ": " << place.first << ", " << place.second;
      }
    }
    EXPECT_EQ(times.size(), whole.size());
    std::size_t twice = 0;
    for (const auto& [place, count] : times) twice += count > 1 ? 1 : 0;
    EXPECT_LE(static_cast<double>(twice),
              static_cast<double>(jobs.size() - 1) * 2 * kSide / kPixel);
  }

  [[nodiscard]] std::string warning_of(const std::string& jobs, const std::string& more) const {
    return space.run("spillway batch " + jobs + " --output-dir out " + more).err;
  }

  Workspace space;
};

TEST_F(Neighbours, WithABufferMakeTheRasterOfTheWhole) {
  make_rasters("in", 15);
  expect_the_whole({"a", "b", "c", "d"});
}

/// Those of a pixel's neighbours, which lie in the raster of another job, too.
TEST_F(Neighbours, HaveSlopesWithoutSeams) {
  space.succeed(
      "spillway dem -q in -o whole.tif --resolution 0.5 --align --product slope\n"
      "spillway batch in --output-dir out --buffer 15 --to slope.tif --resolution 0.5 -q");
  expect_the_whole({"a", "b", "c", "d"}, "slope");
}

TEST_F(Neighbours, BehindOthersDoNotWidenTheRaster) {
  space.succeed(
      "mkdir row; for x in 0 20 40 60 80; do spillway convert -q in -o row/$x.las --scale 0.001 "
      "--offset 0 --bounds $x,0,$((x + 20)),100; done");
  make_rasters("row", 1000);
  expect_the_whole({"0", "20", "40", "60", "80"});
}

TEST_F(Neighbours, OfFormatsWithoutAHeaderAreReadForTheirPlace) {
  make_rasters("text", 15);
  expect_the_whole({"a", "b", "c", "d"});
}

TEST_F(Neighbours, AreReadByTheOptionsOfTheJobs) {
  space.succeed("for t in a b c d; do awk '{ print $2, $1, $3 }' text/$t.xyz > text/$t; done");
  space.succeed("rm text/*.xyz; for t in a b c d; do mv text/$t text/$t.txt; done");
  make_rasters("text --columns 2,1,3", 15);
  expect_the_whole({"a", "b", "c", "d"});
}

TEST_F(Neighbours, AreReadByWhatMakesSeveralOutputsOfOneTriangulation) {
  space.succeed(
      "spillway batch in --output-dir out --buffer 15 --to dem.tif,ply,contour.gpkg "
      "--resolution 0.5 --interval 1 -q");
  expect_the_whole({"a", "b", "c", "d"});
  const auto vertices = space.info("out/a.ply")["vertices"].get<int>();
  EXPECT_GT(vertices, 625 + 100) << "a mesh has the buffer, too";
  EXPECT_LT(vertices, 1300);
}

TEST_F(Neighbours, LeaveFiltersOfTheJobInForce) {
  space.succeed(
      "spillway batch in/a.las in/c.las --output-dir out --buffer 15 --to ply -q "
      "--bounds 0,0,30,1000");
  const auto extent = space.info("out/a.ply")["extent"];
  EXPECT_LE(extent["max"][0].get<double>(), 30);
  EXPECT_GT(extent["max"][1].get<double>(), 60);
  const Result result = space.run(
      "spillway batch in/a.las in/b.las --output-dir clipped --to ply,dem.tif --resolution 1"
      " --clip-bounds 0,0,30,1000 --buffer 30");
  EXPECT_LE(space.info("clipped/a.ply")["extent"]["max"][0].get<double>(), 30);
  EXPECT_THAT(result.err, HasSubstr("1 done, 1 failed")) << "of b nothing is left";
}

TEST_F(Neighbours, WithoutABufferAreWarnedOf) {
  const std::string warning =
      "4 of 4 jobs touch others, but know their own points only: rasters and contours are not "
      "right along the joins; --buffer M reads what others have within M, too";
  EXPECT_THAT(warning_of("in", "--to dem.tif --resolution 2"), HasSubstr(warning));
  EXPECT_THAT(warning_of("in", "--to contour.gpkg --interval 1"), HasSubstr(warning));
  for (const char* const fine :
       {"--to ply", "--to dem.tif --resolution 2 --buffer 9", "--to dem.tif --resolution 2 -q",
        "--to dem.tif --resolution 2 --buffer 0"}) {
    EXPECT_THAT(warning_of("in", fine), Not(HasSubstr("touch"))) << fine;
  }
}

TEST_F(Neighbours, AreNoneThatLieApartOrInOnePlace) {
  space.succeed(
      "mkdir apart same; cp in/a.las apart; cp in/a.las same; cp in/a.las same/again.las;"
      "spillway generate -q terrain -n 1000 --seed 3 -o apart/far.las");
  for (const char* const folder : {"apart", "same"}) {
    EXPECT_THAT(warning_of(folder, "--to dem.tif --resolution 2"), Not(HasSubstr("touch")));
  }
}

TEST_F(Neighbours, BelongToWhatResumeLooksAt) {
  space.succeed("spillway generate -q terrain -n 1000 --seed 3 -o in/far.las");
  const std::string command =
      "spillway batch in --output-dir out --to dem.tif --resolution 2 --resume --buffer 15";
  EXPECT_THAT(space.run(command).err, HasSubstr("5 done, 0 failed, 0 unchanged"));
  EXPECT_THAT(space.run(command).err, HasSubstr("0 done, 0 failed, 5 unchanged"));
  space.succeed("touch in/b.las");
  EXPECT_THAT(space.run(command).err, HasSubstr("4 done, 0 failed, 1 unchanged"));
  EXPECT_THAT(space.run(command + ".5").err, HasSubstr("5 done, 0 failed, 0 unchanged"));
}

TEST_F(Neighbours, OfAListHaveItsBufferOrTheirOwn) {
  space.write("jobs.toml",
              "to = ['dem.tif']\nbuffer = 15\noptions = { resolution = 0.5 }\n"
              "[[jobs]]\nin = 'in/a.las'\n[[jobs]]\nin = 'in/b.las'\nbuffer = 20.5\n"
              "[[jobs]]\nname = 'cd'\nin = ['in/c.las', 'in/d.las']\nbuffer = 0\n");
  space.succeed("spillway batch jobs.toml --output-dir out -q");
  const auto has = [&](const std::string& job, const std::string& text) {
    return space.read("out/" + job + ".status.json").find(text) != std::string::npos;
  };
  EXPECT_TRUE(has("a", "--clip-bounds=-14,-14,"));
  EXPECT_TRUE(has("a", "in/c.las"));
  EXPECT_TRUE(has("b", ",-19.5,"));
  EXPECT_FALSE(has("cd", "--clip-bounds"));
  EXPECT_FALSE(has("cd", "in/a.las"));
  space.succeed("spillway batch jobs.toml --output-dir out -q --buffer 3");
  EXPECT_TRUE(has("cd", "in/a.las")) << "the command line overrules the list";
}

TEST_F(Neighbours, WhatDoesNotGoWithABufferIsRefused) {
  const auto error_of = [&](const std::string& more) {
    const Result result = space.run("spillway batch in --output-dir out --to dem.tif " + more);
    EXPECT_EQ(result.exit_code, 2) << more;
    EXPECT_FALSE(space.has("out")) << more;
    return result.err;
  };
  EXPECT_THAT(error_of("--buffer 5 --like whole.tif"),
              HasSubstr("a: --like says what a raster covers, which --buffer does, too"));
  EXPECT_THAT(error_of("--buffer 5 --force-size --resolution 1"), HasSubstr("--force-size"));
  EXPECT_THAT(error_of("--buffer -5 --resolution 1"), HasSubstr("--buffer"));
  space.write("jobs.json", R"({"buffer": "wide", "to": "ply", "jobs": [{"in": "in/a.las"}]})");
  EXPECT_THAT(space.run("spillway batch jobs.json --output-dir out").err,
              HasSubstr("jobs.json: \"buffer\" is not a length: give a number of at least 0"));
}

TEST_F(Neighbours, GoOnWithoutOneThatCannotBeRead) {
  space.succeed("echo LASF and nothing else > in/d.las");
  const Result result =
      space.run("spillway batch in --output-dir out --buffer 15 --to dem.tif --resolution 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("d has no buffer, and its neighbours have nothing of it: "));
  EXPECT_THAT(result.err, HasSubstr("4 jobs: 3 done, 1 failed"));
}

TEST_F(Neighbours, PointsInABoxMakeTheRasterOfThesePoints) {
  space.succeed(
      "spillway convert -q in -o part.las --bounds 10,10,70,60 --scale 0.001 --offset 0;"
      "spillway dem -q part.las -o part.tif --resolution 0.5 --align;"
      "spillway dem -q in -o clipped.tif --resolution 0.5 --align --clip-bounds 10,10,70,60");
  EXPECT_EQ(pixels_of(space, "clipped.tif"), pixels_of(space, "part.tif"));
  space.succeed("spillway triangulate -q in -o tin.spm");
  EXPECT_THAT(
      space.run("spillway dem tin.spm -o x.tif --resolution 1 --clip-bounds 10,10,70,60").err,
      HasSubstr("--clip-bounds has no effect on tin.spm, which is a mesh"));
}

}  // namespace
}  // namespace spillway::test
