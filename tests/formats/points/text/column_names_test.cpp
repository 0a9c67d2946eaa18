// Which columns names stand for, and which names leave doubts.

#include "formats/points/text/column_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

using Columns = std::array<int, 3>;
using Names = std::vector<std::string_view>;

/// The chosen columns of names that leave no doubt.
Columns plain(const Names& names) {
  const ColumnChoice choice = choose_columns(names);
  EXPECT_EQ(choice.fault, "") << listed(names);
  EXPECT_EQ(choice.notice, "") << listed(names);
  return choice.column;
}

/// Those of names that do.
Columns noted(const Names& names) {
  const ColumnChoice choice = choose_columns(names);
  EXPECT_EQ(choice.fault, "") << listed(names);
  EXPECT_NE(choice.notice, "") << listed(names);
  return choice.column;
}

std::string fault(const Names& names) { return choose_columns(names).fault; }

TEST(ColumnNames, ExactNames) {
  EXPECT_EQ(plain({"x", "y", "z"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"N", "E", "Z"}), (Columns{1, 0, 2}));
  EXPECT_EQ(plain({"lat", "lng", "alt"}), (Columns{1, 0, 2}));
  EXPECT_EQ(plain({"id", "Northing", "EASTING", "Elev"}), (Columns{2, 1, 3}));
  EXPECT_EQ(plain({"long", "latitude", "h"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"Lon", "Lat", "elevation"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"longitude", "lat", "altitude"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"x", "y"}), (Columns{0, 1, -1}));
}

TEST(ColumnNames, GermanNames) {
  EXPECT_EQ(plain({"Hoch", "Rechts", "Hoehe"}), (Columns{1, 0, 2}));
  EXPECT_EQ(plain({"Rechtswert", "Hochwert", "H\xc3\xb6he"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"RECHTSWERT", "HOCHWERT", "H\xc3\x96HE"}), (Columns{0, 1, 2}));
  EXPECT_EQ(plain({"RW", "HW", "H\xf6he [m]"}), (Columns{0, 1, 2}));
}

TEST(ColumnNames, Units) {
  for (const std::string unit :
       {" [m]", "(m)", "_m", " m", " ft", "_ft", " (US ft)", "[\xc2\xb0]"}) {
    const std::string x = "X" + unit;
    const std::string y = "y" + unit;
    const std::string z = "Elev" + unit;
    EXPECT_EQ(plain({"code", x, y, z}), (Columns{1, 2, 3})) << unit;
  }
  EXPECT_EQ(plain({"pid", "easting_m", "northing_m", "z"}), (Columns{1, 2, 3}));
  EXPECT_EQ(plain({"id", "x", "y", "elev_m"}), (Columns{1, 2, 3}));
}

TEST(ColumnNames, DecoratedNamesAreTakenWithANotice) {
  EXPECT_EQ(noted({"pid", "X_UTM", "Y_UTM", "Elev_m"}), (Columns{1, 2, 3}));
  EXPECT_EQ(noted({"UTM_X", "UTM_Y", "UTM_Z"}), (Columns{0, 1, 2}));
  EXPECT_EQ(noted({"POINT_X", "POINT_Y", "POINT_Z"}), (Columns{0, 1, 2}));
  EXPECT_EQ(noted({"coord_y", "coord_x", "gps_z"}), (Columns{1, 0, 2}));
  EXPECT_EQ(noted({"PointX", "PointY", "PointZ"}), (Columns{0, 1, 2}));
  EXPECT_EQ(noted({"xcoord", "ycoord", "zcoord"}), (Columns{0, 1, 2}));
  EXPECT_EQ(noted({"X (UTM 32N)", "Y (UTM 32N)", "Ellipsoidal height [m]"}), (Columns{0, 1, 2}));
  EXPECT_EQ(noted({"x_25832", "y_25832", "z"}), (Columns{0, 1, 2}));
  EXPECT_THAT(choose_columns(Names{"id", "X_UTM", "Y_UTM", "h"}).notice,
              HasSubstr("column 2 (\"X_UTM\") is taken for x, column 3 (\"Y_UTM\") is taken for y, "
                        "column 4 (\"h\") is taken for z"));
}

