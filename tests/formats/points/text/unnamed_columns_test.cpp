// Tables without names: what is not plainly x, y and z is refused, and a choice of columns goes
// before all else.

#include "formats/points/text/unnamed_columns.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "src/error.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kSurvey =
    "1,5000.25,1000.50,100.10,EP\n"
    "2,5010.75,1003.25,101.20,TREE\n"
    "3,5003.00,1012.50,99.80,EP\n";

AllPoints read_columns(const std::string& content, const std::array<int, 3>& columns) {
  PointReaderOptions options;
  options.text.columns = columns;
  return read_content("a.csv", content, options);
}

TEST(UnnamedColumns, AFirstOneThatCountsIsRefused) {
  EXPECT_THAT(error_of_content("a.csv", kSurvey),
              AllOf(HasSubstr("the first of 5 columns without names counts (1, 2, 3, ...)"),
                    HasSubstr("x would be \"1\", y \"5000.25\" and z \"1000.50\"")));
  EXPECT_THAT(error_of_content("a.txt", "101 1 2 3\n102 4 5 6\n103 7 8 9\n"),
              HasSubstr("counts (101, 102, 103, ...)"));
  EXPECT_THAT(error_of_content("a.txt", "7;1,5;2;3\n8;4;5;6\n\n# more\n9;7;8;9"),
              HasSubstr("counts (7, 8, 9, ...)"));
  try {
    read_content("a.csv", kSurvey);
    FAIL() << "no error";
  } catch (const Failure& error) {
    EXPECT_EQ(error.facts().remedy, Remedy::kColumns);
  }
}

TEST(UnnamedColumns, AFirstOneOfWholeNumbersBesideDecimalsIsRefused) {
  EXPECT_THAT(error_of_content("a.txt", "12 1.5 2.5 3\n14 4.5 5.5 6\n99 7.5 8.5 9\n"),
              HasSubstr("has whole numbers, the next two have decimals"));
}

TEST(UnnamedColumns, AFirstOneThatIsNoNumberIsRefused) {
  EXPECT_THAT(error_of_content("a.csv", "P1,5000.25,1000.50,100.10\nP2,5010,1003,101\n"),
              HasSubstr("line 1 has 4 columns without names, and the first one is not a number"));
}

TEST(UnnamedColumns, CoordinatesAreTaken) {
  for (const char* text : {"1,2,3\n2,5,6\n3,8,9\n",  // three columns
                           "500000.5 4.5 3 7\n500001.5 5.5 6 7\n500002.5 8.5 9 7\n",  // decimals
                           "1 2 3 4\n2 5 6 7\n",                         // too few rows to tell
                           "1 2.0 3.0 4\n2.5 5.0 6.0 7\n3 8.0 9.0 1\n",  // not all are whole
                           "10 20 3 4\n20 50 6 7\n30 80 9 1\n"}) {       // steps of ten
    EXPECT_THAT(read_content("a.txt", text).header.notices, IsEmpty()) << text;
  }
}

TEST(UnnamedColumns, ARowOfAGridIsTakenWithANotice) {
  const AllPoints all = read_content("a.txt", "0 5 1 9\n1 5 2 9\n2 5 3 9\n3 5 1 9\n");
  EXPECT_THAT(all.header.notices,
              ElementsAre("the first of 4 columns without names counts (0, 1, 2, ...), and is "
                          "taken for x"));
  EXPECT_EQ(all.points.size(), 4U);
}

TEST(UnnamedColumns, WhatIsCutOffAtTheEndOfTheFirstRowsDoesNotMatter) {
  std::string text;
  for (int i = 1; i < 20'000; ++i)
    text += std::to_string(i) + " " + std::to_string(i % 7) + " 5 6\n";
  EXPECT_THAT(error_of_content("a.txt", text), HasSubstr("counts"));
}

TEST(ChosenColumns, GoBeforeAllElse) {
  EXPECT_THAT(read_columns(kSurvey, {2, 1, 3}).points,
              ElementsAre(LatticePoint{1000.5, 5000.25, 100.1},
                          LatticePoint{1003.25, 5010.75, 101.2}, LatticePoint{1012.5, 5003, 99.8}));
  EXPECT_THAT(read_columns("x,y,z,h\n1,2,3,4\n", {3, 0, 1}).points,
              ElementsAre(LatticePoint{4, 1, 2}));
  EXPECT_THAT(read_columns("# x y z\n1 2 3\n", {2, 1, 0}).points,
              ElementsAre(LatticePoint{3, 2, 1}));
  EXPECT_THAT(read_columns("A;B;C;1,5;2,5;3,5\n", {3, 4, 5}).points,
              ElementsAre(LatticePoint{1.5, 2.5, 3.5}));
}

TEST(ChosenColumns, MayHaveNoHeights) {
  const AllPoints all = read_columns(kSurvey, {2, 1, -1});
  EXPECT_EQ(all.header.coordinates, 2);
  EXPECT_EQ(all.points.front(), (LatticePoint{1000.5, 5000.25, 0}));
}

TEST(ChosenColumns, ThatAreNotThereAreAnError) {
  const auto fault = [](const std::string& content) {
    return error_of([&] { read_columns(content, {0, 1, 4}); });
  };
  EXPECT_THAT(fault("1,2,3\n4,5,6\n"), HasSubstr("line 1, column 4 is missing"));
  EXPECT_THAT(fault("1,2,3,4,5\n4,5,6\n"), HasSubstr("line 2, column 4 is missing"));
}

TEST(Depths, CountDownwardsWithANotice) {
  const AllPoints all = read_content("a.csv", "x,y,depth\n1,2,3.5\n4,5,0\n");
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, -3.5}, LatticePoint{4, 5, 0}));
  EXPECT_FALSE(std::signbit(all.points[1][2]));
  EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("column 3 (\"depth\") counts downwards: z "
                                                        "is its number with the other sign")));
}

TEST(Depths, BelowZeroAreHeights) {
  const AllPoints all = read_content("a.csv", "x;y;Tiefe [m]\n1;2;-3,5\n4;5;0\n");
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, -3.5}, LatticePoint{4, 5, 0}));
  EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("taken for z as they stand")));
}

TEST(Heights, HaveNamesInManyLanguages) {
  for (const char* name : {"RL", "cota", "Quota", "hauteur", "H\xc3\xb6he", "elev_m", "Cote",
                           "altura", "hoogte", "h\xc3\xb6jd", "RL (m)"}) {
    const AllPoints all = read_content("a.csv", fmt::format("x,y,{}\n1,2,3\n", name));
    EXPECT_EQ(all.header.coordinates, 3) << name;
    EXPECT_EQ(all.points.front(), (LatticePoint{1, 2, 3})) << name;
  }
}

}  // namespace
}  // namespace spillway::test
