// `dem`: slopes where x, y and z are not measured alike.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A plane that rises by `rise` metres for each metre to the east at 47 degrees north, in degrees.
std::string plane_in_degrees(double rise) {
  constexpr double kMetresEast = 76055.5;  // of a degree of longitude there (WGS 84)
  std::string text;
  for (int i = 0; i < 100; ++i) {
    const double x = 8 + 0.0001 * (i % 10);
    const double y = 47 + 0.0001 * (i / 10);
    text += fmt::format("{:.6f} {:.6f} {:.9f}\n", x, y, 400 + rise * kMetresEast * (x - 8));
  }
  return text;
}

float middle_of(const Workspace& work, const std::string& name, int band = 1) {
  const OpenedRaster dem(work, name);
  return dem.pixels(
      band)[static_cast<std::size_t>(dem.rows() / 2 * dem.columns() + dem.columns() / 2)];
}

TEST(DemUnits, DegreesHaveTheirLengthForSlopes) {
  const Workspace work;
  work.write("points.txt", plane_in_degrees(1));
  const std::string dem =
      "spillway dem -q points.txt -o dem.tif --resolution 0.0001 "
      "--product height,slope,aspect,hillshade,facet-slope,facet-aspect,facet-hillshade "
      "--azimuth 270 ";
  work.succeed(dem + "--crs EPSG:4326");
  EXPECT_NEAR(middle_of(work, "dem.tif", 2), 45, 0.01);
  EXPECT_NEAR(middle_of(work, "dem.tif", 3), 270, 0.01);
  EXPECT_NEAR(middle_of(work, "dem.tif", 4), 255, 0.01);
  EXPECT_NEAR(middle_of(work, "dem.tif", 5), 45, 0.01);
  EXPECT_NEAR(middle_of(work, "dem.tif", 6), 270, 0.01);
  EXPECT_NEAR(middle_of(work, "dem.tif", 7), 255, 0.01);
  const float height = middle_of(work, "dem.tif", 1);
  // No guess, and what is said by hand.
  work.succeed(dem);
  EXPECT_GT(middle_of(work, "dem.tif", 2), 89.99);
  work.succeed(dem + "--crs EPSG:4326 --z-factor 1");
  EXPECT_GT(middle_of(work, "dem.tif", 2), 89.99);
  work.succeed(dem + "--crs EPSG:4326 --z-factor 1.31483e-05");
  EXPECT_NEAR(middle_of(work, "dem.tif", 2), 45, 0.01);
  EXPECT_EQ(middle_of(work, "dem.tif", 1), height) << "heights are what they were";
}

TEST(DemUnits, HeightsInFeetAboveMetresAreScaledForSlopes) {
  const Workspace work;
  std::string text;
  for (int i = 0; i < 100; ++i) text += fmt::format("{} {} {}\n", i % 10, i / 10, i % 10 / 0.3048);
  work.write("points.txt", text);
  const std::string dem = "spillway dem -q points.txt -o dem.tif --resolution 1 --product slope ";
  work.succeed(dem + "--crs EPSG:26918+6360");
  EXPECT_NEAR(middle_of(work, "dem.tif"), 45, 0.01);
  for (const std::string unchanged :
       {"", "--crs EPSG:26918", "--crs EPSG:26918+5703", "--crs EPSG:2927", "--z-factor 1"}) {
    work.succeed(dem + unchanged);
    EXPECT_NEAR(middle_of(work, "dem.tif"), 73.04, 0.01) << unchanged;
  }
  work.succeed(dem + "--z-factor 0.3048");
  EXPECT_NEAR(middle_of(work, "dem.tif"), 45, 0.01);
}

TEST(DemUnits, DegreesGiveTheSameBytesHoweverTheyCome) {
  const Workspace work;
  work.write("points.txt", plane_in_degrees(0.3));
  const std::string dem =
      " -o {} --resolution 0.00003 --product slope,aspect,facet-hillshade,curvature -q ";
  const auto run = [&](const std::string& input, const std::string& output) {
    work.succeed("spillway dem " + input + fmt::format(fmt::runtime(dem), output));
    return work.read(output);
  };
  const std::string crs = " --crs EPSG:4326 ";
  const std::string one = run("points.txt --threads 1" + crs, "one.tif");
  EXPECT_EQ(run("points.txt --threads 3 --tile-points 30" + crs, "more.tif"), one);
  work.succeed("spillway triangulate -q points.txt -o tin.spm" + crs);
  EXPECT_EQ(run("tin.spm", "mesh.tif"), one);
}

TEST(DemUnits, DegreesThatAreNoneAreRefusedWhereTheyCount) {
  const Workspace work;
  work.write("points.txt", "600000 5000000 1\n600010 5000000 2\n600000 5000010 3\n");
  const std::string dem = "spillway dem points.txt -o dem.tif --resolution 1 --crs EPSG:4326 ";
  const Result result = work.run(dem + "--product slope");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err,
              HasSubstr("y reaches from 5000000 to 5000010, which are no latitudes of"));
  EXPECT_THAT(result.err, HasSubstr("--z-factor"));
  work.succeed(dem);
  work.succeed(dem + "--product slope --z-factor 1");
}

}  // namespace
}  // namespace spillway::test
