// `render`: pictures as libpng reads them, all ways to the same bytes, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_picture.h"
#include "tests/tools/inputs/halved_box.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Opened = OpenedPicture;

/// Expects one run of visible pixels in each row: what is triangulated is convex.
void expect_no_holes(const Opened& picture) {
  for (int row = 0; row < picture.rows(); ++row) {
    int changes = 0;
    for (int column = 1; column < picture.columns(); ++column) {
      if ((picture.opacity(column, row) > 0) != (picture.opacity(column - 1, row) > 0)) ++changes;
    }
    ASSERT_LE(changes, 2) << "row " << row;
  }
}

/// A cone of height 10 on a grid from -10 to 10.
std::string cone() {
  std::string text;
  for (int i = 0; i < 81 * 81; ++i) {
    const double x = (i % 81 - 40) / 4.0;
    const double y = (i / 81 - 40) / 4.0;
    text += fmt::format("{} {} {}\n", x, y, 100 - std::hypot(x, y));
  }
  return text;
}

TEST(Render, AConeIsBrightToTheNorthWest) {
  const Workspace work;
  work.write("cone.txt", cone());
  work.succeed("spillway render -q cone.txt -o view.png --size 212 --exaggerate 1");
  EXPECT_THAT(work.names(), ElementsAre("cone.txt", "view.png"));
  const Opened view(work, "view.png");
  ASSERT_EQ(view.columns(), 212);
  ASSERT_EQ(view.rows(), 212);
  EXPECT_GT(view.brightness(70, 70), view.brightness(141, 141) + 150);
  // To the sides of the light everything is as bright as on the other one.
  for (int i = 40; i < 172; i += 7) {
    EXPECT_NEAR(view.brightness(i, 60), view.brightness(60, i), 25) << i;
  }
}

TEST(Render, TheBackgroundIsWhiteOrTransparent) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n10 0 1\n0 10 0\n");
  work.succeed(
      "spillway render -q points.txt -o white.png --size 100\n"
      "spillway render -q points.txt -o clear.png --size 100 --transparent");
  const Opened white(work, "white.png");
  EXPECT_FALSE(white.has_opacity());
  EXPECT_EQ(white.brightness(90, 10), 765);
  const Opened clear(work, "clear.png");
  EXPECT_TRUE(clear.has_opacity());
  EXPECT_EQ(clear.opacity(90, 10), 0);
  EXPECT_EQ(clear.opacity(10, 90), 255);
  EXPECT_EQ(clear.brightness(10, 80), white.brightness(10, 80));
}

TEST(Render, ZoomShowsTheBoxAndNothingElse) {
  const Workspace work;
  work.write("cone.txt", cone());
  work.succeed(
      "spillway render -q cone.txt -o view.png --size 300 --zoom=-2,-1,10,5 --exaggerate 1 "
      "--transparent");
  const Opened view(work, "view.png");
  EXPECT_EQ(view.columns(), 300);
  EXPECT_EQ(view.rows(), 150);
  EXPECT_EQ(view.count_opaque(), 300 * 150);
  // The top of the cone is where (0, 0) is: 25 pixels a unit.
  EXPECT_GT(view.brightness(40, 115), view.brightness(60, 135) + 150);
}

TEST(Render, OfHeadersThatAreFalseIsThatOfThePoints) {
  const Workspace work;
  work.succeed("spillway generate terrain -n 40000 -q --grid 7x7 -o 't_#.las'");
  halve_box(work, "t_04_04.las");
  for (const std::string options :
       {"--zoom 500020,4100065,500350,4100280 --wireframe", "--dim 3"}) {
    const std::string run = "spillway render t_*.las --tile-points 2000 --size 200 " + options;
    const Result again = work.run(run + " -o again.png");
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_THAT(again.err, HasSubstr("all points are read again")) << options;
    work.succeed(run + " -q --no-trust-headers -o late.png");
    EXPECT_EQ(work.read("again.png"), work.read("late.png")) << options;
  }
}

