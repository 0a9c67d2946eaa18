// The command `dem` with products of points.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr float kNodata = -9999;

class DemOfPointsCommand : public ::testing::Test {
 protected:
  DemOfPointsCommand() { work_.succeed("spillway generate terrain -n 60000 -q -o in.las"); }

  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_TRUE(work_.read(a) == work_.read(b)) << a << ", " << b;
  }

  Workspace work_;
};

TEST_F(DemOfPointsCommand, SaysWhatThePointsOfAPixelAre) {
  work_.write(
      "in.csv",
      "x,y,z\n0,10,1\n0,10,3\n4.9,9,5\n5,9,2\n10,0,7\n10,5,8\n9,5.01,100\n30,30,4\n1,1,-2\n");
  const Result run = work_.run(
      "spillway dem in.csv -o a.tif --resolution 5 --bounds 0,0,10,10 --product "
      "count,min,max,mean,stddev,p50,p75");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("8 points in 4 pixels, 1 beside the raster"));
  EXPECT_THAT(run.err, Not(HasSubstr("triangles")));
  const OpenedRaster raster(work_, "a.tif");
  EXPECT_EQ(std::string(raster.file().GetRasterBand(7)->GetDescription()), "p75");
  // 1, 3 and 5; 2 and 100; -2; 8 and 7, which lie on southern edges.
  EXPECT_THAT(raster.pixels(1), ElementsAre(3, 2, 1, 2));
  EXPECT_THAT(raster.pixels(2), ElementsAre(1, 2, -2, 7));
  EXPECT_THAT(raster.pixels(3), ElementsAre(5, 100, -2, 8));
  EXPECT_THAT(raster.pixels(4), ElementsAre(3, 51, -2, 7.5));
  EXPECT_THAT(raster.pixels(5), ElementsAre(static_cast<float>(std::sqrt(8.0 / 3)), 49, 0, 0.5));
  EXPECT_THAT(raster.pixels(6), ElementsAre(3, 51, -2, 7.5));
  EXPECT_THAT(raster.pixels(7), ElementsAre(4, 75.5, -2, 7.75));
}

/// The same points are told of with and without triangles, whatever is read first.
TEST_F(DemOfPointsCommand, IsTheSameAloneAndBesideTriangles) {
  const std::string products = "--product max,count,p95,stddev";
  for (const std::string options :
       {"", "--align", "--bounds 500010,4100010,500200,4100100", "--no-trust-headers", "--every 3",
        "--clip-bounds 500010,4100010,500200,4100100", "--thin 3:lowest"}) {
    const std::string dem = "spillway dem -q in.las --resolution 2 --compress none " + options;
    work_.succeed(dem + " -o alone.tif " + products);
    work_.succeed(dem + " -o both.tif --tile-points 5000 --product max,count,p95,stddev,height");
    const OpenedRaster alone(work_, "alone.tif");
    const OpenedRaster both(work_, "both.tif");
    ASSERT_EQ(alone.columns(), both.columns());
    for (int band = 1; band <= 4; ++band) {
      EXPECT_TRUE(alone.pixels(band) == both.pixels(band)) << options << ", band " << band;
    }
    work_.succeed(dem + " -o pipe.tif " + products + " --threads 1 --memory 64M");
    expect_same("alone.tif", "pipe.tif");
  }
  work_.succeed("spillway dem -q - --resolution 2 --compress none -o pipe.tif " + products +
                " < in.las\nspillway dem -q in.las --resolution 2 --compress none -o alone.tif " +
                products);
  expect_same("alone.tif", "pipe.tif");
}

