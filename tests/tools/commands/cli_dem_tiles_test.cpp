// The command `dem --tiles`: one raster as many files.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class DemTiles : public ::testing::Test {
 protected:
  DemTiles() { work_.succeed("spillway generate terrain -n 60000 --seed 3 -q -o in.las"); }

  nlohmann::json make(const std::string& arguments) {
    messages_ = work_.run("spillway dem in.las --resolution 0.25 --stats stats.json " + arguments);
    EXPECT_EQ(messages_.exit_code, 0) << messages_.err;
    return nlohmann::json::parse(work_.read("stats.json"))["raster"];
  }

  /// Writes NAME.gpkg of lines with a name and a geometry as WKT.
  void write_layer(const std::string& name, const std::string& lines,
                   const std::string& options = "") {
    work_.write(name + ".csv", "name,WKT\n" + lines);
    work_.succeed(
        fmt::format("ogr2ogr -q {0} {1}.gpkg {1}.csv -oo GEOM_POSSIBLE_NAMES=WKT", options, name));
  }

  /// Compares all bands of two rasters of the same place.
  void expect_equal(const std::string& a, const std::string& b) {
    const OpenedRaster first(work_, a);
    const OpenedRaster second(work_, b);
    ASSERT_EQ(first.columns(), second.columns());
    ASSERT_EQ(first.rows(), second.rows());
    EXPECT_EQ(first.transform, second.transform);
    ASSERT_EQ(first.file().GetRasterCount(), second.file().GetRasterCount());
    for (int band = 1; band <= first.file().GetRasterCount(); ++band) {
      EXPECT_TRUE(first.pixels(band) == second.pixels(band)) << a << ", " << b << ": " << band;
      if (a != "other.vrt") {  // gdalbuildvrt drops them
        EXPECT_STREQ(first.band(band).GetDescription(), second.band(band).GetDescription());
      }
      EXPECT_EQ(first.band(band).GetNoDataValue(), second.band(band).GetNoDataValue());
    }
  }

  Workspace work_;
  Result messages_;
};

TEST_F(DemTiles, EqualTheSingleRasterThroughTheirVrt) {
  for (const std::string options :
       {"--product height,slope,hillshade", "--product height,density --compress zstd",
        "--product max,height,count,p50", "--product min,stddev --fill-voids",
        "--product hillshade --type byte --compute-edges", "--cog --nodata nan",
        "--bounds 500210,4100110,500271.3,4100180"}) {
    work_.succeed("mkdir out");
    const auto stats = make("-o 'out/dtm_{x}_{y}.tif' --tiles 25 " + options);
    EXPECT_GT(stats["files"], 6) << options;
    make("-o one.tif --align " + options);
    const bool counts =
        options.find("density") != std::string::npos || options.find("count") != std::string::npos;
    if (counts || options.find("min") != std::string::npos) {
      EXPECT_EQ(stats["files_during_run"], 0) << "points of a pixel may come last";
    } else {
      EXPECT_GT(stats["files_during_run"], 0) << options;
    }
    if (counts) {
      EXPECT_EQ(stats["empty_tiles"], 0) << "a density of 0 is a value";
    }
    if (options.find("nan") == std::string::npos) expect_equal("out/dtm.vrt", "one.tif");
    work_.succeed("gdalbuildvrt -q other.vrt out/*.tif");
    if (options.find("nan") == std::string::npos) expect_equal("other.vrt", "one.tif");
    EXPECT_EQ(OpenedRaster(work_, "other.vrt").transform,
              OpenedRaster(work_, "out/dtm.vrt").transform);
    work_.succeed("rm -r out other.vrt one.tif");
  }
}

TEST_F(DemTiles, LieOnMultiplesOfTheirSideAndAreCalledSo) {
  make("-o 'dtm_{x}_{y}.tif' --tiles 50");
  const OpenedRaster tile(work_, "dtm_500200_4100200.tif");
  EXPECT_EQ(tile.columns(), 200);
  EXPECT_EQ(tile.rows(), 200);
  EXPECT_THAT(tile.transform, ElementsAre(500200, 0.25, 0, 4100250, 0, -0.25));
}

TEST_F(DemTiles, AreTheSameFilesForAllThreadsAndMemory) {
  std::vector<std::string> sums;
  for (const std::string how :
       {"--threads 1", "--threads 2 --memory 64M", "--threads 2 --tile-points 2000", "--tasks 2"}) {
    work_.succeed("mkdir out");
    make("-o 'out/dtm_{x}_{y}.tif' --tiles 25 --product height,slope " + how);
    sums.push_back(work_.run("cat out/* | cksum; ls out").out);
    EXPECT_EQ(sums.back(), sums.front()) << how;
    work_.succeed("rm -r out");
  }
}