TEST(Render, WireframeDrawsEdgesAtVertices) {
  const Workspace work;
  work.write("points.txt", "0 0 5\n10 0 5\n0 10 5\n10 10 5\n4 5 5\n");
  work.succeed(
      "spillway render -q points.txt -o plain.png --size 101 --zoom 0,0,10.1,10.1\n"
      "spillway render -q points.txt -o edges.png --size 101 --zoom 0,0,10.1,10.1 --wireframe");
  const Opened plain(work, "plain.png");
  const Opened edges(work, "edges.png");
  // 10 pixels a unit, y from 10.1 down.
  EXPECT_LT(edges.brightness(40, 51), plain.brightness(40, 51) - 100);
  EXPECT_LT(edges.brightness(20, 76), plain.brightness(20, 76) - 50);
  EXPECT_EQ(edges.brightness(60, 51), plain.brightness(60, 51));
}

TEST(Render, EdgesTooShortToBeSeenAreLeftOutAndSaidSo) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 50000 -o in.las");
  const Result far = work.run("spillway render in.las -o edges.png --size 200 --wireframe");
  EXPECT_EQ(far.exit_code, 0) << far.err;
  EXPECT_THAT(far.err, HasSubstr("too small for their edges to be seen: zoom in"));
  const Result near = work.run(
      "spillway render in.las -o near.png --size 400 --wireframe --zoom "
      "500100,4100100,500110,4100110");
  EXPECT_EQ(near.exit_code, 0) << near.err;
  EXPECT_THAT(near.err, ::testing::Not(HasSubstr("zoom in")));
}

TEST(Render, ThreadsTilesAndWaysThroughMeshesGiveTheSameBytes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 50000 -o in.las\n"
      "spillway triangulate -q in.las -o tin.spm\n"
      "spillway triangulate -q in.las -o tin.ply\n"
      "spillway render -q in.las -o one.png --wireframe --threads 1\n"
      "spillway render -q in.las -o two.png --wireframe --threads 2\n"
      "spillway render -q in.las -o tiles.png --wireframe --threads 2 --tile-points 2000 "
      "--leaf-points 300\n"
      "spillway render -q - -o pipe.png --wireframe < in.las\n"
      "spillway render -q in.las -o - --wireframe > out.png\n"
      "spillway render -q tin.spm -o spm.png --wireframe\n"
      "spillway triangulate -q in.las -o - | spillway render -q - -o chain.png --wireframe\n"
      "spillway render -q tin.ply -o ply.png --wireframe");
  const std::string bytes = work.read("one.png");
  EXPECT_GT(bytes.size(), 10'000U);
  for (const char* name :
       {"two.png", "tiles.png", "pipe.png", "out.png", "spm.png", "chain.png", "ply.png"}) {
    EXPECT_TRUE(work.read(name) == bytes) << name;
  }
}

TEST(Render, AViewOfATerrainIsAsHighAsItIsTilted) {
  const Workspace work;
  work.write("plain.txt", "0 0 5\n200 0 5\n0 100 5\n200 100 5\n");
  for (const int elevation : {10, 30, 90}) {
    work.succeed(
        fmt::format("spillway render -q plain.txt -o view.png --size 412 --transparent "
                    "--view 180,{}",
                    elevation));
    const Opened view(work, "view.png");
    EXPECT_EQ(view.columns(), 412);
    EXPECT_NEAR(view.rows(), 12 + 200 * std::sin(elevation * M_PI / 180), 3);
    EXPECT_NEAR(view.count_opaque(), 400 * (view.rows() - 12), 1000);
  }
}

