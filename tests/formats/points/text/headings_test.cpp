// Sixty headings and rows as they come from total stations, scanners, spreadsheets and other
// programs, and what is read of each.

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "formats/inputs/open_points.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

struct Heading {
  const char* lines;              ///< the heading, if there is one, and a row
  std::optional<Point<3>> point;  ///< nothing: an error that says what to do
};

constexpr double kNone = 0;  // z, where there is none

const std::vector<Heading>& headings() {
  static const std::vector<Heading> all = {
      // Axes by their letters.
      {"x,y,z\n1,2,3\n", Point<3>{1, 2, 3}},
      {"X Y Z\n1 2 3\n", Point<3>{1, 2, 3}},
      {"X;Y;Z\n1;2;3\n", Point<3>{1, 2, 3}},
      {"x\ty\tz\n1\t2\t3\n", Point<3>{1, 2, 3}},
      {"y,x,z\n2,1,3\n", Point<3>{1, 2, 3}},
      {"z,y,x\n3,2,1\n", Point<3>{1, 2, 3}},
      {"id,x,y,z\n7,1,2,3\n", Point<3>{1, 2, 3}},
      {"x,y\n1,2\n", Point<3>{1, 2, kNone}},
      {"\"x\",\"y\",\"z\"\n1,2,3\n", Point<3>{1, 2, 3}},
      {"X [m],Y [m],Z [m]\n1,2,3\n", Point<3>{1, 2, 3}},
      {"X(m);Y(m);Z(m)\n1;2;3\n", Point<3>{1, 2, 3}},
      {"X_m,Y_m,Z_m\n1,2,3\n", Point<3>{1, 2, 3}},
      {"POINT_X,POINT_Y,POINT_Z\n1,2,3\n", Point<3>{1, 2, 3}},
      {"UTM_X,UTM_Y,Z\n1,2,3\n", Point<3>{1, 2, 3}},
      {"x,y,z,intensity,red,green,blue\n1,2,3,4,5,6,7\n", Point<3>{1, 2, 3}},
      {"X Y Z Intensity R G B\n1 2 3 4 5 6 7\n", Point<3>{1, 2, 3}},
      {"x y z nx ny nz\n1 2 3 0 0 1\n", Point<3>{1, 2, 3}},
      {"//X,Y,Z,Scalar field\n1,2,3,4\n", Point<3>{1, 2, 3}},
      {"# x y z\n1 2 3\n", Point<3>{1, 2, 3}},
      {"# y x z\n2 1 3\n", Point<3>{1, 2, 3}},
      {"% x y z\n1 2 3\n", Point<3>{1, 2, 3}},
      // Easting and northing.
      {"Easting,Northing,Elevation\n1,2,3\n", Point<3>{1, 2, 3}},
      {"Northing,Easting,Elevation\n2,1,3\n", Point<3>{1, 2, 3}},
      {"PointID,Northing,Easting,Elevation,Code\n101,2,1,3,TREE\n", Point<3>{1, 2, 3}},
      {"Point,N,E,Z,Description\n101,2,1,3,curb\n", Point<3>{1, 2, 3}},
      {"E,N,H\n1,2,3\n", Point<3>{1, 2, 3}},
      {"E N h\n1 2 3\n", Point<3>{1, 2, 3}},
      {"EASTING NORTHING HEIGHT\n1 2 3\n", Point<3>{1, 2, 3}},
      {"East,North,Elev\n1,2,3\n", Point<3>{1, 2, 3}},
      {"Pt No,Northing,Easting,RL,Code\n1,2,1,3,A\n", Point<3>{1, 2, 3}},
      {"easting;northing;altitude\n1,5;2,5;3,5\n", Point<3>{1.5, 2.5, 3.5}},
      // Other languages.
      {"Rechtswert;Hochwert;Höhe\n1;2;3\n", Point<3>{1, 2, 3}},
      {"Punktnummer;Rechtswert;Hochwert;Höhe\n12;1,5;2,5;3,5\n", Point<3>{1.5, 2.5, 3.5}},
      {"Rechts Hoch Hoehe\n1 2 3\n", Point<3>{1, 2, 3}},
      {"Ostwert;Nordwert;Hoehe\n1;2;3\n", Point<3>{1, 2, 3}},
      // Longitude and latitude.
      {"lon,lat,height\n1,2,3\n", Point<3>{1, 2, 3}},
      {"lat,lon\n2,1\n", Point<3>{1, 2, kNone}},
      {"Latitude,Longitude,Altitude\n2,1,3\n", Point<3>{1, 2, 3}},
      {"longitude;latitude;elevation\n1;2;3\n", Point<3>{1, 2, 3}},
      {"name,lat,lng,alt\na,2,1,3\n", Point<3>{1, 2, 3}},
      // Depths count downwards.
      {"x,y,depth\n1,2,3\n", Point<3>{1, 2, -3}},
      {"lon,lat,depth_m\n1,2,3\n", Point<3>{1, 2, -3}},
      {"Easting Northing Depth\n1 2 -3\n", Point<3>{1, 2, -3}},
      // Spreadsheets.
      {"\xef\xbb\xbfx;y;z\r\n1,25;2,25;3,25\r\n", Point<3>{1.25, 2.25, 3.25}},
      {"\"Point name\";\"X\";\"Y\";\"Z\"\n\"a;b\";1;2;3\n", Point<3>{1, 2, 3}},
      {"x,y,z,remark\n1,2,3,\"kerb, left\"\n", Point<3>{1, 2, 3}},
      {"x,y,z,\n1,2,3,\n", Point<3>{1, 2, 3}},
      {"x ; y ; z\n1 ; 2 ; 3\n", Point<3>{1, 2, 3}},
      // Without a heading.
      {"1 2 3\n", Point<3>{1, 2, 3}},
      {"1.5,2.5,3.5\n", Point<3>{1.5, 2.5, 3.5}},
      {"1,5 2,5 3,5\n", Point<3>{1.5, 2.5, 3.5}},
      {"1;2;3\n", Point<3>{1, 2, 3}},
      {"2\n1 2 3 4\n5 6 7 8\n", Point<3>{1, 2, 3}},  // PTS
      {"-1.5e3\t2E2\t.5\n", Point<3>{-1500, 200, 0.5}},
      // What cannot be told for sure.
      {"a,b,c\n1,2,3\n", std::nullopt},
      {"x,x,z\n1,2,3\n", std::nullopt},
      {"easting,lat,z\n1,2,3\n", std::nullopt},
      {"x,z\n1,3\n", std::nullopt},
      {"1,2,3,4\n", std::nullopt},
      {"101,5000.12,1000.34,55.1,TREE\n102,5001.12,1001.34,55.2,TREE\n103,5002.12,1002.34,55.3,X\n",
       std::nullopt},
  };
  return all;
}

