// `info`, `check` and `generate` as people and programs use them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(Info, TellsThePointsOfALasFile) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 3000 -o in.las");
  const auto info = work.info("in.las");
  EXPECT_EQ(info["kind"], "points");
  EXPECT_EQ(info["format"], "las");
  EXPECT_EQ(info["points"], 3000);
  EXPECT_EQ(info["withheld"], 0);
  EXPECT_EQ(info["scale"], (std::vector<double>{0.01, 0.01, 0.01}));
  EXPECT_EQ(info["extent"]["min"].size(), 3U);
  EXPECT_GT(info["density"].get<double>(), 0);
  for (const char* key :
       {"name", "version", "point_format", "coordinates", "offset", "crs", "software"}) {
    EXPECT_TRUE(info.contains(key)) << key;
  }
}

TEST(Info, ListsWhatPointsCarry) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 100 -o in.las");
  const auto las = work.info("in.las")["attributes"];
  ASSERT_FALSE(las.empty());
  EXPECT_EQ(las[0],
            (nlohmann::json{{"name", "intensity"}, {"type", "uint16"}, {"min", 0}, {"max", 0}}));
  work.succeed("spillway convert -q in.las -o new.las --las-version 1.4");
  const auto extended = work.info("new.las")["attributes"];
  const auto angle = std::find_if(extended.begin(), extended.end(), [](const auto& attribute) {
    return attribute["name"] == "scan_angle";
  });
  ASSERT_NE(angle, extended.end());
  EXPECT_EQ((*angle)["type"], "int16");
  EXPECT_EQ((*angle)["scale"], 0.006);
  EXPECT_EQ((*angle)["offset"], 0);
  const std::string text = work.succeed("spillway info -q new.las");
  EXPECT_THAT(text, HasSubstr("  attributes\n    intensity              uint16  min 0  max 0\n"));
  EXPECT_THAT(text, ::testing::ContainsRegex("    scan_angle +int16  scale 0.006  offset 0"));
}

TEST(Info, CountsClassesAndReturnsAndTellsRangesOfAttributes) {
  const Workspace work;
  work.write("a.las", scattered_las(0, 1000).bytes());
  work.write("b.las", scattered_las(1000, 500).bytes());
  const auto info = work.info("a.las");
  for (const char* number : {"0", "1", "2", "3", "4"}) EXPECT_EQ(info["classes"][number], 200);
  EXPECT_EQ(info["classes"].size(), 5U);
  EXPECT_EQ(info["returns"], (nlohmann::json{{"1", 334}, {"2", 333}, {"3", 333}}));
  for (const auto& attribute : info["attributes"]) {
    if (attribute["name"] != "return_number") continue;
    EXPECT_EQ(attribute["min"], 1);
    EXPECT_EQ(attribute["max"], 3);
  }
  EXPECT_NEAR(info["spacing"].get<double>(), 1 / std::sqrt(info["density"].get<double>()), 1e-12);
  EXPECT_EQ(nlohmann::json::parse(
                work.succeed("spillway info -q --json a.las --keep-class 2,3"))["classes"],
            (nlohmann::json{{"2", 200}, {"3", 200}}));
  std::istringstream lines(work.succeed("spillway info -q --json a.las b.las"));
  std::vector<nlohmann::json> all;
  for (std::string line; std::getline(lines, line);) all.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[2]["kind"], "total");
  EXPECT_EQ(all[2]["files"], 2);
  EXPECT_EQ(all[2]["points"], 1500);
  EXPECT_EQ(all[2]["classes"]["4"], 300);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(all[2]["extent"]["min"][k], std::min(all[0]["extent"]["min"][k].get<double>(),
                                                   all[1]["extent"]["min"][k].get<double>()));
  }
  EXPECT_THAT(work.succeed("spillway info -q a.las b.las"),
              ::testing::ContainsRegex("total\n  kind +total\n  files +2\n  points +1500\n"));
}

TEST(Info, OfHeadersAloneReadsNoPoints) {
  const Workspace work;
  auto las = scattered_las(0, 1000);
  const std::string whole = las.bytes();
  work.write("cut.las", whole.substr(0, whole.size() / 2));
  EXPECT_NE(work.run("spillway info -q cut.las").exit_code, 0);
  work.write("a.las", whole);
  const auto info = nlohmann::json::parse(work.succeed("spillway info -q --json a.las --fast"));
  EXPECT_EQ(info["points"], 1000);
  EXPECT_EQ(info["extent"], info["header_box"]);
  EXPECT_TRUE(info["classes"].is_null());
  EXPECT_TRUE(info["withheld"].is_null());
  EXPECT_EQ(info["attributes"][0], (nlohmann::json{{"name", "intensity"}, {"type", "uint16"}}));
  work.write("a.txt", "1 2 3\n4 5 6\n");
  EXPECT_TRUE(nlohmann::json::parse(work.succeed("spillway info -q --json a.txt --fast"))["points"]
                  .is_null());
  EXPECT_THAT(work.run("spillway info a.las --fast --keep-class 2").err,
              HasSubstr("--keep-class has no effect with --fast, which reads no points"));
}

