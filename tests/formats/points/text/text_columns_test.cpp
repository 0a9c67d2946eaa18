// Which columns a text's points are read from, and what separates them: right, or an error that
// names line and column, and never other numbers than those that stand there.

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <random>
#include <system_error>

#include "formats/points/text/text_columns.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr LatticePoint kPoint{10, 20, 30};

std::vector<LatticePoint> points_of(const std::string& content) {
  return read_content("a.txt", content).points;
}

std::vector<std::string> notices_of(const std::string& content) {
  return read_content("a.txt", content).header.notices;
}

std::string text_error(const std::string& content) { return error_of_content("a.txt", content); }

TEST(TextHeader, BlanksInNames) {
  EXPECT_THAT(points_of("GPS Time,X,Y,Z,I\n1,10,20,30,5\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("Point ID;X;Y;Z;code\n1;10;20;30;5\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("Point ID\tX\tY\tZ\tcode\n1\t10\t20\t30\t5\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("X [m],Y [m],Z [m]\n10,20,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("\"Point ID\",\"X\",\"Y\",\"Z\"\n\"a, 1\",10,20,30\n"),
              ElementsAre(kPoint));
  EXPECT_THAT(points_of("\"Height; m\",X,Y\n30,10,20\n"), ElementsAre(LatticePoint{10, 20, 30}));
}

TEST(TextHeader, BlanksAroundSeparators) {
  EXPECT_THAT(points_of("x, y, z\n10, 20, 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("x y \t z\n10 20\t30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of(" id ; x ; y ; z \n 1 ; 10 ; 20 ; 30 \n"), ElementsAre(kPoint));
}

TEST(TextHeader, KnownNames) {
  EXPECT_THAT(points_of("lat,lng,alt\n20,10,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("N,E,Z\n20,10,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("pid,X_UTM,Y_UTM,Elev_m\n1,10,20,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("pid,easting_m,northing_m,z\n1,10,20,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("id,x,y,elev_m\n1,10,20,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("Nr Hochwert Rechtswert Hoehe\n1 20 10 30\n"), ElementsAre(kPoint));
}

TEST(TextHeader, IsToldWhereItIsNotPlain) {
  EXPECT_THAT(notices_of("pid,X_UTM,Y_UTM,Elev_m\n1,10,20,30\n"),
              ElementsAre(HasSubstr("column 2 (\"X_UTM\") is taken for x")));
  EXPECT_THAT(notices_of("x,y,intensity\n1,2,3\n"), ElementsAre(HasSubstr("the points have no z")));
  EXPECT_THAT(notices_of("N,E,Z\n20,10,30\n"), IsEmpty());
  EXPECT_THAT(notices_of("1 2 3\n"), IsEmpty());
}

TEST(TextHeader, WithoutXOrYIsAnError) {
  EXPECT_THAT(text_error("# c\npid,foo,bar,z\n1,10,20,30\n"),
              AllOf(HasSubstr("a.txt: line 2 is a header whose columns are \"pid\", \"foo\", "
                              "\"bar\", \"z\": no columns are named as x and y"),
                    HasSubstr("name columns x, y and z")));
  EXPECT_THAT(text_error("x,foo,z\n1,10,20\n"), HasSubstr("no column is named as y"));
  EXPECT_THAT(text_error("Survey of the dunes\n1 2 3\n"), HasSubstr("line 1 is a header"));
  EXPECT_THAT(text_error("x,y,z,x\n1,2,3,4\n"),
              HasSubstr("the columns 1 (\"x\") and 4 (\"x\") may both be x"));
}

/// As tables of R have, whose rows begin with a number that the header does not count.
TEST(TextHeader, WithFewerNamesThanTheFirstRowHasColumnsIsAnError) {
  EXPECT_THAT(text_error("x y z\n1 10 20 30\n"),
              HasSubstr("line 2 has 4 columns, but the header names 3: \"x\", \"y\", \"z\""));
  EXPECT_THAT(text_error("x;y;z\n1;10;20;30\n"), HasSubstr("line 2 has 4 columns"));
  EXPECT_THAT(points_of("x;y;z\n10;20;30;\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of(",x,y,z\n0,10,20,30\n"), ElementsAre(kPoint));
}

TEST(TextHeader, InACommentRightBeforeThePoints) {
  EXPECT_THAT(points_of("//id,y,x,z\n7,20,10,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("//Y X Z\n20 10 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# made by hand\n# y x z\n20;10;30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# y, x, z\n20 10 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("//X Y Z R G B Intensity\n10 20 30 1 2 3 4\n"), ElementsAre(kPoint));
  EXPECT_THAT(notices_of("//X Y Z R G B\n1 2 3 4 5 6\n"), IsEmpty());
  EXPECT_THAT(notices_of("//id,y,x,z\n7,20,10,30\n"),
              ElementsAre(HasSubstr("the comment in line 1 is a header: column 3 (\"x\") is taken "
                                    "for x, column 2 (\"y\") is taken for y")));
  EXPECT_THAT(points_of("//pid,N,E,Elev_m\n7,20,10,30\n"), ElementsAre(kPoint));
  EXPECT_THAT(text_error("//id,y,x,z\n7,20,10,bad\n"),
              HasSubstr("line 2, column 4 is not a number"));
}

TEST(TextHeader, ProseInACommentIsNone) {
  EXPECT_THAT(points_of("# the points of y and x\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# x y z in metres\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(notices_of("# x y z in metres\n10 20 30\n"), IsEmpty());
  EXPECT_THAT(notices_of("# survey of 2024\n10 20 30\n"), IsEmpty());
  EXPECT_THAT(points_of("# north east corner\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# x and y of the survey in metres\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# y and x of the survey in metres\n10 20 30 4 5 6 7 8\n"),
              ElementsAre(kPoint));
  EXPECT_THAT(points_of("# N: 5400000, E: 500000\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# N=5400000, E=500000\n10,20\n"), ElementsAre(LatticePoint{10, 20, 0}));
}

TEST(TextHeader, InACommentBeforeOtherComments) {
  for (const char* const other : {"#", "#-----", "# units: m", "# by hand", "% x is east",
                                  "# the x and y of this survey", "#\n\n#----\n# N: 1, E: 2"}) {
    EXPECT_THAT(points_of(fmt::format("# id x y z\n{}\n7 10 20 30\n", other)), ElementsAre(kPoint))
        << other;
    EXPECT_THAT(points_of(fmt::format("# y x z\n{}\n20 10 30\n", other)), ElementsAre(kPoint))
        << other;
  }
  EXPECT_THAT(points_of("# id x y z\n# y x z\n20 10 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# id x y z\n# y x z\n7 10 20 30\n"), ElementsAre(kPoint));
  std::string many = "# id x y z\n";
  for (int i = 0; i < 1000; ++i) many += "# line\n";
  EXPECT_THAT(points_of(many + "7 10 20 30\n"), ElementsAre(kPoint));
}

TEST(TextHeader, InACommentOverTwoColumnsNeedsNoZ) {
  for (const char* const names : {"lat lon", "N,E", "Hoch Rechts", "y x"}) {
    const std::string text = fmt::format("# {}\n20 10\n", names);
    EXPECT_THAT(points_of(text), ElementsAre(LatticePoint{10, 20, 0})) << names;
    EXPECT_THAT(notices_of(text), ElementsAre(HasSubstr("is taken for y"))) << names;
  }
  EXPECT_THAT(points_of("# id lat lon\n7 20 10\n"), ElementsAre(LatticePoint{10, 20, 0}));
}

TEST(TextHeader, InACommentWithUnitsOrALabel) {
  for (const char* const names :
       {"id x y z (m)", "id X [m] Y [m] Z [m]", "Columns: id x y z", "fields: id, x, y, z"}) {
    EXPECT_THAT(points_of(fmt::format("# {}\n7 10 20 30\n", names)), ElementsAre(kPoint)) << names;
  }
  EXPECT_THAT(points_of("# X [m] Y [m] Z [m]\n10 20 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("# Format: X Y Z\n10 20 30\n"), ElementsAre(kPoint));
}

TEST(TextHeader, InACommentThatDoesNotFitIsAnError) {
  EXPECT_THAT(text_error("# made by hand\n# id x y z\n7 10 20 30 5\n"),
              AllOf(HasSubstr("a.txt: line 2 is a comment that names the columns \"id\", \"x\", "
                              "\"y\", \"z\", but the first row, line 3, has 5 columns"),
                    HasSubstr("name each column once, or remove that line")));
  EXPECT_THAT(text_error("# y x z in metres\n10 20 30\n"), HasSubstr("line 1 is a comment"));
  EXPECT_THAT(text_error("# lat lon\n1 2 3\n"), HasSubstr("line 2, has 3 columns"));
  EXPECT_THAT(text_error("# id x y z\n# the y and x of it\n7 10 20 30 5\n"),
              HasSubstr("line 1 is a comment"));
  EXPECT_THAT(text_error("# id x x y\n7 10 20 30\n"), HasSubstr("may both be x"));
  EXPECT_THAT(points_of("# x y z r g b\n10 20 30\n"), ElementsAre(kPoint));
}

TEST(TextHeader, ASentenceThatSaysOtherThanItsPlaceIsTold) {
  EXPECT_THAT(notices_of("# y and x in metres\n10 20 30\n"),
              ElementsAre(HasSubstr("the comment in line 1 is not taken for a header")));
}

TEST(TextHeader, WithBlanksInNamesWhereBlanksSeparateIsAnError) {
  EXPECT_THAT(text_error("GPS Time X Y Z Intensity\n1000.5 10 20 30 7\n"),
              HasSubstr("line 2 has 5 columns, but the header names 6"));
  EXPECT_THAT(text_error("X (m) Y (m) Z (m) Intensity Class\n10.5 20.5 30.5 40 2\n"),
              HasSubstr("line 2 has 5 columns, but the header names 8"));
  EXPECT_THAT(text_error("id,x,y,z,i\n10,20,30,5\n"),
              HasSubstr("line 2 has 4 columns, but the header names 5"));
}

TEST(TextHeader, WhereBlanksSeparateEveryRowHasAsManyColumns) {
  EXPECT_THAT(text_error("pt x y z\nA1 10 20 30\nA 2 11 20 4\n"),
              HasSubstr("line 3, column 5 is one more, where the header names 4"));
  EXPECT_THAT(text_error("id x y z code\n1 10 20 30 7\n11 21 31 8\n"),
              HasSubstr("line 3, column 5 is missing, where the header names 5"));
  EXPECT_THAT(points_of("id x y z code\n1 10 20 30 \"a b\" # a note\n"), ElementsAre(kPoint));
}

TEST(TextHeader, FixesTheSeparator) {
  EXPECT_THAT(points_of("x;y;z\n1,5;2,5;3,5\n"), ElementsAre(LatticePoint{1.5, 2.5, 3.5}));
  EXPECT_THAT(text_error("x;y;z\n1,2,3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1,2,3\""));
  EXPECT_THAT(text_error("x,y,z\n1;2;3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1;2;3\""));
  EXPECT_THAT(text_error("x\ty\tz\n1 2 3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1 2 3\""));
  EXPECT_THAT(text_error("x y z\n1,2,3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1,2,3\""));
}

TEST(TextTabs, EmptyColumnsCount) {
  EXPECT_THAT(points_of("id\tx\ty\tz\tcode\n\t10\t20\t30\t5\n"), ElementsAre(kPoint));
  EXPECT_THAT(text_error("1\t\t2\t3\n"), HasSubstr("line 1, column 2 is empty"));
  EXPECT_THAT(text_error("1\t2\t3\n4\t\t5\t6\n"), HasSubstr("line 2, column 2 is empty"));
}

TEST(DecimalCommas, WhereTheSeparatorIsAnotherSign) {
  const LatticePoint half{1.5, 2.5, 3.5};
  EXPECT_THAT(points_of("1,5;2,5;3,5\n"), ElementsAre(half));
  EXPECT_THAT(points_of("1,5\t2,5\t3,5\n"), ElementsAre(half));
  EXPECT_THAT(points_of("1,5 2,5 3,5\n"), ElementsAre(half));
  EXPECT_THAT(points_of("10,5 20,5 30,1\n"), ElementsAre(LatticePoint{10.5, 20.5, 30.1}));
  EXPECT_THAT(points_of("500000;4000000;1,5\n"), ElementsAre(LatticePoint{500000, 4000000, 1.5}));
  EXPECT_THAT(points_of("10 20 2,5\n"), ElementsAre(LatticePoint{10, 20, 2.5}));
  EXPECT_THAT(points_of("-1,5e1;+2,5;\"3,5\"\n"), ElementsAre(LatticePoint{-15, 2.5, 3.5}));
  EXPECT_THAT(notices_of("10,5 20,5 30,1\n"), ElementsAre(HasSubstr("decimal commas")));
}

TEST(DecimalCommas, InLaterRowsOnly) {
  EXPECT_THAT(points_of("1;2;10\n1;2;2,5\n"),
              ElementsAre(LatticePoint{1, 2, 10}, LatticePoint{1, 2, 2.5}));
  EXPECT_THAT(points_of("x y z\n1 2 10\n# 1.5\n1 2 2,5\n"),
              ElementsAre(LatticePoint{1, 2, 10}, LatticePoint{1, 2, 2.5}));
}

TEST(DecimalCommas, InTheLastColumnOfLinesThatEndAsInWindows) {
  EXPECT_THAT(points_of("x;y;z\r\n1;2;10\r\n1;2;2,5\r\n"),
              ElementsAre(LatticePoint{1, 2, 10}, LatticePoint{1, 2, 2.5}));
}

TEST(DecimalCommas, FarBehindOnlyAreAnError) {
  std::string text = "x;y;z\n";
  for (int i = 0; i < 20000; ++i) text += "1;2;3\n";
  EXPECT_THAT(text_error(text + "1;2;2,5\n"),
              HasSubstr("line 20002, column 3 has a decimal comma, \"2,5\", where the file is read "
                        "with decimal points"));
}

TEST(DecimalCommas, AreNotMixedWithPoints) {
  EXPECT_THAT(text_error("1.5;2;3\n1;2;2,5\n"), HasSubstr("line 2, column 3 has a decimal comma"));
  EXPECT_THAT(text_error("1,5;2;3\n1;2;2.5\n"), HasSubstr("line 2, column 3 has a decimal point"));
  EXPECT_THAT(text_error("1.5;2,5;3\n"), HasSubstr("line 1, column 2 has a decimal comma"));
  EXPECT_THAT(text_error("1.5 2.5 3\n10 20 2,5\n"),
              HasSubstr("line 2, column 3 has a decimal comma"));
  EXPECT_THAT(text_error("x y h2\n1.5 2.5 3\n10 20 2,5\n"),
              HasSubstr("line 3, column 3 has a decimal comma"));
  EXPECT_THAT(text_error("1.234,5;2;3\n"), HasSubstr("line 1"));
  EXPECT_THAT(text_error("1,234,567;2;3\n"), HasSubstr("line 1"));
}

TEST(DecimalCommas, AreAnErrorWhereCommasSeparate) {
  EXPECT_THAT(text_error("x,y,z\n10,20,30\n10,20,2,5\n"),
              HasSubstr("line 3, column 4 is one more than the 3 of the header or the first row"));
  EXPECT_THAT(text_error("10,20,30\n10,20,2,5\n"), HasSubstr("line 2, column 4"));
  EXPECT_THAT(text_error("10,20\n2,5,20\n"), HasSubstr("line 2, column 3"));
  EXPECT_THAT(text_error("\"1,5\",\"2,5\",\"3,5\"\n"),
              HasSubstr("line 1, column 1 has a decimal comma"));
  EXPECT_THAT(points_of("x,y,z,a\n10,20,30,\"1,5\"\n10,20,30,\n10,20,30\n"),
              ElementsAre(kPoint, kPoint, kPoint));
  EXPECT_THAT(points_of("10,20,30\n10,20,30,\n10,20,30,,\n10,20,30 # 1,5\n"),
              ElementsAre(kPoint, kPoint, kPoint, kPoint));
}

TEST(DecimalCommas, ManyAttributesBehindAreCounted) {
  const std::string header = "x,y,z,i,return,returns,class,time,flags\n";
  const std::string row = "10,20,30,1024,1,2,6,100000.250000,\"a, b\"\n";
  EXPECT_THAT(points_of(header + row + row), ElementsAre(kPoint, kPoint));
  EXPECT_THAT(text_error(header + row + "10,20,2,5,1024,1,2,6,100000.250000,0\n"),
              HasSubstr("line 3, column 10 is one more than the 9"));
}

TEST(DecimalCommas, WhereNobodyCanTellAreAnError) {
  for (const char* text :
       {"1,5,2,5\n", "1,5,2,5,3,5\n", "1,5, 2,5\n", "1,5,2,5,7\n", "10,20, 30\n"}) {
    EXPECT_THAT(text_error(text), AllOf(HasSubstr("line 1 may be columns separated by commas, or "
                                                  "numbers with decimal commas"),
                                        HasSubstr("a line that names its columns")));
  }
  EXPECT_THAT(points_of("x,y,z,i\n10,20,30,4\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("10, 20, 30, 4\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("10,20,30,4\n10,20,30.0,5\n"), ElementsAre(kPoint, kPoint));
  EXPECT_THAT(points_of("10,20,30\n"), ElementsAre(kPoint));
}

TEST(TextSeparators, OfTheFirstRow) {
  EXPECT_THAT(points_of("10, 20, 30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("10,\t20,\t30\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("10 20 30 a note; with, signs\n"), ElementsAre(kPoint));
  EXPECT_THAT(points_of("10.5 20 30 trees, old\n10 20 30 a,b\n"),
              ElementsAre(LatticePoint{10.5, 20, 30}, kPoint));
}

TEST(TextSeparators, ArePropertiesOfTheWholeFile) {
  EXPECT_THAT(text_error("1 2 3\n1;2;3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1;2;3\""));
  EXPECT_THAT(text_error("1;2;3\n1 2 3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1 2 3\""));
  EXPECT_THAT(text_error("1,2,3\n1 2 3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1 2 3\""));
  EXPECT_THAT(text_error("1,2,3\n1,2 3\n"), HasSubstr("line 2, column 2 is not a number: \"2 3\""));
  EXPECT_THAT(text_error("1 2 3\n1, 2, 3\n"),
              HasSubstr("line 2, column 1 is not a number: \"1,\""));
  EXPECT_THAT(text_error("1.5,2.5 3.5\n"),
              HasSubstr("line 1, column 2 is not a number: \"2.5 3.5\""));
}

TEST(TextSeparators, AFieldIsReadWhole) {
  EXPECT_THAT(text_error("1;2;3\n1;2;3x\n"), HasSubstr("line 2, column 3 is not a number: \"3x\""));
  EXPECT_THAT(text_error("1;2;3\n1;2;3 4\n"),
              HasSubstr("line 2, column 3 is not a number: \"3 4\""));
  EXPECT_THAT(text_error("1;2;3\n1;\"2\"5;3\n"), HasSubstr("line 2, column 2 is not a number"));
  EXPECT_THAT(text_error("1 2 3\n1 2 3,\n"), HasSubstr("line 2, column 3 is not a number: \"3,\""));
  EXPECT_THAT(points_of("1;2;3\n10;20;30 # c\n"), ElementsAre(LatticePoint{1, 2, 3}, kPoint));
}

/// Numbers of every length, with and without decimals and exponents, against the standard library.
TEST(TextNumbers, AreTheNearestDoubles) {
  std::mt19937_64 random(11);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  for (int i = 0; i < 300000; ++i) {
    std::string number = below(2) == 0 ? "-" : "";
    for (std::uint64_t digits = below(19); digits > 0; --digits) number += char('0' + below(10));
    if (below(4) > 0) number += '.';
    for (std::uint64_t digits = below(19); digits > 0; --digits) number += char('0' + below(10));
    if (below(8) == 0) number += fmt::format("e{}", static_cast<int>(below(40)) - 20);
    double expected = 0;
    const char* const end = number.data() + number.size();
    const auto [after, error] = std::from_chars(number.data(), end, expected);
    const bool is_number = error == std::errc() && after == end;
    double value = 0;
    ASSERT_EQ(read_decimal(number, false, value), is_number) << number;
    if (is_number) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected))
          << number;
    }
  }
}

/// What settles the layout is the same in a pipe, and what comes behind the first buffer is read by
/// it, too.
TEST(TextSeparators, HoldFromFrontToBackOfPipes) {
  std::string text = "x;y;z\n";
  for (int i = 0; i < 200000; ++i) text += fmt::format("{},5;{};{},25\n", i, i, -i);
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = text;
  const AllPoints all = read_all_points(files, "-");
  ASSERT_EQ(all.points.size(), 200000U);
  for (int i = 1; i < 200000; ++i) {
    ASSERT_EQ(all.points[i], (LatticePoint{i + 0.5, double(i), -i - 0.25}));
  }
}

}  // namespace
}  // namespace spillway::test
