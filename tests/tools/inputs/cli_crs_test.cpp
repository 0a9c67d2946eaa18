// Coordinate systems of LAS files: what their GeoTIFF keys tell for certain goes along, what they
// do not is none and is said, and what is written says what was read.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::detail::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Keys = std::vector<std::array<std::uint16_t, 4>>;

const Keys kGeocentricOfAGeographic = {{1025, 0, 1, 2}, {1024, 0, 1, 3}, {2048, 0, 1, 4326}};

/// A LAS file with GeoTIFF keys.
std::string las_with(const Keys& keys) {
  testing::LasFile las = scattered_las(0, 50);
  std::string directory = testing::bytes_of(
      std::array<std::uint16_t, 4>{1, 1, 0, static_cast<std::uint16_t>(keys.size())});
  for (const auto& key : keys) directory += testing::bytes_of(key);
  las.vlrs = {{"LASF_Projection", 34735, directory}};
  return las.bytes();
}

template <typename T>
T field(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

/// The value of a key in the first record of a LAS 1.2 file, which has them; -1 if it is not there.
int key_of(const std::string& las, std::uint16_t key) {
  const auto count = field<std::uint16_t>(las, 227 + 54 + 6);
  for (std::size_t i = 1; i <= count; ++i) {
    const auto entry = field<std::array<std::uint16_t, 4>>(las, 227 + 54 + 8 * i);
    if (entry[0] == key) return entry[3];
  }
  return -1;
}

TEST(CoordinateSystems, OfEveryModelAreWrittenAsTheyWereRead) {
  struct Case {
    Keys keys;
    std::string crs;
    int model;
    int key;
    int code;
  };
  const std::vector<Case> cases = {
      {{{1024, 0, 1, 1}, {2048, 0, 1, 4258}, {3072, 0, 1, 25832}}, "EPSG:25832", 1, 3072, 25832},
      {{{1024, 0, 1, 2}, {2048, 0, 1, 4326}}, "EPSG:4326", 2, 2048, 4326},
      {{{1024, 0, 1, 2}, {2048, 0, 1, 7844}}, "EPSG:7844", 2, 2048, 7844},
      {{{1024, 0, 1, 3}, {2048, 0, 1, 4978}}, "EPSG:4978", 3, 2048, 4978},
      {{{1024, 0, 1, 0}, {3072, 0, 1, 2154}}, "EPSG:2154", 1, 3072, 2154},
      {{{1024, 0, 1, 32767}, {3072, 0, 1, 2154}}, "EPSG:2154", 1, 3072, 2154},
      {{{3072, 0, 1, 2154}}, "EPSG:2154", 1, 3072, 2154}};
  const Workspace work;
  for (const Case& one : cases) {
    SCOPED_TRACE(one.crs);
    work.write("in.las", las_with(one.keys));
    EXPECT_EQ(work.info("in.las")["crs"], one.crs);
    EXPECT_TRUE(work.info("in.las")["crs_note"].is_null());
    work.succeed(
        "spillway convert -q in.las -o old.las --las-version 1.2\n"
        "spillway convert -q in.las -o new.las --las-version 1.4\n"
        "spillway convert -q new.las -o back.las --las-version 1.2");
    EXPECT_EQ(work.info("old.las")["crs"], one.crs);
    for (const char* const name : {"old.las", "back.las"}) {
      const std::string las = work.read(name);
      EXPECT_EQ(key_of(las, 1024), one.model) << name;
      EXPECT_EQ(key_of(las, one.key), one.code) << name;
    }
    // One system, however it is written.
    const Result result = work.run("spillway triangulate in.las old.las new.las back.las -o a.spm");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Not(HasSubstr("warning")));
  }
}

TEST(CoordinateSystems, ThatCannotBeToldAreNoneWithANotice) {
  const Workspace work;
  const std::vector<Keys> cases = {kGeocentricOfAGeographic,
                                   {{1024, 0, 1, 1}, {2048, 0, 1, 4326}, {3072, 0, 1, 32767}},
                                   {{1024, 0, 1, 0}, {2048, 0, 1, 4326}},
                                   {{1024, 0, 1, 2}, {2048, 0, 1, 4326}, {3072, 0, 1, 25832}}};
  for (const Keys& keys : cases) {
    work.write("in.las", las_with(keys));
    const Result result = work.run("spillway triangulate in.las -o a.ply");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("warning: in.las: taken to have no coordinate system"));
    EXPECT_TRUE(work.info("a.ply")["crs"].is_null());
    const auto info = work.info("in.las");
    EXPECT_TRUE(info["crs"].is_null());
    EXPECT_FALSE(info["crs_note"].is_null());
    EXPECT_THAT(work.succeed("spillway info -q in.las"), HasSubstr("crs_note"));
    EXPECT_EQ(work.run("spillway convert -q in.las -o out.las").err, "");
    EXPECT_TRUE(work.info("out.las")["crs"].is_null());
    EXPECT_TRUE(work.info("out.las")["crs_note"].is_null());
  }
}

