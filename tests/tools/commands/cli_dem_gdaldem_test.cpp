// `dem`: what comes of a pixel's neighbours, beside what gdaldem makes of the same heights.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/tools/command_runner.h"
#include "tests/tools/commands/opened_raster.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Terrain of several tiles of pixels with holes and a ragged hull, and its heights as a raster.
class DemBesideGdaldem : public ::testing::Test {
 protected:
  void SetUp() override {
    work_.succeed("command -v gdaldem > gdaldem.path || true");
    if (work_.read("gdaldem.path").empty()) GTEST_SKIP() << "gdaldem is not installed";
    work_.succeed(
        "spillway generate -q terrain -n 30000 -o hills.las\n"
        "spillway dem -q hills.las -o height.tif" +
        how_);
  }

  /// Compares a product with what gdaldem makes of the heights: values are equal but for `unit`,
  /// and none is where the other has one.
  void expect_equal(const std::string& product, const std::string& options,
                    const std::string& gdaldem, float unit) const {
    work_.succeed("spillway dem -q hills.las -o ours.tif --product " + product + how_ + options +
                  "\ngdaldem " + gdaldem + " height.tif theirs.tif -q");
    const OpenedRaster ours(work_, "ours.tif");
    const OpenedRaster theirs(work_, "theirs.tif");
    ASSERT_GT(ours.columns(), 2 * 256);
    ASSERT_GT(ours.rows(), 2 * 256);
    const std::vector<float> a = ours.pixels();
    const std::vector<float> b = theirs.pixels();
    ASSERT_EQ(a.size(), b.size());
    const auto our_nodata = static_cast<float>(ours.band().GetNoDataValue());
    const auto their_nodata = static_cast<float>(theirs.band().GetNoDataValue());
    std::size_t with_data = 0;
    float worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i] == our_nodata, b[i] == their_nodata)
          << i / ours.columns() << ", " << i % ours.columns() << ": " << a[i] << ", " << b[i];
      if (a[i] == our_nodata) continue;
      ++with_data;
      float off = std::abs(a[i] - b[i]);
      if (product == "aspect") off = std::min(off, 360 - off);
      const float ulp = std::nextafter(std::abs(b[i]), INFINITY) - std::abs(b[i]);
      worst = std::max(worst, unit > 0 ? off / unit : off / ulp);
    }
    EXPECT_LE(worst, 1) << product << options;
    EXPECT_GT(with_data, a.size() / 2);
    EXPECT_LT(with_data, a.size());
  }

  const std::string how_ = " --resolution 0.5 --max-edge 8 ";
  const Workspace work_;
};

/// In units of the last bit of a float.
constexpr float kOneUlp = 0;

TEST_F(DemBesideGdaldem, SlopeIsTheSame) {
  expect_equal("slope", "", "slope", kOneUlp);
  expect_equal("slope", "--z-factor 3", "slope -s 0.333333333333333333", kOneUlp);
  expect_equal("slope", "--gradient zevenbergen-thorne", "slope -alg ZevenbergenThorne", kOneUlp);
}

TEST_F(DemBesideGdaldem, AspectIsTheSame) {
  expect_equal("aspect", "", "aspect", kOneUlp);
  expect_equal("aspect", "--gradient zevenbergen-thorne", "aspect -alg ZevenbergenThorne", kOneUlp);
}

TEST_F(DemBesideGdaldem, HillshadeIsTheSame) {
  expect_equal("hillshade", "--type byte", "hillshade", 1);
  expect_equal("hillshade", "--type byte --azimuth 100 --altitude 20 --z-factor 2",
               "hillshade -az 100 -alt 20 -z 2", 1);
  expect_equal("hillshade", "--type byte --gradient zevenbergen-thorne",
               "hillshade -alg ZevenbergenThorne", 1);
  expect_equal("multi-hillshade", "--type byte --altitude 30",
               "hillshade -multidirectional -alt 30", 1);
}

TEST_F(DemBesideGdaldem, EdgesAreComputedAlike) {
  expect_equal("slope", "--compute-edges", "slope -compute_edges", kOneUlp);
  expect_equal("hillshade", "--compute-edges --type byte", "hillshade -compute_edges", 1);
  expect_equal("roughness", "--compute-edges", "roughness -compute_edges", kOneUlp);
}

/// gdaldem adds floats.
TEST_F(DemBesideGdaldem, RoughnessRuggednessAndPositionAreTheSame) {
  constexpr float kRoundedSum = 1e-4F;
  expect_equal("roughness", "", "roughness", kOneUlp);
  expect_equal("tri", "", "TRI -alg Riley", kRoundedSum);
  expect_equal("tpi", "", "TPI", kRoundedSum);
}

