// Coordinate systems of LAS files: what their GeoTIFF keys tell for certain goes along, what they
// do not is none and is said, and what is written says what was read.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Keys = std::vector<std::array<std::uint16_t, 4>>;

const Keys kGeocentricOfAGeographic = {{1025, 0, 1, 2}, {1024, 0, 1, 3}, {2048, 0, 1, 4326}};

/// The record of these keys.
LasFile::Vlr record_of(const Keys& keys) {
  std::string directory =
      bytes_of(std::array<std::uint16_t, 4>{1, 1, 0, static_cast<std::uint16_t>(keys.size())});
  for (const auto& key : keys) directory += bytes_of(key);
  return {"LASF_Projection", 34735, directory};
}

/// A LAS file with these records.
std::string las_with_records(const std::vector<LasFile::Vlr>& records) {
  LasFile las = scattered_las(0, 50);
  las.vlrs = records;
  return las.bytes();
}

/// A LAS file with GeoTIFF keys.
std::string las_with(const Keys& keys) { return las_with_records({record_of(keys)}); }

const LasFile::Vlr kNoWkt = {"LASF_Projection", 2112, "''"};
const LasFile::Vlr kBrokenWkt = {"LASF_Projection", 2112, "PROJCS[\"none such\",FOO[1]]"};

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
    EXPECT_EQ(work.read("old.las").substr(227, 54), work.read("in.las").substr(227, 54))
        << "records stay as they are";
    EXPECT_EQ(key_of(work.read("back.las"), 1024), one.model);
    EXPECT_EQ(key_of(work.read("back.las"), one.key), one.code);
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
    EXPECT_FALSE(work.info("out.las")["crs_note"].is_null()) << "records stay as they are";
    work.succeed("spillway convert -q in.las -o out.las --las-version 1.4");
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
  LasFile las = scattered_las(50, 50);
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
  work.write("in.xyz", "1 2 3\n");
  const Result result = work.run("./alone convert -q in.xyz --crs EPSG:9141 -o other.las");
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("need the module spillway_gdal.so"));
}

TEST(CoordinateSystems, TheModuleForGdalOfAnotherVersionIsRefused) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("in.xyz", "1 2 3\n4 5 6\n7 9 8\n");
  const std::string folder =
      (std::filesystem::path(command_path()).parent_path() / "other_version").string();
  const Result result =
      work.run("SPILLWAY_MODULES=" + folder + " spillway dem -q in.xyz -o out.tif --resolution 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("other_version/spillway_gdal.so is of another version of "
                                    "Spillway: 0.0.1, where "));
  EXPECT_FALSE(work.has("out.tif"));
}

/// Whether a run of the command opens GDAL's module.
bool loads_gdal(const Workspace& work, const std::string& command) {
  // Its name is sought for in this folder first, where it cannot be loaded.
  work.write("spillway_gdal.so", "");
  const bool fails = work.run("SPILLWAY_MODULES=. spillway " + command).exit_code != 0;
  work.succeed("rm spillway_gdal.so");
  return fails;
}

TEST(CoordinateSystems, ThatCannotBeReadEndNoRun) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("plain.las", las_with_records({kNoWkt}));
  work.write("broken.las", las_with_records({kBrokenWkt}));
  for (const std::string name : {"plain", "broken"}) {
    for (const std::string output :
         {"dem {}.las -o a.tif --resolution 100", "contour {}.las -o a.gpkg --interval 1",
          "triangulate {}.las -o a.landxml", "triangulate {}.las -o a.gpkg",
          "triangulate {}.las -o a.shp"}) {
      const Result result = work.run("spillway " + fmt::format(fmt::runtime(output), name));
      EXPECT_EQ(result.exit_code, 0) << output << result.err;
      EXPECT_THAT(result.err, HasSubstr(fmt::format("warning: {}.las: taken to have no coordinate "
                                                    "system: what it tells of its coordinate "
                                                    "system cannot be read: \"",
                                                    name)));
    }
    work.succeed("spillway convert -q " + name + ".las -o out.las");
    work.succeed("spillway triangulate -q " + name + ".las -o a.spm");
    const Result of_mesh = work.run("spillway dem a.spm -o a.tif --resolution 100");
    EXPECT_EQ(of_mesh.exit_code, 0) << of_mesh.err;
  }
}

