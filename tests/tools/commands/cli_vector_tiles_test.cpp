// `--tiles` of triangulate, convert and contour: one mesh, or its lines or bands, as many files.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// Three polygons: the second one bounded by slanting edges that it shares with the others, the
/// third one with a hole. They do not reach to the southern edge of the terrain.
constexpr const char* kSheets = R"({"type":"FeatureCollection",
  "crs":{"type":"name","properties":{"name":"EPSG:32633"}},"features":[
  {"type":"Feature","properties":{"name":"west"},"geometry":{"type":"Polygon",
   "coordinates":[[[499000,4100090],[500090,4100090],[500130,4102000],[499000,4102000],[499000,4100090]]]}},
  {"type":"Feature","properties":{"name":"middle"},"geometry":{"type":"Polygon",
   "coordinates":[[[500130,4102000],[500090,4100090],[500160,4100090],[500140,4102000],[500130,4102000]]]}},
  {"type":"Feature","properties":{"name":"east"},"geometry":{"type":"Polygon",
   "coordinates":[[[500160,4100090],[502000,4100090],[502000,4102000],[500140,4102000],[500160,4100090]],
                  [[500170,4100130],[500180,4100130],[500180,4100140],[500170,4100140],[500170,4100130]]]}}]})";

struct Sums {
  std::map<double, double> by_height;  ///< lengths of lines, or areas of bands
  int shapes = 0;
};

class VectorTiles : public ::testing::Test {
 protected:
  VectorTiles() {
    work_.succeed("spillway generate terrain -n 40000 --seed 5 -q -o in.las");
    work_.write("sheets.geojson", kSheets);
  }

  nlohmann::json make(const std::string& arguments) {
    messages_ = work_.run("spillway " + arguments + " --stats stats.json");
    EXPECT_EQ(messages_.exit_code, 0) << messages_.err;
    return nlohmann::json::parse(work_.read("stats.json"));
  }

  /// Lengths or areas of what SQL calls so, by a field, in files of a name.
  Sums sums(const std::string& files, const std::string& measure, const std::string& field) {
    Sums sums;
    const Result list = work_.run("ls " + files);
    std::istringstream names(list.out);
    for (std::string name; std::getline(names, name);) {
      const std::string layer = name.substr(0, name.find('.'));
      const Result told = work_.run(
          fmt::format("ogr2ogr -f CSV /vsistdout/ {0} -dialect SQLite -sql \"SELECT {1} AS field, "
                      "{2}(geom) AS measure, ST_IsValid(geom) AS valid FROM '{3}'\"",
                      name, field, measure, layer));
      EXPECT_EQ(told.exit_code, 0) << told.err;
      std::istringstream lines(told.out);
      std::string line;
      std::getline(lines, line);
      EXPECT_EQ(line, "field,measure,valid");
      while (std::getline(lines, line)) {
        std::erase(line, '"');
        double height = 0;
        double value = 0;
        int valid = 0;
        EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%d", &height, &value, &valid), 3) << line;
        // What ogr2ogr makes is not always so.
        EXPECT_TRUE(valid == 1 || name.starts_with("clip_")) << name;
        sums.by_height[height] += value;
        ++sums.shapes;
      }
    }
    return sums;
  }

  /// As what ogr2ogr cuts the whole file to.
  void expect_same(const Sums& tiles, const Sums& clipped) {
    ASSERT_EQ(tiles.by_height.size(), clipped.by_height.size());
    for (const auto& [height, value] : clipped.by_height) {
      EXPECT_NEAR(tiles.by_height.at(height), value, 1e-6 * (1 + value)) << height;
    }
  }

  Workspace work_;
  Result messages_;
};