TEST(Info, OfPointsWithoutAttributesSaysSo) {
  const Workspace work;
  work.write("in.txt", "0 0 7\n10 0 8\n0 5 9\n");
  EXPECT_EQ(work.info("in.txt")["attributes"], nlohmann::json::array());
  EXPECT_THAT(work.succeed("spillway info -q in.txt"), ::testing::ContainsRegex("attributes +-\n"));
}

TEST(Info, ExtentAndDensityOfTextAreExact) {
  const Workspace work;
  work.write("in.txt", "0 0 7\n10 0 8\n0 5 9\n10 5 -1\n");
  const auto info = work.info("in.txt");
  EXPECT_EQ(info["extent"]["min"], (std::vector<double>{0, 0, -1}));
  EXPECT_EQ(info["extent"]["max"], (std::vector<double>{10, 5, 9}));
  EXPECT_EQ(info["density"], 4 / 50.0);
  EXPECT_TRUE(info["scale"].is_null());
}

TEST(Info, PeopleGetNoMoreDigitsThanMeanSomething) {
  const Workspace work;
  work.write("in.txt", "0 0.1 0\n3 848935.2000000001 0\n0 7 0\n");
  const std::string text = work.succeed("spillway info -q in.txt");
  EXPECT_THAT(text, HasSubstr("3  848935.2  0\n"));
  EXPECT_THAT(text, HasSubstr("1.17795e-06\n"));
  EXPECT_EQ(work.info("in.txt")["extent"]["max"][1], 848935.2000000001);
}

TEST(Info, TellsAMeshAndSeveralFilesOnALineEach) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n1.5 1.5 0\n");
  const std::string lines = work.succeed(
      "spillway triangulate -q in.txt -o mesh.ply\n"
      "spillway info -q --json in.txt mesh.ply");
  const auto mesh = nlohmann::json::parse(lines.substr(lines.find('\n')));
  EXPECT_EQ(mesh["kind"], "mesh");
  EXPECT_EQ(mesh["vertices"], 4);
  EXPECT_EQ(mesh["simplices"], 2);
  EXPECT_EQ(mesh["hull_facets"], 4);
  EXPECT_EQ(mesh["canonical_hash"].get<std::string>().size(), 16U);
}

TEST(Info, ReadsPointsFromAPipeAndWritesForPeople) {
  const Workspace work;
  const std::string text =
      work.succeed("spillway generate -q uniform -n 100 --dim 3 -o - | spillway info -q -");
  EXPECT_THAT(text, ::testing::ContainsRegex("points +100\n"));
  EXPECT_THAT(text, HasSubstr("extent min"));
}

TEST(Check, SaysWhatItProvedAndTheHash) {
  const Workspace work;
  work.succeed(
      "spillway generate -q lattice -n 400 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.ply");
  const std::string text = work.succeed("spillway check -q mesh.ply --points in.las");
  EXPECT_THAT(text, HasSubstr("proved: "));
  EXPECT_THAT(text, HasSubstr(work.info("mesh.ply")["canonical_hash"].get<std::string>()));
  const auto json = nlohmann::json::parse(work.succeed("spillway check -q mesh.ply --json"));
  EXPECT_EQ(json["proved"], true);
  EXPECT_EQ(json["on_lattice"], true);
  EXPECT_EQ(json["fault_count"], 0);
  EXPECT_EQ(json["canonical_hash"], work.info("mesh.ply")["canonical_hash"]);
}

TEST(Check, RefutesAFlippedEdgeWithExitCodeOne) {
  const Workspace work;
  // The diagonal of this quadrilateral that is no Delaunay edge: from the first to the last vertex.
  work.write("bad.off", "OFF\n4 2 0\n0 0 0\n3 1 0\n3 -1 0\n6 0 0\n3 0 3 1\n3 0 2 3\n");
  const Result result = work.run("spillway check -q bad.off");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("fault: "));
  EXPECT_THAT(result.out, HasSubstr("NOT"));
  const Result json = work.run("spillway check -q bad.off --json");
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(json.out)["proved"], false);
}