TEST(CoordinateSystems, OfKeysStandInForThoseThatCannotBeRead) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  for (const auto& wkt : {kNoWkt, kBrokenWkt}) {
    work.write("in.las",
               las_with_records({wkt, record_of({{1024, 0, 1, 1}, {3072, 0, 1, 25832}})}));
    const Result result = work.run("spillway triangulate in.las -o a.landxml");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Not(HasSubstr("warning")));
    EXPECT_EQ(work.info("a.landxml")["crs"], "EPSG:25832");
  }
}

TEST(CoordinateSystems, AreNotLookedAtWhereNoOutputNeedsThem) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  const Keys heights = {{1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 5783}};
  const std::vector<std::vector<LasFile::Vlr>> files = {
      {kNoWkt},
      {kBrokenWkt},
      {kBrokenWkt, record_of({{1024, 0, 1, 1}, {3072, 0, 1, 32767}})},
      {record_of(heights)}};
  for (const auto& records : files) {
    work.write("in.las", las_with_records(records));
    EXPECT_FALSE(loads_gdal(work, "triangulate in.las -o a.spm"));
    EXPECT_FALSE(loads_gdal(work, "info in.las"));
  }
  EXPECT_TRUE(loads_gdal(work, "dem in.las -o a.tif --resolution 100"));
}

TEST(CoordinateSystems, OfTheirOwnAreReadFromKeys) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  std::string numbers;
  for (const double number : {9.0, 0.0, 0.9996, 500000.0, 0.0}) numbers += bytes_of(number);
  work.write("in.las", las_with_records({record_of({{1024, 0, 1, 1},
                                                    {2048, 0, 1, 4258},
                                                    {3072, 0, 1, 32767},
                                                    {3074, 0, 1, 32767},
                                                    {3075, 0, 1, 1},
                                                    {3076, 0, 1, 9001},
                                                    {3080, 34736, 1, 0},
                                                    {3081, 34736, 1, 1},
                                                    {3082, 34736, 1, 3},
                                                    {3083, 34736, 1, 4},
                                                    {3092, 34736, 1, 2}}),
                                         {"LASF_Projection", 34736, numbers}}));
  EXPECT_THAT(work.info("in.las")["crs"].get<std::string>(), HasSubstr("Transverse_Mercator"));
  EXPECT_TRUE(work.info("in.las")["crs_note"].is_null());
  // It is the same as EPSG's.
  work.write("other.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 25832}}));
  const Result result = work.run("spillway triangulate in.las other.las -o a.spm");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("warning")));
  work.succeed("spillway convert -q in.las -o out.las");
  EXPECT_EQ(work.info("out.las")["crs"], work.info("in.las")["crs"]);
}

TEST(CoordinateSystems, OfHeightsGoIntoOutputsOfGdalAndIntoLas) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("in.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 26918}, {4096, 0, 1, 6360}}));
  for (const std::string version : {"1.2", "1.4"}) {
    work.succeed("spillway convert -q in.las -o out.las --las-version " + version);
    EXPECT_THAT(work.info("out.las")["crs"].get<std::string>(),
                AllOf(HasSubstr("COMPD_CS"), HasSubstr("NAVD88 height (ftUS)")));
  }
}

