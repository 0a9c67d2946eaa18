// What a glance tells of a text that is said to be a coordinate system.

#include "formats/gdal/crs_text.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

TEST(CrsText, WktIsAWordWithBracketsThatAreAllClosed) {
  for (const char* const wkt :
       {"PROJCS[\"a\"]", "COMPD_CS[\"a\",PROJCS[\"b]\"]]", "LOCAL_CS(\"a\")", "GEOGCRS[]"}) {
    EXPECT_TRUE(looks_like_wkt(wkt)) << wkt;
    EXPECT_TRUE(looks_like_crs(wkt)) << wkt;
  }
  for (const char* const text : {"", "''", "[]", "PROJCS", "PROJCS[\"a\"", "PROJCS[\"a]", "PROJCS]",
                                 "PROJCS[]]", "EPSG:25832", "1[2]"}) {
    EXPECT_FALSE(looks_like_wkt(text)) << text;
  }
}

TEST(CrsText, CodesAndProjTextMayBeSystems) {
  EXPECT_TRUE(looks_like_crs("EPSG:25832"));
  EXPECT_TRUE(looks_like_crs("EPSG:25832+5783"));
  EXPECT_TRUE(looks_like_crs("+proj=utm +zone=32"));
  for (const char* const text : {"", "''", "none", "25832", ":1", "PROJCS[\"a\""}) {
    EXPECT_FALSE(looks_like_crs(text)) << text;
  }
}

TEST(CrsText, CompoundWktHasHeights) {
  EXPECT_TRUE(is_compound_wkt("COMPD_CS[\"a\"]"));
  EXPECT_TRUE(is_compound_wkt("COMPOUNDCRS[\"a\"]"));
  EXPECT_FALSE(is_compound_wkt("PROJCS[\"COMPD_CS\"]"));
}

TEST(CrsText, TellsUnitsOfWkt) {
  const std::string plane =
      R"(PROJCS["UTM",GEOGCS["WGS 84",DATUM["D",SPHEROID["S",6378137,298.25]],PRIMEM["G",0],)"
      R"(UNIT["degree",0.0174532925]],PROJECTION["Transverse_Mercator"],UNIT["metre", 1]])";
  EXPECT_EQ(name_in_wkt(plane), "UTM");
  EXPECT_FALSE(units_in_wkt(plane).is_geographic);
  EXPECT_EQ(units_in_wkt(plane).vertical, 0);
  const CrsUnits both = units_in_wkt(
      R"(COMPD_CS["UTM + NAVD88",)" + plane +
      R"(,VERT_CS["NAVD88",VERT_DATUM["V",2005],UNIT["US survey foot",0.3048006096012192]]])");
  EXPECT_EQ(both.horizontal, 1);
  EXPECT_EQ(both.vertical, 0.3048006096012192);
  const CrsUnits second = units_in_wkt(
      R"(COMPOUNDCRS["c",PROJCRS["p",BASEGEOGCRS["b",ANGLEUNIT["degree",0.01745]],CS[Cartesian,2],)"
      R"(LENGTHUNIT["foot",0.3048]],VERTCRS["v",VDATUM["d"],CS[vertical,1],LENGTHUNIT["metre",1]]])");
  EXPECT_EQ(second.horizontal, 0.3048);
  EXPECT_EQ(second.vertical, 1);
  EXPECT_TRUE(units_in_wkt(R"(GEOGCS["WGS 84",UNIT["degree",0.01745]])").is_geographic);
  EXPECT_EQ(units_in_wkt("VERT_CS[").vertical, 0);
  EXPECT_EQ(name_in_wkt("PROJCS["), "");
}

TEST(CrsText, MayTellHeights) {
  EXPECT_TRUE(may_tell_heights("EPSG:32633+6360"));
  EXPECT_TRUE(may_tell_heights(R"(COMPD_CS["a",X["b"]])"));
  EXPECT_FALSE(may_tell_heights("EPSG:32633"));
  EXPECT_FALSE(may_tell_heights(R"(PROJCS["a + b",X["b"]])"));
}

}  // namespace
}  // namespace spillway::test
