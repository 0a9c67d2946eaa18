// `--clip`, `--z-range`, `--to-crs` and `--multiply-z`: which points are used, and where they lie.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using Row = std::array<double, 3>;

/// x, y and z of lines that begin so, whatever separates them; others are left out.
std::vector<Row> rows_of(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (char& c : line) {
      if (c == ',') c = ' ';
    }
    Row row{};
    std::istringstream numbers(line);
    if (numbers >> row[0] >> row[1] >> row[2]) rows.push_back(row);
  }
  return rows;
}

class PointsOnAMap : public ::testing::Test {
 protected:
  PointsOnAMap() {
    work_.succeed("spillway generate terrain -n 100000 --seed 6 -q -o plain.las");
    work_.succeed("spillway convert plain.las --crs EPSG:32633 -q -o in.las");
    work_.succeed("spillway convert in.las --attributes none -q -o in.csv");
    work_.succeed("(echo x,y,z; cat in.csv) > named.csv");
    // No point, with its two decimals, lies on an edge.
    work_.write("area.csv",
                "n,WKT\n1,\"POLYGON ((500060.0037 4100080.0053,500190.0037 "
                "4100100.0053,500120.0037 4100190.0053,500060.0037 4100080.0053),"
                "(500110.0037 4100110.0053,500130.0037 4100110.0053,500120.0037 "
                "4100130.0053,500110.0037 4100110.0053))\"\n"
                "2,\"POLYGON ((500200.0037 4100090.0053,500260.0037 4100090.0053,500260.0037 "
                "4100150.0053,500200.0037 4100150.0053,500200.0037 4100090.0053))\"\n");
    work_.write(
        "road.csv",
        "n,WKT\n1,\"LINESTRING (500050 4100070,500150.0037 4100120,500150.0037 4100250)\"\n");
  }

  /// The points that a run keeps, and its messages.
  std::vector<Row> kept(const std::string& options, const std::string& input = "in.las") {
    const Result result =
        work_.run("spillway convert " + input + " --attributes none -o kept.csv " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    messages_ = result.err;
    return rows_of(work_.read("kept.csv"));
  }

  std::vector<Row> of_ogr2ogr(const std::string& options) {
    work_.succeed(
        "rm -f ogr.csv; ogr2ogr -q -f CSV ogr.csv named.csv -oo X_POSSIBLE_NAMES=x "
        "-oo Y_POSSIBLE_NAMES=y -oo AUTODETECT_TYPE=YES " +
        options);
    return rows_of(work_.read("ogr.csv"));
  }

  [[nodiscard]] std::string refused(const std::string& arguments) {
    const Result result = work_.run("spillway " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    return result.err;
  }

  Workspace work_;
  std::string messages_;
};

TEST_F(PointsOnAMap, AreClippedAsOgr2ogrClipsThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const std::vector<Row> all = rows_of(work_.read("in.csv"));
  const std::vector<Row> inside = kept("--clip area.csv");
  EXPECT_EQ(inside, of_ogr2ogr("-clipsrc area.csv"));
  EXPECT_GT(inside.size(), 1000U);
  EXPECT_THAT(messages_, HasSubstr(fmt::format("{} clipped, {} kept", all.size() - inside.size(),
                                               inside.size())));
  const std::vector<Row> outside = kept("--clip area.csv --clip-outside");
  std::multiset<Row> together(inside.begin(), inside.end());
  together.insert(outside.begin(), outside.end());
  EXPECT_EQ(together, std::multiset<Row>(all.begin(), all.end()));
}

TEST_F(PointsOnAMap, AreClippedByBuffersOfLinesAndPolygons) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto buffer = [](const std::string& file, double distance) {
    return fmt::format(
        "-dialect SQLite -sql \"SELECT ST_Union(ST_Buffer(geometry, {}, 30)) FROM {}\"", distance,
        file);
  };
  for (const auto& [file, distance] : {std::pair("road", 7.5), std::pair("area", -5.0)}) {
    work_.succeed(fmt::format("rm -f buffer.gpkg; ogr2ogr -q buffer.gpkg {}.csv {}", file,
                              buffer(file, distance)));
    const auto near = kept(fmt::format("--clip {}.csv --clip-buffer {}", file, distance));
    EXPECT_GT(near.size(), 500U);
    EXPECT_EQ(near, of_ogr2ogr("-clipsrc buffer.gpkg")) << file;
  }
  EXPECT_THAT(refused("convert in.las -o x.csv --clip road.csv"), HasSubstr("no polygon"));
  EXPECT_THAT(refused("convert in.las -o x.csv --clip area.csv --clip-buffer -500"),
              HasSubstr("nothing of it is left"));
  EXPECT_THAT(refused("convert in.las -o x.csv --clip-buffer 3"), HasSubstr("without --clip"));
  EXPECT_THAT(refused("convert in.las -o x.csv --clip missing.gpkg"), HasSubstr("missing.gpkg"));
}

/// What is read is left out, whatever becomes of the points, and in little memory.
TEST_F(PointsOnAMap, ThatAreClippedMakeTheSameMeshAsThoseOfAFile) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed("spillway convert in.las -q -o clipped.las --clip area.csv --z-range 415,422");
  const auto hash = [&](const std::string& arguments) {
    work_.succeed("spillway triangulate -q -o mesh.spm --stats stats.json " + arguments);
    return nlohmann::json::parse(work_.read("stats.json"))["canonical_hash"];
  };
  const auto expected = hash("clipped.las");
  EXPECT_EQ(hash("in.las --clip area.csv --z-range 415,422"), expected);
  EXPECT_EQ(hash("in.las --clip area.csv --z-range 415,422 --tile-points 500 --memory 64M"),
            expected);
  work_.succeed("spillway convert in.las --sorted --cell-points 1000 -q -o in.spp");
  EXPECT_EQ(hash("in.spp --clip area.csv --z-range 415,422"), expected);
}