TEST(GivenCrs, IsThatOfInputsThatNameNone) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("in.txt", "0 0 1\n9 0 2\n0 9 3\n9 9 5\n");
  work.write("in.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 25832}}));
  const auto crs_of = [&](const std::string& how, const std::string& output) {
    const Result result = work.run("spillway " + how + " -o " + output);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Not(HasSubstr("warning"))) << how;
    return work.info(output)["crs"];
  };
  EXPECT_EQ(crs_of("triangulate in.txt --crs EPSG:25832", "a.spm"), "EPSG:25832");
  EXPECT_EQ(crs_of("triangulate in.txt in.las --crs EPSG:25832", "a.spm"), "EPSG:25832");
  EXPECT_EQ(crs_of("convert in.txt --crs EPSG:25832", "a.spp"), "EPSG:25832");
  work.succeed("spillway triangulate -q in.txt -o bare.spm");
  EXPECT_EQ(crs_of("convert bare.spm --crs EPSG:25832", "a.ply"), "EPSG:25832");
  work.succeed("spillway batch -q in.txt --to spm --output-dir out --crs EPSG:25832");
  EXPECT_EQ(work.info("out/in.spm")["crs"], "EPSG:25832");
  work.succeed("spillway render -q in.txt -o a.png --crs EPSG:25832");
  // As other programs write it: on lines, in the words of ESRI.
  work.write("in.prj",
             "PROJCS[\"ETRS_1989_UTM_Zone_32N\",\n GEOGCS[\"GCS_ETRS_1989\",DATUM["
             "\"D_ETRS_1989\",SPHEROID[\"GRS_1980\",6378137.0,298.257222101]],PRIMEM["
             "\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],\r\n PROJECTION["
             "\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],PARAMETER["
             "\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",9.0],PARAMETER["
             "\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\","
             "1.0]]\n");
  const auto of_file = crs_of("triangulate in.txt --crs in.prj", "a.spm");
  EXPECT_THAT(of_file.get<std::string>(), HasSubstr("Transverse_Mercator"));
  EXPECT_THAT(of_file.get<std::string>(), Not(HasSubstr("\n")));
  crs_of("triangulate in.txt in.las --crs in.prj", "a.spm");
}

TEST(GivenCrs, ReplacesThatOfInputsOnlyWhereItIsForced) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.write("in.las", las_with({{1024, 0, 1, 1}, {3072, 0, 1, 25832}}));
  work.succeed("spillway triangulate -q in.las -o in.spm");
  for (const std::string how :
       {"triangulate in.las -o a.spm", "dem in.las -o a.tif --resolution 100",
        "dem in.spm -o a.tif --resolution 100", "convert in.las -o a.spp",
        "convert in.spm -o a.ply", "contour in.spm -o a.gpkg --interval 1",
        "render in.las -o a.png"}) {
    const Result result = work.run("spillway " + how + " --crs EPSG:25833");
    EXPECT_EQ(result.exit_code, 1) << how;
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("has the coordinate system EPSG:25832 (ETRS89 / UTM zone 32N), but "
                                "EPSG:25833 (ETRS89 / UTM zone 33N) is given; leave that out, or"),
                      HasSubstr("with --force-crs")))
        << how;
    const Result forced = work.run("spillway " + how + " --crs EPSG:25833 --force-crs");
    EXPECT_EQ(forced.exit_code, 0) << how << forced.err;
    EXPECT_THAT(forced.err, HasSubstr("to be in EPSG:25833"));
  }
  EXPECT_EQ(work.info("a.spm")["crs"], "EPSG:25833");
  EXPECT_EQ(work.info("a.ply")["crs"], "EPSG:25833");
}

TEST(GivenCrs, ThatCannotBeReadIsAnErrorBeforeAnyWork) {
  const Workspace work;
  work.write("in.txt", "0 0 1\n9 0 2\n0 9 3\n9 9 5\n");
  work.write("no.prj", "nothing\n");
  const auto error_of = [&](const std::string& crs) {
    const Result result = work.run("spillway triangulate in.txt -o a.spm --crs '" + crs + "'");
    EXPECT_NE(result.exit_code, 0) << crs;
    EXPECT_THAT(result.err, Not(HasSubstr("points")));
    EXPECT_FALSE(work.has("a.spm"));
    return result.err;
  };
  EXPECT_THAT(error_of("nonsense"), HasSubstr("\"nonsense\" is no coordinate system; give EPSG:n"));
  EXPECT_THAT(error_of("no.prj"), HasSubstr("no.prj holds no WKT of a coordinate system"));
  if (build_lacks("GDAL")) return;
  EXPECT_THAT(error_of("EPSG:999999"), HasSubstr("\"EPSG:999999\" is not a coordinate system"));
  EXPECT_THAT(error_of("PROJCS[\"a\"]"), HasSubstr("is not a coordinate system"));
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
}  // namespace spillway::test