TEST_F(DemTiles, WithoutDataHaveNoFile) {
  const auto stats = make("-o 'd_{x}_{y}.tif' --tiles 25 --bounds 499900,4100000,500100,4100100");
  EXPECT_GT(stats["empty_tiles"], 10);
  EXPECT_EQ(work_.run("ls d_*.tif | wc -l").out, fmt::format("{}\n", int{stats["files"]}));
  EXPECT_THAT(messages_.err, HasSubstr("without data"));
  make("-o one.tif --align --bounds 499900,4100000,500100,4100100");
  expect_equal("d.vrt", "one.tif");
}

TEST_F(DemTiles, OfPolygonsHaveThePixelsWhoseCentresLieInThem) {
  write_layer("sheets",
              "a,\"POLYGON((500160 4100160,500210 4100150,500205 4100240,500160 4100160))\"\n"
              "b,\"POLYGON((500210 4100150,500270 4100190,500205 4100240,500210 4100150))\"\n"
              "c,\"POLYGON((0 0,1 0,1 1,0 0))\"\n");
  const auto stats = make("-o 'p_{name}.tif' --align --tiles sheets.gpkg --vrt all.vrt");
  EXPECT_EQ(stats["files"], 2);
  EXPECT_EQ(stats["vrt"], "all.vrt");
  make("-o one.tif --align");
  const OpenedRaster one(work_, "one.tif");
  const OpenedRaster all(work_, "all.vrt");
  ASSERT_EQ(all.transform, one.transform);
  const auto expected = one.pixels();
  const auto pixels = all.pixels();
  work_.succeed(
      fmt::format("gdal_rasterize -q -burn 1 -init 0 -tr 0.25 0.25 -te {} {} {} {} "
                  "-ot Float32 sheets.gpkg mask.tif",
                  one.transform[0], one.transform[3] - 0.25 * one.rows(),
                  one.transform[0] + 0.25 * one.columns(), one.transform[3]));
  const auto mask = OpenedRaster(work_, "mask.tif").pixels();
  std::size_t inside = 0;
  std::size_t others = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i] != -9999) {
      EXPECT_EQ(pixels[i], expected[i]);
      ++inside;
    }
    // Centres on edges are told otherwise by GDAL.
    others += (mask[i] == 1 && expected[i] != -9999) != (pixels[i] != -9999) ? 1 : 0;
  }
  EXPECT_GT(inside, 40'000U);
  EXPECT_LT(others, inside / 1000);
}

