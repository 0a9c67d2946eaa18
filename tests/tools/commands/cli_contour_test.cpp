#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A cone of 41 x 41 points, 20 high in the middle.
std::string cone() {
  std::string text;
  for (int y = 0; y <= 40; ++y) {
    for (int x = 0; x <= 40; ++x) {
      text += std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(20 - std::hypot(x - 20, y - 20)) + "\n";
    }
  }
  return text;
}

nlohmann::json features(const Workspace& space, const std::string& name) {
  return nlohmann::json::parse(space.read(name))["features"];
}

class Contour : public ::testing::Test {
 protected:
  Contour() { space.write("cone.txt", cone()); }
  Workspace space;
};

TEST_F(Contour, DrawsClosedRingsWithTheirElevation) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed("spillway contour cone.txt -o c.geojson --force-crs --interval 5 --base 2.5");
  int rings = 0;
  for (const nlohmann::json& line : features(space, "c.geojson")) {
    const auto& points = line["geometry"]["coordinates"];
    const double height = line["properties"]["elevation"];
    EXPECT_EQ(points[0][2], height);
    if (height < 0) continue;
    ++rings;
    EXPECT_EQ(points.front(), points.back()) << height;
    EXPECT_NEAR(std::hypot(points[0][0].get<double>() - 20, points[0][1].get<double>() - 20),
                20 - height, 0.3);
  }
  EXPECT_EQ(rings, 4);  // at 2.5, 7.5, 12.5 and 17.5
}

TEST_F(Contour, CutsLinesIntoTilesThatHaveAllOfThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto length_of = [](const nlohmann::json& line) {
    const auto& points = line["geometry"]["coordinates"];
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      length += std::hypot(points[i][0].get<double>() - points[i - 1][0].get<double>(),
                           points[i][1].get<double>() - points[i - 1][1].get<double>());
    }
    return length;
  };
  const std::string how = " --force-crs --interval 1 --stats stats.json -o ";
  std::map<double, double> whole;
  space.succeed("spillway contour cone.txt" + how + "one.geojson");
  for (const auto& line : features(space, "one.geojson")) {
    whole[line["properties"]["elevation"]] += length_of(line);
  }
  space.write("c_5_7.geojson", "");
  const Result result =
      space.run("spillway contour cone.txt --tiles 15" + how + "'c_{x}_{y}.geojson'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning: c_5_7.geojson are called like tiles"));
  EXPECT_EQ(nlohmann::json::parse(space.read("stats.json"))["contours"]["files"], 9);
  std::map<double, double> tiles;
  for (const int x : {0, 15, 30}) {
    for (const int y : {0, 15, 30}) {
      for (const auto& line : features(space, fmt::format("c_{}_{}.geojson", x, y))) {
        tiles[line["properties"]["elevation"]] += length_of(line);
        for (const auto& point : line["geometry"]["coordinates"]) {
          EXPECT_TRUE(point[0] >= x && point[0] <= x + 15 && point[1] >= y && point[1] <= y + 15);
          EXPECT_EQ(point[2], line["properties"]["elevation"]);
        }
      }
    }
  }
  ASSERT_EQ(tiles.size(), whole.size());
  for (const auto& [height, length] : whole) EXPECT_NEAR(tiles[height], length, 1e-4) << height;
  space.succeed("mkdir a b");
  space.succeed("spillway contour cone.txt --tiles 15 --threads 1 -q" + how + "'a/{x}_{y}.gpkg'");
  space.succeed("spillway contour cone.txt --tiles 15 --tile-points 100 -q" + how +
                "'b/{x}_{y}.gpkg'");
  space.succeed("test \"$(ls a)\" = \"$(ls b)\"");
  const auto refused = [this](const std::string& arguments) {
    return space.run("spillway contour cone.txt --interval 1 " + arguments).err;
  };
  EXPECT_THAT(refused("-o a.gpkg --tiles 5"), HasSubstr("tile_{x}_{y}.gpkg"));
  EXPECT_THAT(refused("-o 'a_{x}_{y}.gpkg'"), HasSubstr("give --tiles"));
  for (const char* side : {"1e-300", "1e-9"}) {
    EXPECT_THAT(refused(fmt::format("-o 'a_{{x}}_{{y}}.gpkg' --tiles {}", side)),
                HasSubstr("choose a larger side"));
  }
}

