// Rasters as points.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kGrid =
    "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n"
    "1 2 -9999\n4.5 5 6\n";

std::string points_of(const Workspace& work, const std::string& file) {
  return work.succeed("spillway convert -q " + file + " -o - --output-format text | sort -g");
}

TEST(RasterPoints, AreTheCentresOfPixelsWithData) {
  const Workspace work;
  for (const char* name : {"a.asc", "a.txt", "a"}) {
    work.write(name, kGrid);
    EXPECT_EQ(points_of(work, name), "105 205 4.5\n105 215 1\n115 205 5\n115 215 2\n125 205 6\n")
        << name;
  }
  Json info = Json::parse(work.succeed("spillway info -q --json a.asc"));
  EXPECT_EQ(info["format"], Json("raster"));
  EXPECT_EQ(info["version"], Json("AAIGrid"));
  EXPECT_EQ(info["points"], Json(5));
  EXPECT_THAT(work.run("spillway triangulate -v a.asc -o a.ply").err,
              HasSubstr("6 points read, 1 invalid, 5 kept"));
  work.succeed("spillway check -q a.ply --points a.asc");
}

/// A raster of a mesh, and its pixels as points, as GDAL lists them.
TEST(RasterPoints, OfAGeoTiffAreWhatGdalLists) {
  const Workspace work;
  work.succeed("spillway generate terrain -q -n 20000 --seed 3 -o t.las");
  for (const char* layout : {"", " -co TILED=NO -co BLOCKYSIZE=1"}) {
    work.succeed("spillway dem -q t.las -o t.tif --resolution 7 --crs EPSG:25832");
    work.succeed(std::string("gdal_translate -q") + layout + " t.tif u.tif");
    work.succeed("gdal_translate -q -of XYZ -co DECIMAL_PRECISION=9 u.tif u.txt");
    work.succeed("grep -v -- '-9999' u.txt > v.txt");
    work.succeed("spillway triangulate -q u.tif -o a.spm");
    work.succeed("spillway triangulate -q v.txt -o b.spm");
    const auto of = [&](const char* name, const char* key) {
      return Json::parse(work.succeed(fmt::format("spillway info -q --json {}", name)))[key];
    };
    EXPECT_EQ(of("a.spm", "vertices"), of("b.spm", "vertices"));
    EXPECT_EQ(of("a.spm", "extent")["min"][0], of("b.spm", "extent")["min"][0]);
    EXPECT_THAT(of("a.spm", "crs").get<std::string>(), HasSubstr("25832"));
    work.succeed("spillway check -q a.spm --points u.tif");
  }
}

TEST(RasterPoints, OtherBandsAreAttributes) {
  const Workspace work;
  work.write("a.asc", kGrid);
  work.write("b.asc",
             "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n7 8 9\n10 11 12\n");
  work.succeed("gdalbuildvrt -q -separate both.vrt a.asc b.asc");
  EXPECT_EQ(work.succeed("spillway convert -q both.vrt -o - --output-format text "
                         "--attributes all | tail -n +2 | sort -g"),
            "105 205 4.5 10\n105 215 1 7\n115 205 5 11\n115 215 2 8\n125 205 6 12\n");
}

TEST(RasterPoints, WhatIsNoRasterOfHeightsIsAnError) {
  const Workspace work;
  const auto error_of = [&](const std::string& arguments) {
    const Result result = work.run("spillway triangulate -q -o o.ply " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_FALSE(work.has("o.ply"));
    return result.err;
  };
  work.write("a.asc", kGrid);
  EXPECT_THAT(error_of("- < a.asc"), HasSubstr("is read from a file, not from a pipe"));
  work.write("cut.asc", kGrid.substr(0, kGrid.size() - 6));
  EXPECT_THAT(error_of("cut.asc"), AllOf(HasSubstr("cut.asc"), HasSubstr("complete copy")));
  work.succeed("gdal_translate -q -ot Byte -colorinterp red a.asc red.tif");
  EXPECT_THAT(error_of("red.tif"), HasSubstr("a picture, without heights"));
  work.succeed("gdal_translate -q -a_ullr 0 0 0 0 a.asc nowhere.tif || true");
  work.write("none.txt", "not a raster\n");
  EXPECT_THAT(error_of("none.txt --input-format raster"),
              HasSubstr("none.txt: this cannot be read as a raster"));
  work.succeed("gdal_translate -q a.asc a.tif && head -c 100 a.tif > cut.tif");
  EXPECT_THAT(error_of("cut.tif"), HasSubstr("cut.tif"));
}

TEST(RasterPoints, InBlocksThatTakeTooMuchMemoryAreRefused) {
  const Workspace work;
  work.succeed(
      "gdal_create -q -outsize 9000 9000 -ot Float32 -a_ullr 0 9000 9000 0 -co SPARSE_OK=TRUE "
      "-co TILED=YES -co BLOCKXSIZE=9008 -co BLOCKYSIZE=9008 big.tif");
  EXPECT_THAT(work.run("spillway info big.tif").err,
              AllOf(HasSubstr("blocks of 9008 x 9008 pixels"), HasSubstr("TILED=YES")));
}

TEST(RasterPoints, OfAFolderAreNotTaken) {
  const Workspace work;
  work.succeed("mkdir in && spillway generate uniform -q -n 100 -o in/a.npy");
  work.write("in/a.tif", "no raster at all");
  work.succeed("spillway triangulate -q in -o o.ply");
}

}  // namespace
}  // namespace spillway::test