TEST_F(PointsOnAMap, AreChosenByTheirHeights) {
  for (const Row& row : kept("--z-range 415,420.5")) {
    EXPECT_TRUE(row[2] >= 415 && row[2] <= 420.5) << row[2];
  }
  const std::size_t both = kept("--z-range 415,430 --bounds 0,0,380,1e7,1e7,420").size();
  EXPECT_GT(both, 1000U);
  EXPECT_EQ(both, kept("--z-range 415,420").size());
  EXPECT_THAT(refused("convert in.las -o x.csv --z-range 390"), HasSubstr("no range of heights"));
  EXPECT_THAT(refused("convert in.las -o x.csv --z-range 9,1"), HasSubstr("no range of heights"));
  EXPECT_THAT(refused("convert in.las -o x.csv --z-range 1,2 --bounds 0,0,8,1,1,9"),
              HasSubstr("no height in common"));
  work_.write("flat.csv", "x,y\n1,2\n3,4\n5,1\n");
  EXPECT_THAT(refused("convert flat.csv -o x.csv --z-range 1,2"), HasSubstr("no z"));
  EXPECT_THAT(refused("convert flat.csv -o x.csv --multiply-z 2"), HasSubstr("no z"));
}

TEST_F(PointsOnAMap, AreTransformedAsGdaltransformDoes) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed("tr , ' ' < in.csv > in.txt");
  for (const char* to : {"EPSG:25832", "EPSG:4326", "EPSG:3857"}) {
    const Result told =
        work_.run(fmt::format("gdaltransform -s_srs EPSG:32633 -t_srs {} < in.txt", to));
    const std::vector<Row> expected = rows_of(told.out);
    const std::vector<Row> found = kept(fmt::format("--to-crs {}", to));
    ASSERT_EQ(found.size(), expected.size()) << to;
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(found[i][k], expected[i][k], 1e-13 * (1 + std::abs(expected[i][k])));
      }
    }
  }
}