TEST(Render, ShadowsFallAwayFromTheLightAndNothingElseChanges) {
  const Workspace work;
  std::string tower;
  for (int i = 0; i < 101 * 101; ++i) {
    const int x = i % 101;
    const int y = i / 101;
    tower +=
        fmt::format("{} {} {}\n", x, y, std::max(std::abs(x - 50), std::abs(y - 50)) < 4 ? 15 : 0);
  }
  work.write("tower.txt", tower);
  const std::string command =
      "spillway render -q tower.txt --size 412 --exaggerate 1 --light 270,30 ";
  work.succeed(command + "-o light.png\n" + command + "-o shadow.png --shadows");
  const Opened light(work, "light.png");
  const Opened shadow(work, "shadow.png");
  // 4 pixels a unit: from 53 to 53 + 15 / tan(30) = 79 in the east.
  for (int x = 10; x < 98; ++x) {
    if (x > 45 && x < 56) continue;
    const int column = 6 + 4 * x;
    if (x < 77) {
      const int less = light.brightness(column, 206) - shadow.brightness(column, 206);
      EXPECT_EQ(less > 100, x > 50) << x;
    }
    if (x > 81) {
      EXPECT_EQ(light.brightness(column, 206), shadow.brightness(column, 206)) << x;
    }
    EXPECT_EQ(light.brightness(column, 100), shadow.brightness(column, 100)) << x;
  }
}

TEST(Render, ViewsAndShadowsHaveTheSameBytesForAllThreads) {
  const Workspace work;
  const std::string how = " --size 300 --shadows --view 200,30 --wireframe -q ";
  work.succeed(
      "spillway generate -q terrain -n 30000 -o in.las\n"
      "spillway render in.las -o one.png --threads 1" +
      how + "\nspillway render in.las -o two.png --threads 2 --tile-points 2000" + how);
  EXPECT_TRUE(work.read("one.png") == work.read("two.png"));
}

TEST(Render, ATerrainHasNoHoles) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 100000 -o in.las\n"
      "spillway render -q in.las -o view.png --size 700 --transparent");
  expect_no_holes(Opened(work, "view.png"));
}

TEST(Render, RealFilesHaveNoHoles) {
  for (const char* name : {"autzen_trim.las", "lone-star.laz"}) {
    const auto file = shared_file(name);
    if (file.empty()) GTEST_SKIP() << "the shared sample data is not there";
    const Workspace work;
    work.succeed(
        fmt::format("spillway render -q {} -o view.png --size 900 --transparent", file.string()));
    expect_no_holes(Opened(work, "view.png"));
  }
}

TEST(Render, LongTrianglesAreLeftOut) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 0\n10 0 0\n9 1 0\n10 1 0\n");
  const std::string command = "spillway render points.txt --size 206 --transparent ";
  work.succeed(command + "-q -o all.png");
  const Result result = work.run(command + "--max-edge 2 -o two.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("longer than 2 left out"));
  const int all = Opened(work, "all.png").count_opaque();
  EXPECT_NEAR(Opened(work, "two.png").count_opaque(), all / 5.0, all / 50.0);
}

TEST(Render, TheHullOfACubeFillsItsSilhouette) {
  const Workspace work;
  work.succeed(
      "spillway generate -q lattice --dim 3 -n 1000 -o in.las\n"
      "spillway triangulate -q in.las --dim 3 -o cube.spm\n"
      "spillway triangulate -q in.las --dim 3 -o cube.vtu\n"
      "spillway render -q in.las --dim 3 -o points.png --size 212 --view 180,90 --transparent\n"
      "spillway render -q cube.spm -o spm.png --size 212 --view 180,90 --transparent\n"
      "spillway render -q cube.vtu -o vtu.png --size 212 --view 180,90 --transparent\n"
      "spillway render -q cube.vtu -o corner.png --size 212 --view 45,35.2644 --transparent");
  for (const char* name : {"points.png", "spm.png", "vtu.png"}) {
    const Opened view(work, name);
    EXPECT_EQ(view.columns(), 212);
    EXPECT_EQ(view.rows(), 212);
    EXPECT_EQ(view.count_opaque(), 200 * 200) << name;
    EXPECT_EQ(view.brightness(20, 20), view.brightness(190, 100)) << name;
  }
  // From a corner on it is a regular hexagon, of which three faces of different light are seen.
  const Opened hexagon(work, "corner.png");
  expect_no_holes(hexagon);
  const double side = hexagon.rows() / 2.0 - 6;
  EXPECT_NEAR(hexagon.count_opaque(), 1.5 * std::sqrt(3) * side * side, 500);
  const int middle = hexagon.columns() / 2;
  EXPECT_NE(hexagon.brightness(middle, 40), hexagon.brightness(middle - 40, 140));
  EXPECT_NE(hexagon.brightness(middle - 40, 140), hexagon.brightness(middle + 40, 140));
}