TEST(Check, EitherDiagonalOfASquareIsDelaunayIfAskedFor) {
  const Workspace work;
  const std::string vertices = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  work.write("one.off", vertices + "3 0 1 2\n3 0 2 3\n");
  work.write("other.off", vertices + "3 0 1 3\n3 1 2 3\n");
  const int one = work.run("spillway check -q one.off").exit_code;
  const int other = work.run("spillway check -q other.off").exit_code;
  EXPECT_EQ(one + other, 1) << "exactly one of the two is the canonical triangulation";
  EXPECT_EQ(work.run("spillway check -q --any-delaunay one.off").exit_code, 0);
  EXPECT_EQ(work.run("spillway check -q --any-delaunay other.off").exit_code, 0);
}

TEST(Check, AMeshThatBreaksOnlyTiesAnotherWayIsPointedToTheOptionThatAcceptsIt) {
  const Workspace work;
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n";
  const std::string hint = "--any-delaunay accepts that";
  work.write("a.off", "OFF\n6 4 0\n" + vertices + "3 0 1 2\n3 0 2 3\n3 1 4 5\n3 1 5 2\n");
  const Result ties = work.run("spillway check -q a.off");
  EXPECT_EQ(ties.exit_code, 1);
  EXPECT_THAT(ties.out,
              HasSubstr("a.off: a Delaunay triangulation of its vertices, but NOT the one "
                        "in which ties are broken as Spillway does: 2 edges between "
                        "cocircular vertices differ; " +
                        hint));
  EXPECT_EQ(nlohmann::json::parse(work.run("spillway check -q a.off --json").out)["other_ties"], 2);
  EXPECT_EQ(work.run("spillway check -q a.off --any-delaunay").exit_code, 0);
  work.write("hole.off", "OFF\n6 3 0\n" + vertices + "3 0 1 2\n3 0 2 3\n3 1 4 5\n");
  const Result hole = work.run("spillway check -q hole.off");
  EXPECT_THAT(hole.out, HasSubstr("as ties are broken"));
  EXPECT_THAT(hole.out, AllOf(HasSubstr("hole.off: NOT the Delaunay"), Not(HasSubstr(hint))));
}

/// How often a text has another one in it.
int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

TEST(Check, AMeshOfSquaresIsTheDelaunayTriangulationOfTheirCorners) {
  const Workspace work;
  work.write("grid.obj",
             "v 0 0 0\nv 0.1 0 1\nv 0.2 0 0\nv 0 0.1 1\nv 0.1 0.1 2\nv 0.2 0.1 1\n"
             "f 1 2 5 4\nf 2 3 6 5\n");
  const std::string notice =
      "grid.obj: 2 polygons of more than three corners were cut into 4 triangles\n";
  for (const char* const command :
       {"check grid.obj", "check --any-delaunay grid.obj", "info grid.obj",
        "convert grid.obj -o grid.spm",
        "contour grid.obj --interval 0.5 --force-crs -o lines.geojson"}) {
    const Result result = work.run(std::string("spillway ") + command);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(count_of(result.err, notice), 1) << command << '\n' << result.err;
  }
  EXPECT_EQ(work.info("grid.obj")["simplices"], 4);
}

TEST(Check, MissesAPointOfTheInput) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  work.write("more.txt", "0.3 0.3 0\n");
  work.succeed("spillway triangulate -q in.txt -o mesh.ply");
  EXPECT_EQ(work.run("spillway check -q mesh.ply --points in.txt").exit_code, 0);
  EXPECT_EQ(work.run("spillway check -q mesh.ply --points in.txt more.txt").exit_code, 1);
}

TEST(Generate, SameArgumentsGiveTheSameBytesAndAnotherSeedOthers) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 1e4 -o a.las\n"
      "spillway generate -q terrain -n 10000 --seed 1 -o b.las\n"
      "spillway generate -q terrain -n 1e4 --seed 2 -o c.las\n"
      "cmp a.las b.las; ! cmp -s a.las c.las");
}

TEST(Generate, AGridOfFilesHoldsThePointsOfOne) {
  const Workspace work;
  work.succeed(
      "mkdir survey\n"
      "spillway generate -q terrain -n 60000 -o one.las\n"
      "spillway generate -q terrain -n 60000 --grid 4x3 --overlap 0.1 -o 'survey/hills_#.las'\n"
      "spillway triangulate -q one.las -o one.spm\n"
      "spillway triangulate -q survey -o many.spm");
  EXPECT_EQ(work.succeed("ls survey | wc -l"), "12\n");
  EXPECT_EQ(work.info("many.spm")["canonical_hash"], work.info("one.spm")["canonical_hash"]);
  EXPECT_EQ(work.info("survey/hills_03_02.las")["scale"], work.info("one.las")["scale"]);
  EXPECT_EQ(work.info("survey/hills_03_02.las")["offset"], work.info("one.las")["offset"]);
}