TEST(DemBytes, HoldShadesWithNoDataZero) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "spillway dem -q in.las -o bytes.tif --resolution 1 --type byte --product "
      "hillshade,multi-hillshade,facet-hillshade\n"
      "spillway dem -q in.las -o floats.tif --resolution 1 --nodata 0 --product "
      "hillshade,multi-hillshade,facet-hillshade\n"
      "spillway dem -q in.las -o cog.tif --resolution 1 --type byte --cog --compress zstd "
      "--product hillshade");
  const OpenedRaster bytes(work, "bytes.tif");
  const OpenedRaster floats(work, "floats.tif");
  EXPECT_EQ(bytes.structure("COMPRESSION"), "DEFLATE");
  for (int band = 1; band <= 3; ++band) {
    EXPECT_EQ(bytes.band(band).GetRasterDataType(), GDT_Byte);
    EXPECT_EQ(bytes.band(band).GetNoDataValue(), 0);
    const std::vector<float> whole = bytes.pixels(band);
    const std::vector<float> parts = floats.pixels(band);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_EQ(whole[i] == 0, parts[i] == 0);
      if (whole[i] != 0) {
        ASSERT_LE(std::abs(whole[i] - std::max(parts[i], 1.0F)), 0.5F);
      }
    }
  }
  EXPECT_EQ(OpenedRaster(work, "cog.tif").band().GetRasterDataType(), GDT_Byte);
  EXPECT_EQ(OpenedRaster(work, "cog.tif").pixels(), bytes.pixels());
}

TEST(DemNeighbours, EveryWayGivesTheSameBytes) {
  const Workspace work;
  const std::string how =
      " --resolution 0.5 --compute-edges --product "
      "slope,aspect,hillshade,multi-hillshade,roughness,tri,tpi,curvature,profile-curvature,"
      "plan-curvature ";
  work.succeed(
      "spillway generate -q terrain -n 50000 -o in.las\n"
      "spillway triangulate -q in.las -o tin.spm\n"
      "spillway triangulate -q in.las -o tin.ply\n"
      "spillway dem -q in.las -o one.tif --threads 1" +
      how + "\nspillway dem -q in.las -o two.tif --threads 2 --memory 2G" + how +
      "\nspillway dem -q in.las -o tiles.tif --memory 64M --tile-points 2000 --threads 1" + how +
      "\nspillway dem -q in.las -o resumed.tif --resume run" + how +
      "\nspillway dem -q tin.spm -o spm.tif" + how + "\nspillway dem -q tin.ply -o ply.tif" + how);
  const std::string bytes = work.read("one.tif");
  EXPECT_GT(bytes.size(), 10'000U);
  for (const char* name : {"two.tif", "tiles.tif", "resumed.tif", "spm.tif", "ply.tif"}) {
    EXPECT_TRUE(work.read(name) == bytes) << name;
  }
}

/// No band of heights is needed, and products keep their order.
TEST(DemNeighbours, AreTheSameInEveryChoiceOfBands) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "spillway dem -q in.las -o a.tif --resolution 1 --product slope\n"
      "spillway dem -q in.las -o b.tif --resolution 1 --product density,slope,facet-slope,height");
  const OpenedRaster alone(work, "a.tif");
  const OpenedRaster among(work, "b.tif");
  EXPECT_EQ(alone.file().GetRasterCount(), 1);
  EXPECT_EQ(alone.pixels(), among.pixels(2));
  EXPECT_STREQ(among.band(2).GetDescription(), "slope");
  EXPECT_STREQ(among.band(3).GetDescription(), "facet-slope");
}

TEST(DemDegrees, OfNoKnownSystemAreWarnedOfWhereTheyCount) {
  const Workspace work;
  std::string degrees;
  std::string metres;
  for (int i = 0; i < 100; ++i) {
    degrees += fmt::format("{} {} {}\n", 8 + 0.001 * (i % 10), 47 + 0.001 * (i / 10), i % 7);
    metres += fmt::format("{} {} {}\n", 800 + i % 10, 47 + i / 10, i % 7);
  }
  work.write("degrees.txt", degrees);
  work.write("metres.txt", metres);
  const auto said = [&](const std::string& arguments) {
    const Result result = work.run("spillway dem -o a.tif " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  const std::string dem = "degrees.txt --resolution 0.001 ";
  for (const std::string product : {"slope", "facet-aspect", "multi-hillshade", "curvature"}) {
    EXPECT_THAT(said(dem + "--product " + product), HasSubstr("x and y may be degrees"));
  }
  EXPECT_THAT(said(dem + "--product slope --bounds 8,47,8.005,47.005"), HasSubstr("degrees"));
  for (const std::string& arguments :
       {dem, dem + "--product roughness,tri,tpi,density", dem + "--product slope --z-factor 1",
        dem + "--product slope --crs EPSG:4326",
        std::string("metres.txt --resolution 1 --product slope")}) {
    EXPECT_THAT(said(arguments), Not(HasSubstr("degrees"))) << arguments;
  }
}

TEST(DemNeighbours, ARasterThatIsTooSmallForThemIsToldSo) {
  const Workspace work;
  std::string points;
  for (int i = 0; i < 100; ++i) points += fmt::format("{} {} {}\n", 1000 + i % 10, i / 10, i % 7);
  work.write("points.txt", points);
  const std::string dem = "spillway dem -q points.txt -o a.tif --resolution 5 --product slope";
  EXPECT_THAT(work.run(dem).err,
              HasSubstr("none of the 2 x 2 has the eight neighbours that slope needs"));
  EXPECT_THAT(work.run(dem + " --compute-edges").err, Not(HasSubstr("no pixel has a value")));
}

}  // namespace
}  // namespace spillway::test