TEST(ColumnNames, ExactNamesGoFirst) {
  EXPECT_EQ(plain({"normal_x", "x", "y", "z", "normal_y", "vx", "x2"}), (Columns{1, 2, 3}));
  EXPECT_EQ(plain({"utm_x", "x", "y", "utm_y", "z"}), (Columns{1, 2, 4}));
  EXPECT_EQ(noted({"lon", "lat", "x", "y", "z"}), (Columns{2, 3, 4}));
  EXPECT_EQ(noted({"x", "y", "height", "z"}), (Columns{0, 1, 3}));
  EXPECT_EQ(plain({"x", "y", "z", "n", "id"}), (Columns{0, 1, 2}));
}

TEST(ColumnNames, TwoOfAKindAreAFault) {
  EXPECT_EQ(fault({"x", "y", "z", "X"}), "the columns 1 (\"x\") and 4 (\"X\") may both be x");
  EXPECT_EQ(fault({"x", "y", "elev", "Elev"}),
            "the columns 3 (\"elev\") and 4 (\"Elev\") may both be z");
  EXPECT_THAT(fault({"x", "y", "ellipsoidal height", "orthometric height"}),
              HasSubstr("may both be z"));
  EXPECT_THAT(fault({"utm_x", "gps_x", "utm_y", "gps_y"}), HasSubstr("may both be x"));
}

TEST(ColumnNames, OfDifferentNamesOfHeightsTheFirstOfAFixedOrderIsTaken) {
  const Names order = {"z", "elevation", "elev", "altitude", "alt", "height", "hoehe", "h"};
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    EXPECT_EQ(noted({"x", "y", order[i], order[i + 1]}), (Columns{0, 1, 2})) << order[i];
    EXPECT_EQ(noted({"x", "y", order[i + 1], order[i]}), (Columns{0, 1, 3})) << order[i];
  }
  EXPECT_THAT(choose_columns(Names{"x", "y", "height", "elevation"}).notice,
              HasSubstr("column 4 (\"elevation\") is taken for z"));
}

TEST(ColumnNames, KnownOnesAreCounted) {
  EXPECT_EQ(choose_columns(Names{"id", "x", "y", "z", "GPS Time", "foo"}).known, 5);
  EXPECT_EQ(choose_columns(Names{"x", "and", "y", "of", "the", "survey"}).known, 2);
}

TEST(ColumnNames, MissingAxes) {
  EXPECT_EQ(fault({"id", "y", "z"}), "no column is named as x");
  EXPECT_EQ(fault({"E", "Z"}), "no column is named as y");
  EXPECT_EQ(fault({"pid", "foo", "bar"}), "no columns are named as x and y");
  EXPECT_EQ(fault({"x", "northing", "z"}), "no column is named as x and another one as its y");
  EXPECT_NE(fault({}), "");
}

TEST(ColumnNames, OtherQuantitiesAreNoCoordinates) {
  for (const std::string_view name : {"normal_x", "dx", "vx", "x_std", "x2", "max_x", "xy", "point",
                                      "pointe", "box", "ex", "next", "x axis length", ""}) {
    EXPECT_NE(fault({name, "y", "z"}), "") << name;
  }
}

TEST(ColumnNames, AMissingHeightIsNoted) {
  EXPECT_EQ(noted({"x", "y", "intensity"}), (Columns{0, 1, -1}));
  EXPECT_THAT(choose_columns(Names{"x", "y", "intensity"}).notice,
              HasSubstr("none of \"x\", \"y\", \"intensity\" is named as z: the points have no z"));
}

TEST(ColumnNames, LongListsAreCut) {
  EXPECT_EQ(listed(Names{"a", "b"}), "\"a\", \"b\"");
  EXPECT_THAT(listed(Names(20, "a")), HasSubstr("\"a\", ..."));
}

}  // namespace
}  // namespace spillway::test