TEST(Headings, AreSixty) { EXPECT_EQ(headings().size(), 60U); }

TEST(Headings, TellWhatIsRead) {
  for (const auto& [lines, point] : headings()) {
    if (!point) {
      EXPECT_NE(error_of([&] { read_content("a.txt", lines); }), "") << lines;
      continue;
    }
    const AllPoints all = read_content("a.txt", lines);
    ASSERT_GE(all.points.size(), 1U) << lines;
    EXPECT_EQ(all.points.front().numbers(), *point) << lines;
  }
}

/// What is said goes before what the text shows.
TEST(SaidLayout, GoesBeforeWhatTheTextShows) {
  const auto read = [](const TextLayout& layout, const std::string& content) {
    PointReaderOptions options;
    options.text = layout;
    const AllPoints all = read_content("a.txt", content, options);
    return all.points.empty() ? Point<3>{} : all.points.front().numbers();
  };
  EXPECT_EQ(read({.skip_lines = 2}, "total station\n5 6 7\n1 2 3\n"), (Point<3>{1, 2, 3}));
  EXPECT_EQ(read({.names = {"Rechts", "hoch", "NN"}}, "Nr;Rechts;Hoch;NN;H\n7;1;2;3;9\n"),
            (Point<3>{1, 2, 3}));
  EXPECT_EQ(read({.names = {"b", "a"}}, "# a b c\n2 1 3\n"), (Point<3>{1, 2, 0}));
  EXPECT_EQ(read({.separator = ','}, "1,2,3,4\n"), (Point<3>{1, 2, 3}));
  EXPECT_EQ(read({.separator = ' ', .decimal = ','}, "1,5 2,5 3,5\n"), (Point<3>{1.5, 2.5, 3.5}));
  EXPECT_EQ(read({.separator = ';', .decimal = ','}, "1;2;3\n"), (Point<3>{1, 2, 3}));
  EXPECT_EQ(read({.no_header = true}, "# y x z\n1 2 3\n"), (Point<3>{1, 2, 3}));
  EXPECT_EQ(read({.columns = std::array{1, 0, -1}, .no_header = true}, "2,1,3\n"),
            (Point<3>{1, 2, 0}));
  const auto fault = [&](const TextLayout& layout, const std::string& content) {
    return error_of([&] { read(layout, content); });
  };
  EXPECT_THAT(fault({.names = {"east", "north"}}, "x,y\n1,2\n"),
              ::testing::HasSubstr("line 1 does not name the columns east, north: it has \"x\", "
                                   "\"y\""));
  EXPECT_THAT(fault({.skip_lines = 5}, "1 2 3\n"),
              ::testing::HasSubstr("has 1 lines, of which 5 are to be left out"));
  EXPECT_THAT(fault({.separator = ';'}, "1,2,3\n"), ::testing::HasSubstr("line 1"));
  EXPECT_THAT(fault({.decimal = '.'}, "1,5;2,5;3,5\n"), ::testing::HasSubstr("line 1"));
  EXPECT_THAT(fault({.no_header = true}, "x,y,z\n1,2,3\n"), ::testing::HasSubstr("line 1"));
}

}  // namespace
}  // namespace spillway::test