TEST_F(Contour, DrawsTheSameOfPointsMeshesAndStreams) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed(
      "spillway triangulate cone.txt -o cone.ply && spillway triangulate cone.txt -o cone.spm "
      "--tile-points 100");
  space.succeed("spillway contour cone.txt -o points.geojson --force-crs --levels 3,9.5");
  space.succeed("spillway contour cone.ply -o mesh.geojson --force-crs --levels 3,9.5");
  space.succeed("spillway contour cone.spm -o stream.geojson --force-crs --levels 3,9.5");
  space.succeed("spillway contour - -o pipe.geojson --force-crs --levels 3,9.5 < cone.spm");
  const auto lines = [&](const std::string& name) {
    std::multiset<std::string> set;
    for (const nlohmann::json& line : features(space, name)) set.insert(line["geometry"].dump());
    return set;
  };
  EXPECT_EQ(lines("points.geojson").size(), 2U);
  EXPECT_EQ(lines("mesh.geojson"), lines("points.geojson"));
  EXPECT_EQ(lines("stream.geojson"), lines("points.geojson"));
  EXPECT_EQ(lines("pipe.geojson"), lines("points.geojson"));
}

/// Whole heights from -2 to 2 on a grid of 40 x 40 points, in an order given by a seed. Lines at
/// whole heights meet themselves and others all over.
std::string whole_heights(unsigned seed) {
  std::mt19937 heights(11);
  std::vector<std::string> lines;
  for (int i = 0; i < 1600; ++i) {
    lines.push_back(std::to_string(i % 40) + " " + std::to_string(i / 40) + " " +
                    std::to_string(static_cast<int>(heights() % 5) - 2) + "\n");
  }
  std::shuffle(lines.begin(), lines.end(), std::mt19937(seed));
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

TEST_F(Contour, ThatMeetThemselvesDependOnNoTilesThreadsAndOrders) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto lines = [&](const std::string& input, const std::string& options) {
    space.succeed("spillway contour -q " + input + " -o c.geojson --force-crs --interval 1 " +
                  options);
    std::multiset<std::string> set;
    for (const nlohmann::json& line : features(space, "c.geojson")) set.insert(line.dump());
    return set;
  };
  space.write("in.txt", whole_heights(0));
  const auto expected = lines("in.txt", "--threads 1");
  EXPECT_GT(expected.size(), 300U);
  unsigned seed = 1;
  for (const std::string options :
       {"--threads 2", "--tile-points 500", "--tile-points 100", "--leaf-points 9 --threads 4",
        "--tile-points 200 --leaf-points 25 --children 3",
        "--division cycling --tile-points 300"}) {
    space.write("in.txt", whole_heights(seed++));
    EXPECT_EQ(lines("in.txt", options), expected) << options;
    space.succeed("spillway triangulate -q in.txt -o in.spm " + options +
                  " && spillway triangulate -q in.txt -o in.obj " + options);
    EXPECT_EQ(lines("in.spm", ""), expected) << options;
    EXPECT_EQ(lines("in.obj", ""), expected) << options;
  }
}

TEST_F(Contour, EverySoManyFromTheBaseAreIndexContours) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const auto index = [&](const std::string& options) {
    space.succeed("spillway contour cone.txt -o c.geojson --force-crs " + options);
    std::set<double> heights;
    for (const nlohmann::json& line : features(space, "c.geojson")) {
      if (line["properties"]["index"] == 1)
        heights.insert(line["properties"]["elevation"].get<double>());
    }
    return heights;
  };
  EXPECT_EQ(index("--interval 1 --base 2.5"), (std::set<double>{-7.5, -2.5, 2.5, 7.5, 12.5, 17.5}));
  EXPECT_EQ(index("--interval 1 --index 10"), (std::set<double>{0, 10}));
  EXPECT_EQ(index("--levels 0,5,10"), (std::set<double>{}));
}

TEST_F(Contour, ShorterThanTheLeastLengthAreLeftOutAndTold) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const std::string run = "spillway contour cone.txt -o c.geojson --force-crs --interval 5 ";
  space.succeed(run);
  const std::size_t all = features(space, "c.geojson").size();
  // The ring at 15 has a radius of 5.
  const Result some = space.run(run + "--base 2.5 --min-length 40 --stats s.json");
  EXPECT_THAT(some.err, HasSubstr(" lines left out: shorter than --min-length 40\n"));
  const auto stats = nlohmann::json::parse(space.read("s.json"))["contours"];
  EXPECT_EQ(stats["lines"], features(space, "c.geojson").size());
  EXPECT_GT(stats["short_lines"], 0);
  for (const nlohmann::json& line : features(space, "c.geojson")) {
    EXPECT_LT(line["properties"]["elevation"], 15);
  }
  const Result none = space.run(run + "-q --min-length 1e6");
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(none.err.substr(none.err.find("warning: no lines")),
            "warning: no lines: " + std::to_string(all) +
                " lines left out: shorter than --min-length 1000000\n");
}

