// The command `dem` where headers tell where points lie: rasters are painted while these are read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Many files whose headers tell where their points lie: painted while they are read.
class DemOfASurvey : public ::testing::Test {
 protected:
  DemOfASurvey() {
    work_.succeed(
        "spillway generate terrain -n 40000 -q -o all.las\n"
        "spillway generate terrain -n 40000 -q --grid 7x7 -o 't_#.las'");
  }

  /// The statistics of a raster that is made with small tiles of points.
  nlohmann::json make(const std::string& name, const std::string& arguments) {
    messages_ =
        work_.run("spillway dem --resolution 0.25 --tile-points 2000 --stats stats.json -o " +
                  name + " " + arguments);
    EXPECT_EQ(messages_.exit_code, 0) << messages_.err;
    return nlohmann::json::parse(work_.read("stats.json"));
  }
  static bool is_early(const nlohmann::json& stats) {
    return stats["first_block_read_points"] < stats["points"].get<std::uint64_t>() / 2;
  }

  /// Makes the header of a file tell another number; `place` is that of the specification.
  void lie(const std::string& name, std::size_t place, double value) {
    std::string bytes = work_.read(name);
    std::memcpy(bytes.data() + place, &value, sizeof value);
    work_.write(name, bytes);
  }
  [[nodiscard]] bool same(const std::string& a, const std::string& b) const {
    return work_.read(a) == work_.read(b);
  }

  Workspace work_;
  Result messages_;
};

/// Where a LAS header has the largest x, and the least y.
constexpr std::size_t kMostX = 179;
constexpr std::size_t kLeastY = 203;

TEST_F(DemOfASurvey, IsPaintedEarlyAndEqualsThatOfOneFile) {
  for (const std::string options :
       {"--cog", "--product slope,facet-aspect,height,hillshade", "--product height,density",
        "--product height,count,max,p90", "--align", "--max-edge 5",
        "--bounds 500000,4100000,500250,4100300"}) {
    // Which of several points with equal x and y comes first is up to the files.
    const std::string all = " --heights lowest " + options;
    EXPECT_FALSE(is_early(make("one.tif", "all.las" + all)));
    EXPECT_TRUE(is_early(make("early.tif", "t_*.las --memory 64M" + all))) << options;
    EXPECT_FALSE(is_early(make("late.tif", "$(ls -r t_*.las) --no-trust-headers" + all)));
    EXPECT_TRUE(same("early.tif", "one.tif")) << options;
    EXPECT_TRUE(same("late.tif", "one.tif")) << options;
  }
}

TEST_F(DemOfASurvey, ClosesTilesOfPixelsBeforeAllTrianglesHaveCome) {
  EXPECT_GT(make("dem.tif", "t_*.las")["raster"]["closed_tiles"], 0);
  EXPECT_GT(make("dem.tif", "all.las")["raster"]["closed_tiles"], 0);
  EXPECT_EQ(make("dem.tif", "t_*.las --product density")["raster"]["closed_tiles"], 0);
  work_.succeed("spillway triangulate -q all.las -o tin.spm");
  work_.succeed("spillway dem -q tin.spm -o mesh.tif --resolution 0.25 --stats stats.json");
  EXPECT_EQ(nlohmann::json::parse(work_.read("stats.json"))["raster"]["closed_tiles"], 0)
      << "triangles of a mesh may overlap";
}

TEST_F(DemOfASurvey, PointsMissingInACornerHaveNoData) {
  work_.succeed("rm t_00_*.las t_01_00.las t_06_06.las");
  const nlohmann::json early = make("early.tif", "t_*.las");
  make("late.tif", "t_*.las --no-trust-headers");
  EXPECT_TRUE(is_early(early));
  EXPECT_TRUE(same("early.tif", "late.tif"));
  EXPECT_LT(early["raster"]["pixels_with_data"],
            early["raster"]["columns"].get<int>() * early["raster"]["rows"].get<int>());
}