TEST_F(PointsOnAMap, ThatAreTransformedTellTheirNewSystem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto crs_of = [&](const std::string& name) {
    const Result told = work_.run("spillway info --json " + name);
    return nlohmann::json::parse(told.out)["crs"].get<std::string>();
  };
  for (const std::string name : {"x.las", "x.laz", "x.spp", "x.spm"}) {
    const char* const what = name == "x.spm" ? "triangulate" : "convert";
    work_.succeed(fmt::format("spillway {} in.las -q --to-crs EPSG:25832 -o {}", what, name));
    EXPECT_THAT(crs_of(name), HasSubstr("25832")) << name;
  }
  // Systems that are the same leave all as it is.
  work_.succeed("spillway convert in.las -q --to-crs EPSG:32633 -o same.las");
  EXPECT_THAT(crs_of("same.las"), HasSubstr("32633"));
  EXPECT_EQ(kept("", "same.las"), kept(""));
}

TEST_F(PointsOnAMap, OfDifferentSystemsComeTogether) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed(
      "spillway convert in.las -q --to-crs EPSG:4326 --scale 1e-9,1e-9,0.01 -o degrees.las");
  EXPECT_THAT(refused("convert in.las degrees.las -o x.csv"), HasSubstr("coordinate system"));
  const std::vector<Row> both = kept("--to-crs EPSG:25832", "in.las degrees.las");
  ASSERT_EQ(both.size() % 2, 0U);
  const std::size_t half = both.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    ASSERT_NEAR(both[i][0], both[half + i][0], 1e-3);
    ASSERT_NEAR(both[i][1], both[half + i][1], 1e-3);
  }
}

TEST_F(PointsOnAMap, AreFilteredWhereTheyAreBroughtTo) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const std::vector<Row> all = kept("--to-crs EPSG:25832");
  const Row& middle = all[all.size() / 2];
  const std::string box =
      fmt::format("{},{},{},{}", middle[0] - 40, middle[1] - 30, middle[0] + 40, middle[1] + 30);
  std::vector<Row> expected;
  for (const Row& row : all) {
    if (std::abs(row[0] - middle[0]) <= 40 && std::abs(row[1] - middle[1]) <= 30) {
      expected.push_back(row);
    }
  }
  EXPECT_EQ(kept("--to-crs EPSG:25832 --bounds " + box), expected);
  EXPECT_THAT(refused("convert in.las -o x.csv --to-crs EPSG:25832 --clip p.geojson"),
              HasSubstr("p.geojson"));
}

TEST_F(PointsOnAMap, WithoutAPlaceInTheOtherSystemAreAnErrorOrCounted) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.write("pole.csv", "x,y,z\n10,50,1\n11,51,2\n11,95,3\n12,50,4\n");
  const std::string how = " pole.csv --crs EPSG:4326 --to-crs EPSG:25832 ";
  EXPECT_THAT(refused("convert" + how + "-o x.csv"),
              HasSubstr("pole.csv: point 2 at (11, 95, 3) has no place"));
  EXPECT_EQ(kept("--crs EPSG:4326 --to-crs EPSG:25832 --skip-invalid", "pole.csv").size(), 3U);
  EXPECT_THAT(messages_, HasSubstr("1 invalid"));
  EXPECT_THAT(refused("convert plain.las -o x.csv --to-crs EPSG:3857"),
              HasSubstr("plain.las names no coordinate system to transform it from; name it with "
                        "--crs"));
  EXPECT_THAT(refused("convert in.las -o x.csv --to-crs EPSG:999999"), HasSubstr("EPSG:999999"));
  EXPECT_THAT(refused("convert in.las -o x.csv --to-crs nonsense"), HasSubstr("--to-crs"));
}

TEST_F(PointsOnAMap, HaveTheirHeightsMultiplied) {
  const std::vector<Row> before = kept("");
  const std::vector<Row> after = kept("--multiply-z 0.3048");
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i][0], before[i][0]);
    ASSERT_NEAR(after[i][2], before[i][2] * 0.3048, 1e-12 * before[i][2]);
  }
  EXPECT_THAT(refused("convert in.las -o x.csv --multiply-z 0"), HasSubstr("--multiply-z"));
}