TEST(Render, ASliceOfAGridIsWholeAndTheSameFromStreamsAndFiles) {
  const Workspace work;
  work.succeed(
      "spillway generate -q lattice --dim 3 -n 1000 -o in.las\n"
      "spillway triangulate -q in.las --dim 3 -o cube.spm\n"
      "spillway triangulate -q in.las --dim 3 -o cube.vtu");
  // Also on a plane of the grid, where faces of cells lie.
  for (const char* plane : {"x=4.5", "y=4", "z=9"}) {
    const std::string end = fmt::format(" --slice {} --size 212 --transparent", plane);
    work.succeed("spillway render -q in.las --dim 3 -o one.png --threads 1" + end +
                 "\nspillway render -q in.las --dim 3 -o two.png --threads 2" + end +
                 "\nspillway render -q cube.spm -o spm.png" + end +
                 "\nspillway render -q cube.vtu -o vtu.png" + end);
    const std::string bytes = work.read("one.png");
    for (const char* name : {"two.png", "spm.png", "vtu.png"}) {
      EXPECT_TRUE(work.read(name) == bytes) << plane << ' ' << name;
    }
    EXPECT_EQ(Opened(work, "one.png").count_opaque(), 200 * 200) << plane;
  }
}

TEST(Render, ASliceCanBeZoomedInto) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform --dim 3 -n 2000 -o in.npy\n"
      "spillway render -q in.npy --dim 3 -o view.png --slice z=0.5 --zoom 0.4,0.4,0.6,0.5 --size "
      "100");
  const Opened view(work, "view.png");
  EXPECT_EQ(view.columns(), 100);
  EXPECT_EQ(view.rows(), 50);
}