TEST_F(DemOfPointsCommand, CountsPointsThatAreOneVertex) {
  work_.succeed(
      "spillway dem -q in.las in.las -o twice.tif --resolution 5 --product count,density\n"
      "spillway dem -q in.las -o once.tif --resolution 5 --product count,density");
  const OpenedRaster once(work_, "once.tif");
  const OpenedRaster twice(work_, "twice.tif");
  EXPECT_TRUE(once.pixels(2) == twice.pixels(2));
  std::vector<float> doubled = once.pixels(1);
  double points = 0;
  for (float& pixel : doubled) {
    points += pixel;
    pixel *= 2;
  }
  EXPECT_EQ(points, 60'000);
  EXPECT_TRUE(doubled == twice.pixels(1));
}

TEST_F(DemOfPointsCommand, PointsOnOneLineWillDoWithoutTriangles) {
  work_.write("line.csv", "x,y,z\n0,0,1\n1,1,2\n2,2,3\n");
  work_.succeed("spillway dem -q line.csv -o a.tif --resolution 1 --product max");
  EXPECT_THAT(OpenedRaster(work_, "a.tif").pixels(), ElementsAre(kNodata, 3, 1, 2));
  EXPECT_EQ(
      work_.run("spillway dem -q line.csv -o b.tif --resolution 1 --product max,height").exit_code,
      1);
}

/// Two islands a hundred apart: between them and in the bay of one of them there is nothing.
TEST_F(DemOfPointsCommand, TheLongestEdgeKeepsIslandsApart) {
  std::string text = "x,y,z\n";
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      const bool bay = x > 10 && y > 12 && y < 28;
      if (!bay && (x * 7 + y * 3) % 5 != 0)
        text += std::to_string(x) + "," + std::to_string(y) + ",1\n";
      text += std::to_string(x + 140) + "," + std::to_string(y) + ",2\n";
    }
  }
  work_.write("islands.csv", text);
  const std::string dem =
      "spillway dem -q islands.csv --resolution 1 --bounds -0.5,-0.5,179.5,39.5 ";
  work_.succeed(dem + "-o joined.tif --product height,max --fill-voids\n" + dem +
                "-o apart.tif --product height,max,count --fill-voids --max-edge 4");
  const OpenedRaster joined(work_, "joined.tif");
  const OpenedRaster apart(work_, "apart.tif");
  const auto at = [](const std::vector<float>& pixels, int x, int y) {
    return pixels[static_cast<std::size_t>((39 - y) * 180 + x)];
  };
  EXPECT_NE(at(joined.pixels(2), 90, 20), kNodata);
  const std::vector<float> count = apart.pixels(3);
  for (const int band : {1, 2}) {
    const std::vector<float> pixels = apart.pixels(band);
    for (int y = 1; y < 39; ++y) {
      for (int x = 1; x < 39; ++x) {
        const bool bay = x > 13 && y > 14 && y < 26;
        if (bay || x < 9) {
          EXPECT_EQ(at(pixels, x, y), bay ? kNodata : 1) << x << ", " << y;
        }
        EXPECT_EQ(at(pixels, x + 140, y), 2);
        EXPECT_EQ(at(pixels, x + 60, y), kNodata);
      }
    }
  }
  EXPECT_GT(std::ranges::count(count, 0), 2000);
}

TEST_F(DemOfPointsCommand, RefusesWhatHasNoEffectAndWhatCannotBe) {
  work_.succeed("spillway triangulate -q in.las -o mesh.ply");
  const std::string dem = "spillway dem -q --resolution 5 -o a.tif ";
  struct Case {
    std::string arguments;
    int exit_code;
    std::string message;
  };
  const std::vector<Case> cases = {
      {"mesh.ply --product count", 2, "mesh.ply is a mesh, which has only vertices, and count is"},
      {"in.las --product p101", 2, "\"p101\" is not a product"},
      {"in.las --product percentile", 2, "\"percentile\" is not a product"},
      {"in.las --product p50,p50.0", 2, "p50.0 appears twice"},
      {"in.las --product p5x", 2, "p95 (a percentile)"},
      {"in.las --product max --heights mean", 2,
       "--heights has no effect on products of points alone"},
      {"in.las --product max,count --max-edge 5", 2,
       "--max-edge has no effect on products of points alone"},
      {"in.las --product max --resume run", 2,
       "--resume has no effect on products of points alone"},
      {"in.las --product height,count --fill-voids", 2,
       "--fill-voids has no effect without min, max, mean or a percentile"},
      {"in.las --product max --z-factor 2", 2, "--z-factor has no effect"},
      {"in.las --product count --type byte", 2, "count does not fit"},
  };
  for (const Case& one : cases) {
    const Result run = work_.run(dem + one.arguments);
    EXPECT_EQ(run.exit_code, one.exit_code) << one.arguments << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr(one.message)) << one.arguments;
  }
}

/// Of a mesh that a batch makes, nothing would be left of the points.
TEST_F(DemOfPointsCommand, ABatchMakesThemOfThePoints) {
  work_.succeed(
      "spillway batch in.las --output-dir out --to dem.tif,max.tif,p95.tif,spm --resolution 5 "
      "--max-edge 90 --fill-voids\n"
      "spillway dem -q in.las -o max.tif --resolution 5 --product max --fill-voids --max-edge 90\n"
      "spillway dem -q in.las -o dem.tif --resolution 5 --max-edge 90");
  expect_same("out/in.max.tif", "max.tif");
  expect_same("out/in.dem.tif", "dem.tif");
  EXPECT_GT(work_.read("out/in.p95.tif").size(), 1000U);
}

}  // namespace
}  // namespace spillway::test
