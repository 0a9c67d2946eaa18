// Tables whose layout is told or looked up: fixed columns, and what info says of how a text was
// understood.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

TEST(FixedColumns, AreChosenByTheirCharacters) {
  const Workspace work;
  work.write("fixed.txt",
             "Nr   East    North   Height Code\n"
             "1    1000.505000.25  100.10 EP\n"
             "2    1003.255010.75  101.20 TREE\n");
  const std::string options = " -q --columns 6-12,13-20,21-27";
  EXPECT_EQ(work.succeed("spillway convert fixed.txt -o - --output-format text" + options),
            "1000.5 5000.25 100.1\n1003.25 5010.75 101.2\n");
  EXPECT_EQ(work.succeed("spillway convert - -o - --output-format text < fixed.txt" + options),
            "1000.5 5000.25 100.1\n1003.25 5010.75 101.2\n");
  work.write("short.txt", "1    1000.505000.25  100.10 EP\n2    1003.25\n");
  const Result result = work.run("spillway convert short.txt -o a.xyz" + options);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("line 2, characters 13 to 20 are not a number"));
  EXPECT_EQ(work.run("spillway info fixed.txt --columns 6-12,20-13").exit_code, 2);
  EXPECT_THAT(work.run("spillway info fixed.txt --columns 6-12,10-20").err,
              HasSubstr("characters 10 to 20 are in two columns"));
  EXPECT_EQ(work.run("spillway info fixed.txt --columns 6-12,13-20 --separator tab").exit_code, 2);
}

TEST(Info, TellsHowATableWasUnderstood) {
  const Workspace work;
  work.write("a.csv", "# levels\nid;Hoch;Rechts;Cota\n1;2,5;1,5;3\n2;5;4;6\n3;7;8;9\n4;1;1;1\n");
  Json info = Json::parse(work.succeed("spillway info -q --json a.csv"));
  EXPECT_EQ(info["table"], Json::parse(R"({"separator": "semicolon", "decimal": "comma",
                           "names": ["id", "Hoch", "Rechts", "Cota"], "columns": [3, 2, 4],
                           "counts_downwards": false, "first_line": 3,
                           "first_rows": ["1;2,5;1,5;3", "2;5;4;6", "3;7;8;9"]})"));
  EXPECT_EQ(Json::parse(work.succeed("spillway info -q --json --fast a.csv"))["table"],
            info["table"]);
  const std::string text = work.succeed("spillway info -q a.csv");
  EXPECT_THAT(text, HasSubstr("  table\n    separator              semicolon\n"));
  EXPECT_THAT(text, HasSubstr("    first_rows\n      1;2,5;1,5;3\n      2;5;4;6\n"));
  work.write("fixed.txt", "1000.505000.25\n");
  EXPECT_EQ(Json::parse(work.succeed(
                "spillway info -q --json fixed.txt --columns 1-7,8-14"))["table"]["columns"],
            Json::parse(R"(["1-7", "8-14"])"));
  work.succeed("spillway convert -q a.csv -o a.las");
  EXPECT_EQ(Json::parse(work.succeed("spillway info -q --json a.las")).contains("table"), false);
}

/// The number of points is not what the header says then, and must not be promised.
TEST(SkipInvalid, OfFilesWhoseHeadersCountThem) {
  const Workspace work;
  work.write(
      "a.pcd",
      "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA ascii\n1 2 3\nnan nan "
      "nan\n4 5 6\n");
  for (const char* output : {"a.spp", "a.npy", "a.ply"}) {
    work.succeed(std::string("spillway convert -q --skip-invalid a.pcd -o ") + output);
    EXPECT_EQ(
        work.succeed(std::string("spillway convert -q ") + output + " -o - --output-format text"),
        "1 2 3\n4 5 6\n")
        << output;
  }
}

TEST(Info, CountsTheFlagsOfLas) {
  const Workspace work;
  work.write("a.csv", "x,y,z,overlap,key_point\n1,2,3,1,1\n4,5,6,1,0\n7,8,9,0,0\n");
  work.succeed("spillway convert -q a.csv -o a.las --las-version 1.4");
  Json flags = Json::parse(work.succeed("spillway info -q --json a.las"))["flags"];
  EXPECT_EQ(flags["overlap"], Json(2));
  EXPECT_EQ(flags["key_point"], Json(1));
  EXPECT_EQ(flags["synthetic"], Json(0));
  EXPECT_EQ(Json::parse(work.succeed(
                "spillway info -q --json a.las a.las | tail -n 1"))["flags"]["overlap"],
            Json(4));
}

}  // namespace
}  // namespace spillway::test