TEST_F(Contour, OfAnotherShapeDependOnNoTilesThreadsAndMeshes) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed("spillway generate -q terrain -n 4000 -o in.las");
  const auto lines = [&](const std::string& options) {
    space.succeed("spillway contour -q -o c.geojson --force-crs --interval 4 " + options);
    std::multiset<std::string> set;
    for (const nlohmann::json& line : features(space, "c.geojson")) set.insert(line.dump());
    return set;
  };
  const std::string shape = " --smooth 2 --simplify 0.5 --min-length 30";
  const auto exact = lines("in.las --min-length 30");
  const auto expected = lines("in.las --threads 1" + shape);
  EXPECT_GT(expected.size(), 10U);
  const auto bytes = [](const std::multiset<std::string>& set) {
    std::size_t sum = 0;
    for (const std::string& line : set) sum += line.size();
    return sum;
  };
  EXPECT_LT(bytes(expected), bytes(exact));
  for (const std::string options : {"--threads 2", "--tile-points 300 --leaf-points 25",
                                    "--division cycling --tile-points 500 --threads 3"}) {
    EXPECT_EQ(lines("in.las " + options + shape), expected) << options;
    space.succeed("spillway triangulate -q in.las -o in.spm " + options);
    EXPECT_EQ(lines("in.spm" + shape), expected) << options;
  }
}

TEST_F(Contour, BandsCoverTheTerrainAndAreWoundAsGeoJsonAsks) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Result result = space.run(
      "spillway contour cone.txt -o c.geojson --force-crs --interval 5 --bands --stats s");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json bands = features(space, "c.geojson");
  EXPECT_THAT(result.err, HasSubstr("; " + std::to_string(bands.size()) + " polygons of "));
  EXPECT_EQ(nlohmann::json::parse(space.read("s"))["contours"]["polygons"], bands.size());
  double sum = 0;
  double top = 0;
  double last = -100;
  for (const nlohmann::json& band : bands) {
    EXPECT_EQ(band["geometry"]["type"], "Polygon");
    const double least = band["properties"]["min"];
    EXPECT_EQ(band["properties"]["max"], least + 5);
    EXPECT_GE(least, last);
    last = least;
    bool is_outer = true;
    for (const auto& ring : band["geometry"]["coordinates"]) {
      EXPECT_EQ(ring.front(), ring.back());
      EXPECT_EQ(ring.front().size(), 2U);
      double twice = 0;
      for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        twice += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
                 ring[i + 1][0].get<double>() * ring[i][1].get<double>();
      }
      EXPECT_EQ(twice > 0, is_outer);
      is_outer = false;
      sum += twice / 2;
      if (least == 15) top += twice / 2;
    }
  }
  EXPECT_NEAR(sum, 1600, 1e-3);
  EXPECT_NEAR(top, M_PI * 25, 4);
}

TEST_F(Contour, BandsAreTheSameFileWhateverTilesAndThreads) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed("spillway generate -q terrain -n 4000 -o in.las");
  const auto file = [&](const std::string& options) {
    space.succeed("spillway contour -q -o c.geojson --force-crs --interval 4 --bands " + options);
    return space.read("c.geojson");
  };
  for (const std::string shape : {"", " --smooth 2 --simplify 0.5"}) {
    const std::string expected = file("in.las --threads 1" + shape);
    for (const std::string options : {"--threads 2", "--tile-points 300 --leaf-points 25"}) {
      EXPECT_EQ(file("in.las " + options + shape), expected) << options << shape;
      space.succeed("spillway triangulate -q in.las -o in.spm " + options);
      EXPECT_EQ(file("in.spm" + shape), expected) << options << shape;
    }
  }
}

