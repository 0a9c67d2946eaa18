// GeoPackages as other programs see them: their coordinate system, and layers that are replaced.

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class GeoPackage : public ::testing::Test {
 protected:
  GeoPackage() {
    GDALAllRegister();
    space_.write("in.txt", "0 0 1\n10 0 2\n0 10 3\n10 9 4\n");
  }

  /// A GeoPackage of layers without features.
  void make(const std::string& name, const std::vector<std::string>& layers) const {
    const std::string path = space_.folder() / name;
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    const GDALDatasetUniquePtr file(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    for (const std::string& layer : layers) {
      ASSERT_NE(file->CreateLayer(layer.c_str(), nullptr, wkbPoint, nullptr), nullptr);
    }
  }

  /// The first column of what a query finds.
  [[nodiscard]] std::vector<std::string> query(const std::string& name,
                                               const std::string& sql) const {
    const std::string path = space_.folder() / name;
    const GDALDatasetUniquePtr file(
        GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr));
    OGRLayer* const rows = file->ExecuteSQL(sql.c_str(), nullptr, nullptr);
    std::vector<std::string> values;
    for (const OGRFeatureUniquePtr& row : *rows) values.emplace_back(row->GetFieldAsString(0));
    file->ReleaseResultSet(rows);
    return values;
  }

  Workspace space_;
};

TEST_F(GeoPackage, WithoutACoordinateSystemItIsUndefinedAndCartesian) {
  space_.succeed(
      "spillway triangulate -q in.txt -o mesh.gpkg\n"
      "spillway contour -q in.txt --interval 1 -o lines.gpkg");
  for (const std::string name : {"mesh.gpkg", "lines.gpkg"}) {
    EXPECT_THAT(query(name, "SELECT srs_id FROM gpkg_contents"), ElementsAre("-1")) << name;
    EXPECT_THAT(query(name, "SELECT srs_id FROM gpkg_geometry_columns"), ElementsAre("-1")) << name;
  }
  EXPECT_TRUE(space_.info("mesh.gpkg")["crs"].is_null());
  space_.succeed("spillway triangulate -q in.txt --crs EPSG:25833 -o known.gpkg");
  EXPECT_THAT(query("known.gpkg", "SELECT srs_id FROM gpkg_contents"), ElementsAre("25833"));
}

TEST_F(GeoPackage, ReplacingOneNamesTheOtherLayersThatAreLost) {
  for (const std::string command : {"triangulate", "contour --interval 1"}) {
    make("out.gpkg", {"out", "lakes", "roads"});
    const std::string run = "spillway " + command + " in.txt -o out.gpkg";
    EXPECT_THAT(space_.run(run).err,
                HasSubstr("warning: out.gpkg is replaced as a whole: its other layers lakes, roads "
                          "are lost; name another file to keep them"))
        << command;
    const Result again = space_.run(run);
    EXPECT_EQ(again.exit_code, 0) << command;
    EXPECT_THAT(again.err, Not(HasSubstr("replaced"))) << command;
    space_.succeed("rm out.gpkg");
  }
  make("many.gpkg", {"a", "b", "c", "d", "e", "f", "g"});
  EXPECT_THAT(space_.run("spillway triangulate in.txt -o many.gpkg").err,
              HasSubstr("its other layers a, b, c, d, e and 2 more are lost"));
}

TEST_F(GeoPackage, WhatIsNoneIsReplacedWithoutAWord) {
  space_.write("out.gpkg", "SQLite format 3, but for the rest");
  const Result result = space_.run("spillway triangulate in.txt -o out.gpkg");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, Not(HasSubstr("replaced")));
}

}  // namespace
}  // namespace spillway::test