TEST_F(PointsOnAMap, InDegreesOrWithHeightsInAnotherUnitAreSpokenOf) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto said_of = [&](const std::string& crs) {
    const Result result = work_.run("spillway triangulate plain.las -o x.spm --crs " + crs);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(said_of("EPSG:32633"), Not(HasSubstr("points are in")));
  EXPECT_THAT(said_of("EPSG:32633+6360"),
              HasSubstr("heights times 0.30480061 are in those of x and y"));
  work_.succeed("spillway convert in.las -q --to-crs EPSG:4326 -o degrees.las");
  EXPECT_THAT(work_.run("spillway triangulate degrees.las -o x.spm").err,
              HasSubstr("x and y are degrees, which are no lengths"));
  EXPECT_THAT(work_.run("spillway triangulate degrees.las --to-crs EPSG:32633 -o x.spm").err,
              Not(HasSubstr("degrees")));
}

std::string hash_of(const Workspace& work, const std::string& mesh) {
  return nlohmann::json::parse(work.succeed("spillway info -q --json " + mesh))["canonical_hash"];
}

/// What one polygon cuts out is the tile of that polygon.
TEST_F(PointsOnAMap, MeshesAreClippedToWholeSimplicesByTheirCentroids) {
  work_.succeed("spillway triangulate -q in.las -o whole.spm");
  work_.succeed("spillway convert -q whole.spm -o 'tile_{n}.spm' --tiles area.csv --force-crs");
  work_.succeed("head -2 area.csv > one.csv");
  work_.succeed("spillway convert -q whole.spm -o clipped.spm --clip one.csv --force-crs");
  EXPECT_EQ(hash_of(work_, "clipped.spm"), hash_of(work_, "tile_1.spm"));
  const auto simplices = [&](const std::string& arguments) {
    work_.succeed("spillway convert whole.spm -o part.spm --stats s.json --force-crs " + arguments +
                  " 2> said.txt");
    EXPECT_THAT(work_.read("said.txt"), HasSubstr("triangles clipped, and "));
    const auto stats = nlohmann::json::parse(work_.read("s.json"));
    const auto info = nlohmann::json::parse(work_.succeed("spillway info -q --json part.spm"));
    for (const char* key : {"vertices", "simplices", "hull_facets", "canonical_hash"}) {
      EXPECT_EQ(stats[key], info[key]) << key;
    }
    return stats["outside_tiles"].get<std::uint64_t>();
  };
  const std::uint64_t outside = simplices("--clip area.csv");
  const std::uint64_t inside = simplices("--clip area.csv --clip-outside");
  EXPECT_EQ(outside + inside,
            nlohmann::json::parse(work_.succeed("spillway info -q --json whole.spm"))["simplices"]);
  EXPECT_LT(simplices("--clip area.csv --clip-buffer 5"), outside);
  work_.succeed(
      "spillway triangulate -q in.las -o direct.spm --clip one.csv --clip-simplices --force-crs");
  EXPECT_EQ(hash_of(work_, "direct.spm"), hash_of(work_, "clipped.spm"));
  work_.succeed("spillway convert -q whole.spm -o - --clip one.csv --force-crs > piped.spm");
  EXPECT_EQ(hash_of(work_, "piped.spm"), hash_of(work_, "clipped.spm"));
  work_.succeed(
      "spillway convert -q whole.spm -o small.spm --clip one.csv --force-crs --memory 32M");
  EXPECT_EQ(work_.read("small.spm"), work_.read("clipped.spm"));
}