TEST_F(VectorTiles, OfPolygonsHaveTheLinesThatLieInThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  // Between the heights of points: ogr2ogr joins what runs along itself.
  const std::string how = "contour in.las --interval 3 --base 0.005 --force-crs ";
  const auto stats = make(how + "-o 'l_{name}.gpkg' --tiles sheets.geojson")["contours"];
  EXPECT_EQ(stats["files"], 3);
  EXPECT_GT(stats["outside_tiles"], 0);
  EXPECT_THAT(messages_.err, HasSubstr("lines are in none of the tiles"));
  work_.succeed("spillway " + how + "-q -o whole.gpkg");
  for (const char* name : {"west", "middle", "east"}) {
    work_.succeed(
        fmt::format("ogr2ogr clip_{0}.gpkg whole.gpkg -clipsrc sheets.geojson "
                    "-clipsrcwhere \"name='{0}'\" -nln clip_{0} -nlt LINESTRINGZ "
                    "-explodecollections",
                    name));
    expect_same(sums(fmt::format("l_{}.gpkg", name), "ST_Length", "elevation"),
                sums(fmt::format("clip_{}.gpkg", name), "ST_Length", "elevation"));
  }
}

TEST_F(VectorTiles, OfSquaresAndPolygonsHaveTheBandsThatLieInThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const std::string how = "contour in.las --interval 3 --bands --force-crs ";
  work_.succeed("spillway " + how + "-q -o whole.gpkg");
  const Sums whole = sums("whole.gpkg", "ST_Area", "\\\"min\\\"");
  EXPECT_GT(whole.shapes, 20);
  const auto stats = make(how + "-o 's_{x}_{y}.gpkg' --tiles 90")["contours"];
  const Sums squares = sums("s_*.gpkg", "ST_Area", "\\\"min\\\"");
  expect_same(squares, whole);
  EXPECT_GE(stats["files"], 6);
  EXPECT_EQ(stats["outside_tiles"], 0);
  EXPECT_EQ(stats["polygons"], squares.shapes);
  // Polygons that cover the terrain, the hole among them.
  std::string covering = kSheets;
  for (std::size_t at = 0; (at = covering.find("4100090")) != std::string::npos;) {
    covering.replace(at, 7, "4099000");
  }
  covering.resize(covering.size() - 2);
  work_.write("covering.geojson", covering + R"(,
    {"type":"Feature","properties":{"name":"hole"},"geometry":{"type":"Polygon","coordinates":
    [[[500170,4100130],[500180,4100130],[500180,4100140],[500170,4100140],[500170,4100130]]]}}]})");
  EXPECT_EQ(make(how + "-o 'p_{name}.gpkg' --tiles covering.geojson")["contours"]["files"], 4);
  expect_same(sums("p_*.gpkg", "ST_Area", "\\\"min\\\""), whole);
  double hole = 0;
  for (const auto& [height, area] : sums("p_hole.gpkg", "ST_Area", "\\\"min\\\"").by_height) {
    hole += area;
  }
  EXPECT_NEAR(hole, 100, 1e-6);
}

TEST_F(VectorTiles, OfPolygonsThatCrossThemselvesHaveBandsByTheEvenOddRule) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.write("bow.csv",
              "name,WKT\n"
              "bow,\"POLYGON ((500060 4100100,500160 4100200,500160 4100100,500060 4100200,500060 "
              "4100100))\"\n"
              "twice,\"MULTIPOLYGON (((500060 4100100,500120 4100100,500120 4100150,500060 "
              "4100150,500060 4100100)),((500100 4100120,500160 4100120,500160 4100200,500100 "
              "4100200,500100 4100120)))\"\n");
  make("contour in.las --interval 3 --bands -o 'b_{name}.gpkg' --tiles bow.csv");
  for (const auto& [name, area] : {std::pair("bow", 5000.0), std::pair("twice", 6600.0)}) {
    double sum = 0;
    const Sums bands = sums(fmt::format("b_{}.gpkg", name), "ST_Area", "\\\"min\\\"");
    for (const auto& [height, part] : bands.by_height) sum += part;
    EXPECT_NEAR(sum, area, 1e-6) << name;
  }
}