TEST_F(DemTiles, AppearWhileTheRunGoesOn) {
  work_.succeed("spillway generate terrain -n 3000000 --seed 3 -q -o large.las; mkdir out");
  const pid_t process = work_.start({"dem", "-q", "large.las", "-o", "out/d_{x}_{y}.tif", "--tiles",
                                     "50", "--resolution", "0.5"});
  const auto tiles = [this] { return std::stoi(work_.run("ls out | grep -c 'tif$' || true").out); };
  while (tiles() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(process, SIGSTOP);  // most are still to come
  const int early = tiles();
  EXPECT_FALSE(
      work_.read("out/" + work_.run("ls out | grep 'tif$' | head -1 | tr -d '\n'").out).empty());
  kill(process, SIGCONT);
  kill(process, SIGTERM);
  EXPECT_EQ(wait_for_exit(process), 128 + SIGTERM);
  // Those that are complete stay; nothing else does.
  EXPECT_GE(tiles(), early);
  EXPECT_EQ(work_.run("ls -A out | grep -v 'tif$'").out, "");
  work_.succeed("for f in out/*.tif; do gdalinfo -checksum $f > /dev/null || exit 1; done");
}

TEST_F(DemTiles, OfARunThatIsKilledAreThoseOfAWholeOneAfterResume) {
  work_.succeed("spillway generate terrain -n 2000000 --seed 3 -q -o large.las; mkdir a b");
  const std::string how =
      " --resolution 0.5 --tiles 50 --product height,slope --tile-points 50000 -q";
  work_.succeed("spillway dem large.las -o 'a/d_{x}_{y}.tif'" + how);
  const std::string command =
      "dem large.las -o b/d_{x}_{y}.tif --resume folder --checkpoint-every 0" + how;
  std::istringstream words(command);
  const std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
  const auto tiles = [this] { return std::stoi(work_.run("ls b | grep -c 'tif$' || true").out); };
  for (int kills = 0; kills < 2; ++kills) {
    const int before = tiles();
    const pid_t process = work_.start(arguments);
    for (int i = 0; i < 2000 && tiles() == before; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    kill(process, SIGKILL);
    (void)wait_for_exit(process);
  }
  ASSERT_GT(tiles(), 0);
  work_.succeed(
      "rm -rf b/*.part; spillway dem large.las -o 'b/d_{x}_{y}.tif' --resume folder "
      "--checkpoint-every 0" +
      how);
  work_.succeed("diff -rq a b");
}

TEST_F(DemTiles, WarnsOfFilesThatLookLikeTilesOfTheRun) {
  work_.succeed("touch d_0_0.tif d_77.5_-3.tif d_x_0.tif");
  make("-o 'd_{x}_{y}.tif' --tiles 50");
  EXPECT_THAT(messages_.err, HasSubstr("warning: d_0_0.tif, d_77.5_-3.tif are called like tiles"));
  EXPECT_THAT(messages_.err, Not(HasSubstr("d_x_0.tif")));
}

TEST_F(DemTiles, TellWhatIsWrong) {
  const auto refused = [this](const std::string& arguments) {
    const Result result = work_.run("spillway dem in.las --resolution 0.25 " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    return result.err;
  };
  EXPECT_THAT(refused("-o d.tif --tiles 50"), HasSubstr("need {x} and {y}"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif'"), HasSubstr("give --tiles"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif' --tiles 0.3"), HasSubstr("whole number of pixels"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif' --tiles 0"), HasSubstr("above 0"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif' --tiles missing.gpkg"),
              HasSubstr("cannot read missing.gpkg"));
  EXPECT_THAT(refused("-o d.tif --vrt d.vrt"), HasSubstr("without --tiles"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif' --tiles 50 --align"), HasSubstr("align"));
  write_layer("lines", "a,\"LINESTRING(0 0,1 1)\"\n");
  EXPECT_THAT(refused("-o 'd_{name}.tif' --tiles lines.gpkg"),
              HasSubstr("feature 1 is no polygon, but LINESTRING"));
  write_layer("twice", "a,\"POLYGON((0 0,1 0,1 1,0 0))\"\na,\"POLYGON((0 0,1 0,1 1,0 0))\"\n");
  EXPECT_THAT(refused("-o 'd_{name}.tif' --tiles twice.gpkg"),
              HasSubstr("polygons 1 and 2 would both be d_a.tif"));
  EXPECT_THAT(refused("-o 'd_{id}.tif' --tiles twice.gpkg"), HasSubstr("no field \"id\""));
  EXPECT_THAT(refused("-o d.tif --tiles twice.gpkg"), HasSubstr("need a field"));
  write_layer("far", "a,\"POLYGON((0 0,1 0,1 1,0 0))\"\n");
  EXPECT_THAT(refused("-o 'd_{name}.tif' --tiles far.gpkg"),
              HasSubstr("none of the polygons has a pixel of the raster"));
  EXPECT_THAT(refused("-o 'd_{name}.tif'"), HasSubstr("give --tiles"));
  EXPECT_THAT(refused("-o 'd_{x}_{y}.tif' --tiles 50 --vrt in.las"), HasSubstr("ends in .vrt"));
}

TEST_F(DemTiles, OfPolygonsHaveTheirCoordinateSystemUnlessItIsForced) {
  write_layer("sheet", "a,\"POLYGON((500160 4100160,500210 4100150,500205 4100240))\"\n",
              "-a_srs EPSG:32633");
  const std::string arguments = "-o 'd_{name}.tif' --tiles sheet.gpkg --crs EPSG:32632";
  const Result refused = work_.run("spillway dem in.las --resolution 0.25 " + arguments);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--force-crs"));
  EXPECT_EQ(make(arguments + " --force-crs")["files"], 1);
}

/// A file that is written early has what the first run was told.
TEST_F(DemTiles, AreNotGoneOnWithByARunOfOtherOptions) {
  work_.succeed("spillway generate terrain -n 2000000 --seed 3 -q -o large.las; mkdir b");
  const std::string how =
      " large.las --resolution 0.5 --tiles 50 -q --resume folder "
      "--checkpoint-every 0 --tile-points 50000 -o ";
  std::istringstream words("dem" + how + "b/d_{x}_{y}.tif");
  const pid_t process = work_.start({std::istream_iterator<std::string>(words), {}});
  for (int i = 0; i < 2000 && work_.run("ls b/*.tif").exit_code != 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  kill(process, SIGKILL);
  (void)wait_for_exit(process);
  for (const std::string other : {"--nodata 0", "--compress none", "--cog"}) {
    const Result result = work_.run("spillway dem" + how + "'b/d_{x}_{y}.tif' " + other);
    EXPECT_NE(result.exit_code, 0) << other;
    EXPECT_THAT(result.err, HasSubstr("folder")) << other;
  }
}

TEST_F(DemTiles, OfPointsCountThoseInTheirOutlines) {
  work_.write(
      "two.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32633"}},"features":[
    {"type":"Feature","properties":{"n":1},"geometry":{"type":"Polygon","coordinates":[[[500000,4100000],[500500,4100000],[500500,4100400]]]}},
    {"type":"Feature","properties":{"n":2},"geometry":{"type":"Polygon","coordinates":[[[500000,4100000],[500500,4100400],[500000,4100400]]]}}]})");
  const auto stats = make("-o 't_{n}.tif' --tiles two.geojson --product count,max --fill-voids");
  const auto one = make("-o one.tif --product count,max --fill-voids");
  EXPECT_EQ(stats["files"], 2);
  for (const char* count : {"points_in_pixels", "pixels_with_points", "filled_pixels"}) {
    EXPECT_EQ(stats[count], one[count]) << count;
  }
}

}  // namespace
}  // namespace spillway::test