TEST_F(PointsOnAMap, AClippedMeshOfNothingAndWrongClipsAreErrors) {
  work_.succeed("spillway triangulate -q in.las -o whole.spm");
  work_.write("far.csv", "n,WKT\n1,\"POLYGON ((0 0,1 0,1 1,0 0))\"\n");
  const auto error_of = [&](const std::string& arguments, int code) {
    const Result result = work_.run("spillway " + arguments);
    EXPECT_EQ(result.exit_code, code) << arguments;
    EXPECT_FALSE(work_.has("o.spm") || work_.has("o.tif")) << arguments;
    return result.err;
  };
  EXPECT_THAT(error_of("convert whole.spm -o o.spm --clip far.csv --force-crs", 1),
              HasSubstr("none of the triangles lies where far.csv says"));
  EXPECT_THAT(error_of("convert whole.spm -o o.spm --clip area.csv --tiles 100 --force-crs", 2),
              HasSubstr("not both"));
  EXPECT_THAT(error_of("convert whole.spm -o o.spm --clip-outside", 2),
              HasSubstr("no effect without --clip"));
  EXPECT_THAT(error_of("triangulate in.las -o o.spm --clip-simplices", 2),
              HasSubstr("no effect without --clip"));
  EXPECT_THAT(error_of("dem in.las -o o.tif --resolution 5 --clip-pixels", 2),
              HasSubstr("no effect without --clip"));
  EXPECT_THAT(error_of("convert whole.spm -o o.spm --clip none.csv", 1), HasSubstr("none.csv"));
  if (build_lacks("GDAL")) return;
  EXPECT_THAT(work_
                  .run("spillway dem in.las -o far.tif --resolution 5 --clip far.csv --clip-pixels "
                       "--force-crs")
                  .err,
              HasSubstr("none with its centre in a triangle lies where far.csv says"));
}

TEST_F(PointsOnAMap, RastersAreClippedByPixelsAsByGdalwarp) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const std::string dem =
      "spillway dem -q in.las --resolution 2 --compress none --bounds "
      "500000,4100000,500300,4100300 --force-crs";
  work_.succeed(dem + " -o whole.tif");
  work_.succeed(dem + " -o clipped.tif --clip area.csv --clip-pixels");
  work_.succeed("ogr2ogr -q -a_srs EPSG:32633 area.gpkg area.csv");
  work_.succeed("gdalwarp -q -cutline area.gpkg -dstnodata -9999 whole.tif warped.tif");
  const auto pixels = [&](const std::string& name) {
    return work_.succeed("gdal_translate -q -of XYZ " + name + " /vsistdout/");
  };
  EXPECT_EQ(pixels("clipped.tif"), pixels("warped.tif"));
  EXPECT_NE(pixels("clipped.tif"), pixels("whole.tif"));
  work_.succeed(dem + " -o outside.tif --clip area.csv --clip-pixels --clip-outside");
  const std::vector<Row> whole = rows_of(pixels("whole.tif"));
  const std::vector<Row> inside = rows_of(pixels("clipped.tif"));
  const std::vector<Row> outside = rows_of(pixels("outside.tif"));
  ASSERT_EQ(whole.size(), inside.size());
  ASSERT_EQ(whole.size(), outside.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(std::max(inside[i][2], outside[i][2]), whole[i][2]);
    EXPECT_TRUE(whole[i][2] == -9999 || (inside[i][2] == -9999) != (outside[i][2] == -9999));
  }
  // Of a batch, the mesh is that of all points.
  work_.succeed("spillway triangulate -q in.las -o whole.spm");
  work_.succeed(
      "spillway batch -q in.las --to spm,dem.tif --resolution 2 --bounds "
      "500000,4100000,500300,4100300 --compress none --clip area.csv --clip-pixels --force-crs "
      "--output-dir jobs");
  EXPECT_EQ(hash_of(work_, "jobs/in.spm"), hash_of(work_, "whole.spm"));
  EXPECT_EQ(pixels("jobs/in.dem.tif"), pixels("clipped.tif"));
  work_.succeed(
      "spillway dem -q whole.spm --resolution 2 --compress none --bounds "
      "500000,4100000,500300,4100300 --clip area.csv --clip-pixels --force-crs -o mesh.tif");
  EXPECT_EQ(pixels("mesh.tif"), pixels("clipped.tif"));
  work_.succeed(
      "spillway dem -q in.las --resolution 2 --force-crs --bounds 500000,4100000,500300,4100300 "
      "--clip area.csv --clip-pixels --tiles 100 -o 't_{x}_{y}.tif'");
  work_.succeed("gdalbuildvrt -q all.vrt -te 500000 4100000 500300 4100300 t_*.tif");
  EXPECT_EQ(pixels("all.vrt"), pixels("clipped.tif"));
}

}  // namespace
}  // namespace spillway::test