/// The raster is that of the points, for which they are read again.
TEST_F(DemOfASurvey, BoxesThatAreTooLargeAreFoundOut) {
  const double least_y = work_.info("all.las")["extent"]["min"][1];
  make("true.tif", "t_*.las");
  EXPECT_EQ(messages_.err.find("read again"), std::string::npos);
  for (const auto& name : work_.names()) {
    if (name.starts_with("t_")) lie(name, kLeastY, least_y - 20);
  }
  const nlohmann::json stats = make("dem.tif", "t_*.las");
  EXPECT_THAT(messages_.err, HasSubstr("headers tell another extent"));
  EXPECT_EQ(stats["points"], 40'000);
  EXPECT_TRUE(same("dem.tif", "true.tif"));
  make("late.tif", "t_*.las --no-trust-headers");
  EXPECT_THAT(messages_.err, Not(HasSubstr("headers tell")));
  EXPECT_TRUE(same("late.tif", "true.tif"));
}

/// Also where the raster's place is given, so that it does not depend on headers.
TEST_F(DemOfASurvey, BoxesThatAreTooSmallAreFoundOut) {
  const nlohmann::json extent = work_.info("t_04_04.las")["extent"];
  const double least = extent["min"][0];
  const double most = extent["max"][0];
  for (const std::string options : {"", " --align", " --bounds 500000,4100000,500250,4100300",
                                    " --product height,density", " --product height,count,p50"}) {
    lie("t_04_04.las", kMostX, most);
    const nlohmann::json truth = make("true.tif", "t_*.las" + options);
    lie("t_04_04.las", kMostX, (least + most) / 2);
    const nlohmann::json again = make("dem.tif", "t_*.las" + options);
    EXPECT_THAT(messages_.err, HasSubstr("outside of the box that the header tells"));
    EXPECT_EQ(again["points"], 40'000);
    EXPECT_EQ(again["raster"]["pixels_with_data"], truth["raster"]["pixels_with_data"]);
    EXPECT_TRUE(same("dem.tif", "true.tif")) << options;
  }
}

/// Nothing is triangulated, so that no region is compared with its box: the extent is.
TEST_F(DemOfASurvey, PointsAloneAreReadAgainIfHeadersTellAnotherExtent) {
  const std::string dem = "spillway dem all.las --resolution 0.25 --product count,p50 -o ";
  const auto read_again = [&](const std::string& command) {
    const Result run = work_.run(command);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.err.find("headers tell another extent") != std::string::npos;
  };
  EXPECT_FALSE(read_again(dem + "true.tif"));
  const double most = work_.info("all.las")["extent"]["max"][0];
  for (const double told : {most + 20, most - 20}) {
    lie("all.las", kMostX, told);
    EXPECT_TRUE(read_again(dem + "dem.tif"));
    EXPECT_TRUE(same("dem.tif", "true.tif"));
    EXPECT_FALSE(read_again(dem + "late.tif --no-trust-headers"));
    EXPECT_TRUE(same("late.tif", "true.tif"));
  }
}

/// Far beyond what a raster may be: all is read first.
TEST_F(DemOfASurvey, AnAbsurdBoxIsNotTakenForTheRasters) {
  make("true.tif", "t_*.las");
  for (const double far : {1e6, 1e12, 1e300}) {
    lie("t_06_06.las", kMostX, far);
    make("dem.tif", "t_*.las");
    EXPECT_TRUE(same("dem.tif", "true.tif")) << far;
  }
}

TEST_F(DemOfASurvey, ABoxThatIsOffByARoundingMakesNoDifference) {
  make("true.tif", "t_*.las");
  const double most = work_.info("t_04_04.las")["extent"]["max"][0];
  for (const double off : {-0.009, -1e-9, 1e-9, 0.004}) {
    lie("t_04_04.las", kMostX, most + off);
    EXPECT_TRUE(is_early(make("dem.tif", "t_*.las")));
    EXPECT_TRUE(same("dem.tif", "true.tif")) << off;
  }
}

/// The raster's place depends on it, but it is not called false.
TEST_F(DemOfASurvey, ABoxAtTheRimThatIsAStepOffChangesNothing) {
  make("true.tif", "t_*.las");
  const double most = work_.info("all.las")["extent"]["max"][0];
  int at_the_rim = 0;
  for (const auto& name : work_.names()) {
    if (!name.starts_with("t_") || work_.info(name)["extent"]["max"][0] != most) continue;
    lie(name, kMostX, most - 0.01);
    ++at_the_rim;
  }
  EXPECT_GT(at_the_rim, 0);
  EXPECT_EQ(make("dem.tif", "t_*.las")["points"], 40'000);
  EXPECT_THAT(messages_.err, Not(HasSubstr("outside of the box")));
  EXPECT_TRUE(same("dem.tif", "true.tif"));
}

/// Points that are not used do not count for the extent.
TEST_F(DemOfASurvey, FiltersWaitForAllPoints) {
  const nlohmann::json early = make("early.tif", "t_*.las --keep-class 0");
  EXPECT_FALSE(is_early(early));
  make("late.tif", "t_*.las");
  EXPECT_TRUE(same("early.tif", "late.tif"));
}

TEST_F(DemOfASurvey, OfASortedStreamThroughAPipeIsEarly) {
  work_.succeed("spillway convert -q all.las --sorted -o sorted.spp");
  make("one.tif", "all.las");
  const nlohmann::json piped = make("piped.tif", "- < sorted.spp");
  EXPECT_TRUE(same("piped.tif", "one.tif"));
}

}  // namespace
}  // namespace spillway::test
