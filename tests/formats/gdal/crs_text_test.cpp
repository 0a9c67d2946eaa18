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

}  // namespace
}  // namespace spillway::test
