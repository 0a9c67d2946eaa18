#include "formats/gdal/gdal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "src/error.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kUtm = "EPSG:32633";

// As another program writes it: ESRI's names, no codes.
constexpr const char* kUtmOfEsri =
    "PROJCS[\"WGS_1984_UTM_Zone_33N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID["
    "\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\","
    "0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\","
    "500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",15.0],PARAMETER["
    "\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";

TEST(GdalCrs, EqualSystemsAreTheSameHoweverWritten) {
  for (const char* const code : {"EPSG:2927", "EPSG:32633", "EPSG:4326", "EPSG:25832+5783"}) {
    const std::string wkt = gdal().crs_to_wkt(code);
    EXPECT_TRUE(gdal().same_crs(code, wkt)) << code;
    EXPECT_TRUE(gdal().same_crs(wkt, code)) << code;
  }
  EXPECT_TRUE(gdal().same_crs(kUtm, kUtmOfEsri));
  EXPECT_TRUE(
      gdal().same_crs("anything, as it is the same text", "anything, as it is the same text"));
}

TEST(GdalCrs, OtherZonesAndUnitsAreNotTheSame) {
  EXPECT_FALSE(gdal().same_crs("EPSG:32633", "EPSG:32632"));
  EXPECT_FALSE(gdal().same_crs("EPSG:2927", "EPSG:2856"));  // one projection in feet and metres
  EXPECT_FALSE(gdal().same_crs("EPSG:4326", "EPSG:32632"));
  EXPECT_FALSE(gdal().same_crs("EPSG:32632", kUtmOfEsri));
}

TEST(GdalCrs, HeightsCountOnlyWhereBothSystemsHaveThem) {
  EXPECT_TRUE(gdal().same_crs("EPSG:25832+5783", "EPSG:25832"));
  EXPECT_TRUE(gdal().same_crs("EPSG:25832", gdal().crs_to_wkt("EPSG:25832+5783")));
  EXPECT_FALSE(gdal().same_crs("EPSG:25832+5783", "EPSG:25832+7837"));
  EXPECT_FALSE(gdal().same_crs("EPSG:25833+5783", "EPSG:25832"));
}

TEST(GdalCrs, WktIsVersion1InOneLine) {
  const std::string wkt = gdal().crs_to_wkt("EPSG:2927");
  EXPECT_THAT(wkt, StartsWith("PROJCS[\"NAD83(HARN) / Washington South (ftUS)\""));
  EXPECT_THAT(wkt, HasSubstr("AUTHORITY[\"EPSG\",\"2927\"]"));
  EXPECT_THAT(wkt, Not(HasSubstr("\n")));
  EXPECT_THAT(gdal().crs_to_wkt("EPSG:25832+5783"), StartsWith("COMPD_CS["));
}

TEST(GdalCrs, NamesHaveTheCodeWhereThereIsOne) {
  EXPECT_EQ(gdal().crs_name("EPSG:2927"), "EPSG:2927 (NAD83(HARN) / Washington South (ftUS))");
  EXPECT_EQ(gdal().crs_name(kUtmOfEsri), "WGS 84 / UTM zone 33N");
}

TEST(GdalCrs, UnitsAreInMetres) {
  EXPECT_EQ(gdal().crs_unit(kUtm), 1);
  EXPECT_NEAR(gdal().crs_unit("EPSG:2927"), 1200.0 / 3937, 1e-12);
  EXPECT_EQ(gdal().crs_unit("EPSG:4326"), 0);
}

TEST(GdalCrs, HeightsHaveTheirOwnUnit) {
  EXPECT_EQ(gdal().crs_units(kUtm).vertical, 0) << "not told";
  EXPECT_EQ(gdal().crs_units("EPSG:25832+5783").vertical, 1);
  EXPECT_NEAR(gdal().crs_units("EPSG:26918+6360").vertical, 1200.0 / 3937, 1e-12);
  EXPECT_EQ(gdal().crs_units("EPSG:26918+6360").horizontal, 1);
  EXPECT_NEAR(gdal().crs_units("EPSG:2927+5703").horizontal, 1200.0 / 3937, 1e-12);
}

TEST(GdalCrs, AnglesAreInDegrees) {
  const CrsUnits units = gdal().crs_units("EPSG:4326");
  EXPECT_TRUE(units.is_geographic);
  EXPECT_NEAR(units.horizontal, 1, 1e-12);
  EXPECT_EQ(units.semi_major, 6378137);
  EXPECT_NEAR(units.flattening, 1 / 298.257223563, 1e-15);
  EXPECT_NEAR(gdal().crs_units("EPSG:4807").horizontal, 0.9, 1e-12) << "grads, from Paris";
  EXPECT_EQ(gdal().crs_units("EPSG:4979").vertical, 1);
  EXPECT_FALSE(gdal().crs_units(kUtm).is_geographic);
}

TEST(GdalCrs, LongitudeAndLatitudeFollowFromPlacesOnTheEarthOnly) {
  for (const char* const crs : {"EPSG:4326", "EPSG:2927", "EPSG:25832+5783", kUtmOfEsri}) {
    EXPECT_EQ(gdal().why_not_lonlat(crs), "") << crs;
  }
  EXPECT_NE(gdal().why_not_lonlat("LOCAL_CS[\"site\",UNIT[\"metre\",1]]"), "");
}

TEST(GdalCrs, NonsenseIsAnErrorInOneLine) {
  for (const char* const text :
       {"", "nonsense", "EPSG:999999", "PROJCS[\"a\"]", "/etc/passwd", "EPSG:2927+"}) {
    const std::string message = error_of([&] { static_cast<void>(gdal().crs_to_wkt(text)); });
    EXPECT_THAT(message, HasSubstr("is not a coordinate system")) << text;
    EXPECT_THAT(message, Not(HasSubstr("\n")));
  }
  EXPECT_THAT(error_of([&] { static_cast<void>(gdal().same_crs(kUtm, "nonsense")); }),
              HasSubstr("\"nonsense\" is not a coordinate system"));
}

}  // namespace
}  // namespace spillway::test
