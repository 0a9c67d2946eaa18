// PTS: text with a line before the points that tells how many there are.

#include "formats/inputs/open_points.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr LatticePoint kFirst{1.5, -2, 300};
constexpr LatticePoint kSecond{4, 5, 6};

std::vector<LatticePoint> points_of(const std::string& content) {
  return read_content("a.pts", content).points;
}

std::string pts_error(const std::string& content) { return error_of_content("a.pts", content); }

TEST(Pts, CountLine) {
  EXPECT_THAT(points_of("2\n1.5 -2 3e2 -400 10 20 30\n4 5 6 -500 1 2 3\n"),
              ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of(" 2 \r\n1.5 -2 3e2\r\n4 5 6\r\n\r\n"), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of("# c\n2\n# d\n1.5;-2;3e2\n4;5;6\n"), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of("//Y X Z\n1\n-2 1.5 3e2\n"), ElementsAre(kFirst));
  EXPECT_TRUE(points_of("0\n").empty());
}

TEST(Pts, SeveralScans) {
  EXPECT_THAT(points_of("1\n1.5 -2 3e2\n1\n4 5 6\n"), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(points_of("0\n2\n1.5 -2 3e2\n4 5 6\n0\n").size(), 2U);
}

TEST(Pts, WrongCount) {
  EXPECT_THAT(pts_error("3\n1 2 3\n4 5 6\n"), HasSubstr("line 1 says 3 points, but 2 follow"));
  EXPECT_THAT(pts_error("1\n1 2 3\n4 5 6\n"), HasSubstr("line 1 says 1 points, but 2 follow"));
  EXPECT_THAT(pts_error("1\n1 2 3\n2\n4 5 6\n"), HasSubstr("line 3 says 2 points, but 1 follow"));
  EXPECT_THAT(pts_error("2\n1 2 3\n1\n4 5 6\n"), HasSubstr("line 1 says 2 points, but 1 follow"));
  EXPECT_THAT(pts_error("3\n4\n1 2 3\n"),
              HasSubstr("line 2 is a count of points, but line 1 says that 3 points follow there"));
  EXPECT_THAT(pts_error("12\n"), HasSubstr("line 1 says 12 points, but 0 follow"));
}

TEST(Pts, RowsWithoutAThirdColumn) {
  EXPECT_THAT(pts_error("2\n1 2\n3 4\n"), HasSubstr("line 2 has no third column"));
}

TEST(Pts, ACountInTheMiddleOfOtherTextIsNone) {
  EXPECT_THAT(pts_error("1 2 3\n1\n4 5 6\n"), HasSubstr("line 2, column 2 is missing"));
}

TEST(Pts, IsReadFromFrontToBack) {
  FaultyFileSystem files;
  files.files["a.pts"] = "1\n1 2 3\n";
  EXPECT_FALSE(open_point_reader(files, "a.pts", {})->pieces());
}

TEST(Pts, ManyPoints) {
  std::string text = "100000\n";
  for (int i = 0; i < 100000; ++i) text += "1 2 3\n";
  EXPECT_EQ(points_of(text).size(), 100000U);
  EXPECT_THAT(pts_error(text + "4 5 6\n"), HasSubstr("says 100000 points, but 100001 follow"));
}

}  // namespace
}  // namespace spillway::test