TEST_F(Contour, BandsOfAListEndAtTheLeastAndTheGreatestHeight) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.write("edge.xyz", "0.5 -0.5 0.5\n1.5 -0.5 1.5\n0.5 -1.5 0.5\n1.5 -1.5 1.5\n");
  space.succeed("spillway contour -q edge.xyz -o c.json --force-crs --levels 1,9 --bands");
  const nlohmann::json bands = features(space, "c.json");
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_EQ(bands[0]["properties"], nlohmann::json::parse(R"({"min": 0.5, "max": 1})"));
  EXPECT_EQ(bands[1]["properties"], nlohmann::json::parse(R"({"min": 1, "max": 9})"));
  for (const std::string name : {"c.shp", "c.gpkg"}) {
    space.succeed("spillway contour -q edge.xyz --levels 1,9 --bands -o " + name);
  }
  const Result drawing = space.run("spillway contour edge.xyz -o c.dxf --levels 1 --bands");
  EXPECT_NE(drawing.exit_code, 0);
  EXPECT_THAT(drawing.err, HasSubstr("DXF holds lines only; bands go to gpkg, shp or geojson"));
  EXPECT_FALSE(space.has("c.dxf"));
}

TEST_F(Contour, WritesGeoPackagesShapefilesAndDrawings) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  for (const std::string name : {"c.gpkg", "c.shp", "c.dxf"}) {
    space.succeed("spillway contour cone.txt --interval 5 -o " + name);
  }
  EXPECT_THAT(space.read("c.dxf"), HasSubstr("\nCONTOUR-INDEX\n"));
  EXPECT_THAT(space.read("c.dxf"), HasSubstr("\nCONTOUR-INTERMEDIATE\n"));
  EXPECT_FALSE(space.has("c.dxf.tmp"));
  EXPECT_THAT(space.read("c.gpkg"), HasSubstr("SQLite format 3"));
  EXPECT_TRUE(space.has("c.shp"));
  EXPECT_TRUE(space.has("c.dbf"));
}

TEST_F(Contour, DropsNothingSilently) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Result result = space.run(
      "spillway contour cone.txt -o c.geojson --force-crs --interval 5 --max-edge 1 --stats "
      "s.json");
  EXPECT_NE(result.exit_code, 0);  // every triangle has a diagonal
  EXPECT_THAT(result.err, HasSubstr("nothing is left"));
  EXPECT_FALSE(space.has("c.geojson"));
  space.succeed("spillway contour cone.txt -o c.geojson --force-crs --interval 5 --stats s.json");
  const auto stats = nlohmann::json::parse(space.read("s.json"));
  EXPECT_EQ(stats["contours"]["lines"], features(space, "c.geojson").size());
}

TEST_F(Contour, NoLinesAreAWarningWithQuietToo) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Result result =
      space.run("spillway contour -q cone.txt -o c.json --force-crs --levels 1e6");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: no lines: no level lies above the lowest height"));
  EXPECT_EQ(features(space, "c.json").size(), 0U);
}

TEST_F(Contour, ALevelAtTheLeastHeightHasNoLineAndOneAtTheGreatestHas) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.write("edge.xyz", "0.5 -0.5 0.5\n1.5 -0.5 1.5\n0.5 -1.5 0.5\n1.5 -1.5 1.5\n");
  const Result lowest =
      space.run("spillway contour -q edge.xyz -o low.json --force-crs --levels 0.5");
  EXPECT_EQ(lowest.exit_code, 0);
  EXPECT_THAT(lowest.err,
              HasSubstr("warning: no lines: no level lies above the lowest height, 0.5, "
                        "and up to the highest, 1.5\n"));
  EXPECT_EQ(features(space, "low.json").size(), 0U);
  space.succeed("spillway contour -q edge.xyz -o high.json --force-crs --levels 0.5000001,1.5");
  EXPECT_EQ(features(space, "high.json").size(), 2U);
}

TEST_F(Contour, SaysWhatIsWrongWithTheCommandLine) {
  const auto error_of = [&](const std::string& options) {
    const Result result = space.run("spillway contour cone.txt " + options);
    EXPECT_EQ(result.exit_code, 2) << options;
    return result.err;
  };
  EXPECT_THAT(error_of("-o c.gpkg"), HasSubstr("--interval"));
  EXPECT_THAT(error_of("-o c.gpkg --interval -1"),
              HasSubstr("--interval: \"-1\" is not a number above 0"));
  EXPECT_THAT(error_of("-o c.gpkg --interval 1 --levels 3"), HasSubstr("no effect with --levels"));
  EXPECT_THAT(error_of("-o c.dwg --interval 1"), HasSubstr(".gpkg, .shp, .geojson, .json or .dxf"));
  EXPECT_THAT(error_of("-o c.gpkg --interval 1 --index 0"), HasSubstr("--index"));
  EXPECT_THAT(error_of("-o c.gpkg --interval 1 --smooth 0"),
              HasSubstr("--smooth: \"0\" is not a number above 0"));
  EXPECT_THAT(error_of("-o c.gpkg --interval 1 --simplify nan"), HasSubstr("--simplify: \"nan\""));
  EXPECT_THAT(error_of("-o c.gpkg --interval 1 --min-length 0"),
              HasSubstr("--min-length: \"0\" is not a number above 0"));
  EXPECT_EQ(space.names(), std::vector<std::string>{"cone.txt"});
}