TEST_F(VectorTiles, OfAMeshAreMadeOfPointsOrOfTheMesh) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto stats =
      make("triangulate in.las --force-crs -o 'a_{name}.spm' --tiles sheets.geojson");
  EXPECT_EQ(stats["output_files"], 3);
  EXPECT_GT(stats["outside_tiles"], 0);
  EXPECT_THAT(messages_.err, HasSubstr("triangles are in none of the tiles, and in no file"));
  EXPECT_THAT(messages_.err, HasSubstr("3 tiles with triangles"));
  work_.succeed("spillway triangulate in.las -q -o whole.spm");
  work_.succeed("spillway convert whole.spm --force-crs -o 'b_{name}.spm' --tiles sheets.geojson");
  const auto hash_of = [&](const std::string& name) {
    const Result told = work_.run("spillway info --json " + name);
    return nlohmann::json::parse(told.out)["canonical_hash"];
  };
  for (const char* name : {"west", "middle", "east"}) {
    EXPECT_EQ(hash_of(fmt::format("a_{}.spm", name)), hash_of(fmt::format("b_{}.spm", name)));
  }
  EXPECT_NE(hash_of("a_west.spm"), hash_of("a_east.spm"));
}

TEST_F(VectorTiles, OfAMeshComeOutTheSameWhenARunGoesOn) {
  const std::string how = "spillway triangulate in.las -q --tiles 100 -o ";
  work_.succeed("mkdir a b");
  work_.succeed(how + "'a/{x}_{y}.spm'");
  work_.succeed(how + "'b/{x}_{y}.spm' --resume run");
  work_.succeed(
      "for f in a/*; do test \"$(spillway info $f | grep hash)\" = "
      "\"$(spillway info b/${f#a/} | grep hash)\" || exit 1; done");
  work_.succeed("test \"$(ls a)\" = \"$(ls b)\" && ! test -e run");
}

TEST_F(VectorTiles, AreRefusedWhereTheyCannotBe) {
  const auto refused = [this](const std::string& arguments) {
    const Result result = work_.run("spillway " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    return result.err;
  };
  EXPECT_THAT(refused("triangulate in.las -o a.ply --tiles 5"), HasSubstr("tile_{x}_{y}.ply"));
  EXPECT_THAT(refused("triangulate in.las -o 'a_{x}.ply'"), HasSubstr("give --tiles"));
  EXPECT_THAT(refused("triangulate in.las -o - --tiles 5"), HasSubstr("{x}"));
  EXPECT_THAT(refused("triangulate in.las -o '{x}_{y}.ply' --tiles 0"), HasSubstr("above 0"));
  EXPECT_THAT(refused("triangulate in.las -o '{x}_{y}.ply' --tiles 5 --parts"),
              HasSubstr("one process"));
  EXPECT_THAT(refused("triangulate in.las -o 'no/{x}_{y}.ply' --tiles 5"),
              HasSubstr("create the folder no first"));
  EXPECT_THAT(refused("convert in.las -o '{x}_{y}.las' --tiles 5"), HasSubstr("points"));
  if (build_lacks("GDAL")) return;
  EXPECT_THAT(refused("contour in.las --interval 3 -o 'l_{no}.gpkg' --tiles sheets.geojson"),
              HasSubstr("its polygons have no field \"no\""));
  EXPECT_THAT(refused("triangulate in.las -o 'l_{name}.ply' --tiles missing.gpkg"),
              HasSubstr("missing.gpkg"));
  work_.write("own.csv", "name,WKT\nown,\"POLYGON ((0 0,1 0,1 1,0 0))\"\n");
  EXPECT_THAT(refused("triangulate in.las -o '{name}.csv' --output-format obj --tiles own.csv"),
              HasSubstr("which is that of polygons"));
  work_.write("pipe.csv", "name,WKT\n-,\"POLYGON ((0 0,1 0,1 1,0 0))\"\n");
  EXPECT_THAT(refused("triangulate in.las -o '{name}' --output-format obj --tiles pipe.csv"),
              HasSubstr("standard output"));
  work_.succeed("spillway convert in.las -o zone34.las --crs EPSG:32634 --force-crs");
  EXPECT_THAT(refused("triangulate zone34.las -o 'l_{name}.ply' --tiles sheets.geojson"),
              HasSubstr("sheets.geojson"));
}

}  // namespace
}  // namespace spillway::test