TEST(CoordinateSystems, OfManyFilesThatCannotBeToldAreSaidOnce) {
  const Workspace work;
  work.write("a.las", las_with(kGeocentricOfAGeographic));
  work.write("b.las", las_with(kGeocentricOfAGeographic));
  const Result result = work.run("spillway triangulate a.las b.las -o a.spm");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning: a.las (and 1 more): taken to have no"));
  EXPECT_THAT(result.err, Not(HasSubstr("b.las")));
}

TEST(CoordinateSystems, OfHeightsAreToldByInfo) {
  const Workspace work;
  work.write("in.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 5783}}));
  EXPECT_EQ(work.info("in.las")["crs"], "EPSG:25832");
  EXPECT_THAT(work.info("in.las")["crs_note"].get<std::string>(), HasSubstr("EPSG:5783"));
  EXPECT_THAT(work.run("spillway triangulate in.las -o a.spm").err, Not(HasSubstr("heights")));
}

TEST(CoordinateSystems, OfAFileWithGeocentricKeysFitItsCopcVersion) {
  // As PDAL writes the same keys into the WKT of a COPC file.
  const std::string wkt =
      "GEOCCS[\"unnamed\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,"
      "AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0],"
      "UNIT[\"metre\",1],AXIS[\"Geocentric X\",OTHER],AXIS[\"Geocentric Y\",OTHER],"
      "AXIS[\"Geocentric Z\",NORTH]]";
  const Workspace work;
  testing::LasFile las = scattered_las(50, 50);
  las.vlrs = {{"LASF_Projection", 2112, wkt}};
  work.write("wkt.las", las.bytes());
  work.write("keys.las", las_with(kGeocentricOfAGeographic));
  for (const char* const inputs : {"keys.las wkt.las", "wkt.las keys.las"}) {
    const Result result = work.run(fmt::format("spillway triangulate {} -o a.ply", inputs));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(work.info("a.ply")["crs"], wkt);
    EXPECT_THAT(result.err, HasSubstr("warning: keys.las: taken to have the coordinate system of "
                                      "wkt.las: its GeoTIFF keys say"));
    EXPECT_THAT(result.err, Not(HasSubstr("no coordinate system")));
  }
}

TEST(CoordinateSystems, OfCommonCodesAreWrittenWithoutTheModule) {
  const Workspace work;
  work.succeed("cp '" + command_path() + "' alone");
  const std::vector<std::pair<int, int>> codes = {{1, 3857}, {1, 6339}, {1, 6350}, {2, 6318},
                                                  {2, 4167}, {2, 4617}, {3, 4978}, {1, 32633}};
  for (const auto& [model, code] : codes) {
    const std::uint16_t key = model == 1 ? 3072 : 2048;
    work.write("in.las", las_with({{1024, 0, 1, static_cast<std::uint16_t>(model)},
                                   {key, 0, 1, static_cast<std::uint16_t>(code)}}));
    const Result result = work.run("./alone convert -q in.las -o out.las --las-version 1.2");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const std::string las = work.read("out.las");
    EXPECT_EQ(key_of(las, 1024), model) << code;
    EXPECT_EQ(key_of(las, key), code);
  }
  // Of others nothing is guessed.
  work.write("in.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 9141}}));
  const Result result = work.run("./alone convert -q in.las -o other.las --las-version 1.2");
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("write spp"));
}

TEST(CoordinateSystems, OfRealFiles) {
  const std::string geocentric = shared_file("lone-star.laz");
  const std::string feet = shared_file("mvk-thin.las");
  if (geocentric.empty() || feet.empty()) GTEST_SKIP() << "no samples in " << shared_data_folder();
  const Workspace work;
  EXPECT_THAT(work.info(geocentric)["crs_note"].get<std::string>(), HasSubstr("geocentric"));
  EXPECT_THAT(work.info(feet)["crs_note"].get<std::string>(), HasSubstr("lengths in another unit"));
  EXPECT_EQ(work.info(shared_file("4_6_crop.las"))["crs"], "EPSG:2903");
}

}  // namespace
}  // namespace spillway::detail::test