TEST_F(Contour, RefusesAMeshWithoutTriangles) {
  space.write("empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  const Result result = space.run("spillway contour empty.obj -o c.gpkg --interval 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("empty.obj"));
  EXPECT_FALSE(space.has("c.gpkg"));
}

TEST_F(Contour, RefusesAMeshOfTetrahedra) {
  space.succeed(
      "spillway generate uniform --dim 3 -n 50 -o p.spp && spillway triangulate p.spp --dim 3 -o "
      "m.spm");
  const Result result = space.run("spillway contour m.spm -o c.gpkg --interval 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("tetrahedra"));
}

/// Four points around a place of zone 32 at about 10.27 degrees east, 45.14 north.
constexpr const char* kUtmPoints =
    "600000 5000000 1\n600010 5000000 2\n600000 5000010 3\n600010 5000010 4\n";

TEST_F(Contour, GeoJsonIsLongitudeAndLatitude) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.write("utm.xyz", kUtmPoints);
  space.succeed("spillway contour -q utm.xyz -o c.geojson --levels 1.5 --crs EPSG:32632");
  const nlohmann::json lines = features(space, "c.geojson");
  ASSERT_EQ(lines.size(), 1U);
  for (const auto& point : lines[0]["geometry"]["coordinates"]) {
    EXPECT_NEAR(point[0].get<double>(), 10.2721, 1e-3);
    EXPECT_NEAR(point[1].get<double>(), 45.1464, 1e-3);
    EXPECT_EQ(point[2], 1.5);
  }
  EXPECT_FALSE(nlohmann::json::parse(space.read("c.geojson")).contains("crs"));
  // As a mesh that tells its system.
  space.succeed("spillway triangulate -q utm.xyz -o utm.spm --crs EPSG:32632");
  space.succeed("spillway contour -q utm.spm -o mesh.geojson --levels 1.5");
  EXPECT_EQ(features(space, "mesh.geojson"), lines);
}

TEST_F(Contour, GeoJsonOfUnknownCoordinatesIsRefusedBeforeWork) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.write("utm.xyz", kUtmPoints);
  space.succeed("spillway triangulate -q utm.xyz -o utm.spm");
  const std::string local = " --crs 'LOCAL_CS[\"site\",UNIT[\"metre\",1]]'";
  for (const std::string input : {"utm.xyz", "utm.spm"}) {
    for (const std::string& crs : {std::string(), local}) {
      const std::string run = "spillway contour -o c.geojson --levels 1.5 " + input + crs;
      const Result result = space.run(run);
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_THAT(result.err, HasSubstr("GeoJSON holds longitude and latitude in WGS 84, and"));
      EXPECT_THAT(result.err, HasSubstr(input));
      EXPECT_THAT(result.err, HasSubstr("with --crs, or write them as they are with --force-crs"));
      EXPECT_EQ(result.err.find("read:"), std::string::npos);
      const Result forced = space.run(run + " --force-crs");
      EXPECT_EQ(forced.exit_code, 0) << forced.err;
      EXPECT_THAT(forced.err, HasSubstr("coordinates are written as they are"));
      const auto point = features(space, "c.geojson")[0]["geometry"]["coordinates"][0];
      EXPECT_GE(point[0].get<double>(), 600000);
    }
  }
}

TEST_F(Contour, GeoJsonRefusesDegreesThatAreNone) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.write("utm.xyz", kUtmPoints);
  const Result result =
      space.run("spillway contour utm.xyz -o c.geojson --levels 1.5 --crs EPSG:4326");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("do not become longitude and latitude"));
  EXPECT_THAT(result.err, HasSubstr("name the right coordinate system with --crs and --force-crs"));
  EXPECT_FALSE(space.has("c.geojson"));
}

}  // namespace
}  // namespace spillway::test
