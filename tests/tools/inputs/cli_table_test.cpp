// Tables of points without names, as survey software exports them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Table : public ::testing::Test {
 protected:
  Table() {
    work_.write("pnezd.csv",
                "1,5000.25,1000.50,100.10,EP\n2,5010.75,1003.25,101.20,TREE\n"
                "3,5003.00,1012.50,99.80,EP\n4,5012.00,1014.75,100.60,EP\n");
    work_.write("xyz.txt",
                "1000.50 5000.25 100.10\n1003.25 5010.75 101.20\n1012.50 5003.00 99.80\n"
                "1014.75 5012.00 100.60\n");
    work_.succeed("spillway triangulate -q xyz.txt -o right.ply");
  }

  Workspace work_;
};

TEST_F(Table, WithNumbersOfPointsIsRefusedWithWhatToSay) {
  for (const char* command :
       {"triangulate -q pnezd.csv -o o.ply", "info pnezd.csv", "convert -q pnezd.csv -o o.las",
        "triangulate -q - -o o.ply < pnezd.csv", "check -q right.ply --points pnezd.csv"}) {
    const Result result = work_.run(std::string("spillway ") + command);
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_THAT(result.err, AllOf(HasSubstr("the first of 5 columns without names counts"),
                                  HasSubstr("--columns PNEZD (point, northing, easting, height, "
                                            "description) or --columns 3,2,4")));
    EXPECT_FALSE(work_.has("o.ply") || work_.has("o.las"));
  }
}

TEST_F(Table, IsReadByTheColumnsThatAreChosen) {
  for (const char* columns : {"PNEZD", "3,2,4", "pyxhc"}) {
    work_.succeed(std::string("spillway triangulate -q pnezd.csv -o mesh.ply --columns ") +
                  columns);
    EXPECT_EQ(work_.read("mesh.ply"), work_.read("right.ply")) << columns;
    work_.succeed(std::string("spillway check -q right.ply --points pnezd.csv --columns ") +
                  columns);
  }
  EXPECT_EQ(work_.succeed("spillway convert -q pnezd.csv -o - --output-format text --columns 3,2"),
            "1000.5 5000.25\n1003.25 5010.75\n1012.5 5003\n1014.75 5012\n");
}

TEST_F(Table, ChoicesThatCannotBeAreWrongUsage) {
  for (const char* columns :
       {"3", "1,1,2", "0,1,2", "1,2,3,4", "NN", "PEZ", "EXN", "1;2", "a b", "1,2,x", "''"}) {
    const Result result =
        work_.run(std::string("spillway info pnezd.csv --columns '") + columns + "'");
    EXPECT_EQ(result.exit_code, 2) << columns << result.err;
  }
  work_.succeed("spillway generate -q terrain -n 50 -o a.las");
  const Result las = work_.run("spillway triangulate -q a.las -o o.ply --columns XYZ");
  EXPECT_EQ(las.exit_code, 2);
  EXPECT_THAT(las.err, HasSubstr("a.las is not text, so there are no lines and columns to choose"));
  EXPECT_EQ(work_.run("spillway dem right.ply -o o.tif --resolution 1 --columns XYZ").exit_code, 2);
}

TEST_F(Table, RowsThatAreNoPointsAreLeftOutAndCountedOnDemand) {
  work_.write("holes.csv", "x,y,z\n0,0,1\n1,0,\n0,1,2\nnan,1,2\n1,1,3\n");
  const Result strict = work_.run("spillway triangulate -q holes.csv -o o.ply");
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err, HasSubstr("line 3, column 3"));
  const Result result =
      work_.run("spillway triangulate holes.csv -o o.ply --skip-invalid --stats stats.json");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("5 points read, 2 invalid, 3 kept"));
  const auto stats = nlohmann::json::parse(work_.read("stats.json"));
  EXPECT_EQ(stats["filters"]["invalid"], 2);
  EXPECT_EQ(stats["points"], 3);
  work_.succeed("spillway check -q o.ply --points holes.csv --skip-invalid");
}

}  // namespace
}  // namespace spillway::test