TEST(Render, FiguresTellThePicturesSize) {
  const Workspace work;
  work.write("points.txt", "0 0 1\n10 0 1\n0 5 2\n");
  const Result result = work.run("spillway render points.txt -o view.png --stats run.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("1200 x 606 pixels"));
  const auto json = nlohmann::json::parse(work.read("run.json"));
  EXPECT_EQ(json["picture"]["columns"], 1200);
  EXPECT_EQ(json["picture"]["rows"], 606);
  EXPECT_EQ(json["simplices"], 1);
}

struct Refused {
  const char* name;
  const char* arguments;
  int exit_code;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.arguments; }

class RenderRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(RenderRefuses, AndLeavesNothing) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n1 0 1\n0 1 2\n1 1 1\n0.5 0.5 3\n");
  work.write("tin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto before = work.names();
  const Result result = work.run(std::string("spillway render -q ") + GetParam().arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
  EXPECT_EQ(work.names(), before);
}

constexpr std::array kRefused = {
    Refused{"AnotherFormat", "points.txt -o view.jpg", 2,
            "a picture is a .png or a .tif, and a page is an .html"},
    Refused{"NoExtension", "points.txt -o view", 2,
            "a picture is a .png or a .tif, and a page is an .html"},
    Refused{"MissingFolder", "points.txt -o no/view.png", 1, "create the folder"},
    Refused{"ZoomWithoutArea", "points.txt -o view.png --zoom 1,1,1,5", 2, "--zoom"},
    Refused{"ZoomOfThreeNumbers", "points.txt -o view.png --zoom 1,1,5", 2, "--zoom"},
    Refused{"ZoomBesideThePoints", "points.txt -o view.png --zoom 7,7,8,8", 1, "beside"},
    Refused{"TooSmall", "points.txt -o view.png --size 5", 2, "--size"},
    Refused{"TooLargeForTheMemory", "points.txt -o view.png --size 9000 --memory 512M", 2,
            "--memory 2472M is enough"},
    Refused{"TooLittleMemory", "points.txt -o view.png --memory 32M", 2, "--memory"},
    Refused{"NegativeExaggeration", "points.txt -o view.png --exaggerate=-1", 2, "--exaggerate"},
    Refused{"SliceOfATerrain", "points.txt -o view.png --slice z=1", 2, "a slice is of tetrahedra"},
    Refused{"ViewOfATerrainFromBelow", "tin.obj -o view.png --view 30,-5", 2, "seen from above"},
    Refused{"LightFromBelow", "points.txt -o view.png --light 30,-5", 2, "--light"},
    Refused{"LightInSpace", "points.txt --dim 3 -o view.png --light 30,5", 2, "chosen of terrains"},
    Refused{"ShadowsInSpace", "points.txt --dim 3 -o view.png --shadows", 2, "chosen of terrains"},
    Refused{"ScaleBarAslant", "points.txt -o view.png --view 30,5 --scale-bar", 2, "is of a map"},
    Refused{"WorldFileAslant", "points.txt -o view.png --view 30,5 --world-file", 2, "is of a map"},
    Refused{"GeoTiffAslant", "points.txt -o view.tif --view 30,5", 2, "is of a map"},
    Refused{"ShadowsOfAPage", "points.txt -o view.html --shadows", 2, "no cast shadows"},
    Refused{"SliceIsNoPlane", "points.txt --dim 3 -o view.png --slice w=1", 2, "not a plane"},
    Refused{"SliceIsNoNumber", "points.txt --dim 3 -o view.png --slice z=high", 2, "not a plane"},
    Refused{"SliceBesideTheMesh", "points.txt --dim 3 -o view.png --slice z=50", 1,
            "z is from 0 to 3"},
    Refused{"SliceWithAView", "points.txt --dim 3 -o view.png --slice z=1 --view 1,2", 2,
            "a view is of the hull"},
    Refused{"HullWithZoom", "points.txt --dim 3 -o view.png --zoom 0,0,1,1", 2,
            "a zoom is of terrains and slices"},
    Refused{"HullWithExaggeration", "points.txt --dim 3 -o view.png --exaggerate 2", 2,
            "heights are exaggerated of terrains"},
    Refused{"ViewFromBelowTheFeet", "points.txt --dim 3 -o view.png --view 30,91", 2, "--view"},
    Refused{"DuplicatesInSpace", "points.txt --dim 3 -o view.png --heights lowest", 2, "--heights"},
    Refused{"EverythingTooLong", "points.txt -o view.png --max-edge 0.01", 1, "nothing is left"},
    Refused{"FilteredMesh", "tin.obj -o view.png --every 2", 2, "--every has no effect"},
    Refused{"MissingInput", "nowhere.las -o view.png", 1, "nowhere.las"},
};

INSTANTIATE_TEST_SUITE_P(All, RenderRefuses, ::testing::ValuesIn(kRefused),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RenderFaults, AFailedRunKeepsThePictureThatWasThere) {
  const Workspace work;
  work.write("view.png", "old");
  work.write("points.txt", "0 0 0\n1 1 1\n2 2 2\n");
  const Result result = work.run("spillway render -q points.txt -o view.png");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(work.read("view.png"), "old");
}

TEST(RenderFaults, AFileThatMayNotGrowIsAnErrorAndLeavesNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 20000 -o in.las");
  const auto before = work.names();
  const Result result = work.run("ulimit -f 20; spillway render -q in.las -o view.png");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("view.png"));
  EXPECT_EQ(work.names(), before);
}

}  // namespace
}  // namespace spillway::test