TEST(Generate, AGridTellsHowManyFilesAreWritten) {
  const Workspace work;
  EXPECT_THAT(work.run("spillway generate terrain -n 1000 --grid 2x2 -o 'a_#.las'").err,
              HasSubstr("1000 points of terrain written to 4 files a_#.las, 0."));
  const std::string few = work.run("spillway generate uniform -n 1 --grid 3x1 -o 'b_#.txt'").err;
  EXPECT_THAT(few, HasSubstr("1 points of uniform written to 1 file b_#.txt, none for 2 tiles "
                             "without points, "));
  EXPECT_EQ(work.succeed("ls b_* | wc -l"), "1\n");
  const Result none = work.run("spillway generate terrain -n 0 --grid 2x2 -o 'c_#.las'");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("a grid of 0 points would have no files"));
}

TEST(Generate, AGridOfFilesIsNotMixedWithAnother) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 1000 --grid 2x2 -o 'a_#.las'");
  const auto names = work.names();
  const Result again = work.run("spillway generate terrain -n 1000 --grid 3x3 -o 'a_#.las'");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("a_00_00.las is there and would be taken for part"));
  EXPECT_EQ(work.names(), names);
}

TEST(Generate, AGridTakesFewDescriptors) {
  const Workspace work;
  work.succeed(
      "ulimit -n 48; spillway generate -q terrain -n 60000 --grid 12x12 -o 'a_#.las'\n"
      "spillway generate -q terrain -n 60000 -o one.las\n"
      "spillway triangulate -q one.las -o one.spm; rm one.las\n"
      "spillway triangulate -q '*.las' -o many.spm");
  EXPECT_EQ(work.info("many.spm")["canonical_hash"], work.info("one.spm")["canonical_hash"]);
}

/// Terrain takes none: it always has z.
std::string dimension_option(const std::string& family, const std::string& dimension) {
  return family == "terrain" ? "" : "--dim " + dimension;
}

TEST(Generate, EveryFamilyComesInBothDimensionsAndAsManyAsAskedFor) {
  const Workspace work;
  for (const std::string family : {"uniform", "normal", "bubbles", "ellipsoid", "lines", "lattice",
                                   "circle", "terrain", "packing", "scan"}) {
    for (const std::string dimension : {"2", "3"}) {
      const std::string name = family + dimension + ".npy";
      work.succeed(fmt::format("spillway generate -q {} -n 777 {} -o {}", family,
                               dimension_option(family, dimension), name));
      EXPECT_EQ(work.info(name)["points"], 777) << name;
    }
  }
}

TEST(Generate, AScanIsLasOfTenthsOfMillimetres) {
  const Workspace work;
  work.succeed(
      "spillway generate -q scan -n 500 -o a.las; spillway generate -q scan -n 500 -o a.npy");
  EXPECT_EQ(work.info("a.las")["scale"], (nlohmann::json{0.0001, 0.0001, 0.0001}));
  work.succeed(
      "spillway triangulate -q a.las --dim 3 -o mesh.ply\n"
      "spillway check -q mesh.ply --points a.npy");
}

TEST(Check, AcceptsTheTriangulationOfEveryFamily) {
  const Workspace work;
  for (const std::string family : {"uniform", "normal", "bubbles", "ellipsoid", "lines", "lattice",
                                   "circle", "terrain", "packing", "scan"}) {
    for (const std::string dimension : {"2", "3"}) {
      work.succeed(
          fmt::format("spillway generate -q {} -n 700 {} -o points.npy\n"
                      "spillway triangulate -q points.npy --dim {} --leaf-points 60 -o mesh.ply\n"
                      "spillway check -q mesh.ply --points points.npy",
                      family, dimension_option(family, dimension), dimension));
    }
  }
}

TEST(Generate, NoPointsMakeAValidFile) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 0 -o none.las\n"
      "spillway generate -q terrain -n 0 -o none.spp");
  EXPECT_EQ(work.info("none.las")["points"], 0);
  EXPECT_EQ(work.info("none.spp")["points"], 0);
}

TEST(Generate, WritesSppToAPipeAndTextIfAskedTo) {
  const Workspace work;
  EXPECT_THAT(work.succeed("spillway generate -q uniform -n 5 | head -c 8"), "SPWYSPP\n");
  EXPECT_EQ(work.succeed("spillway generate -q lattice -n 1 --output-format text | wc -l"), "1\n");
}

TEST(Generate, NoBytesForATerminal) {
  const Workspace work;
  for (const std::string options : {"", "--output-format npy"}) {
    const Result refused =
        work.run(fmt::format("spillway generate -q uniform -n 5 {} > /dev/ptmx", options));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("standard output is a terminal"));
  }
  work.succeed("spillway generate -q uniform -n 5 --output-format text > /dev/ptmx");
}

}  // namespace
}  // namespace spillway::test
