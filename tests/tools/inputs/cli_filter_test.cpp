// Filters of points: what `triangulate`, `info` and `check --points` keep, count and say.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kPoints = 3000;

class Filters : public ::testing::Test {
 protected:
  Filters() { work_.write("in.las", scattered_las(0, kPoints).bytes()); }

  /// The mesh's hash, after `check --points` has proved it with the same filters.
  std::string hash(const std::string& options, const std::string& input = "in.las") {
    work_.succeed("spillway triangulate -q " + input + " -o mesh.ply --stats stats.json " +
                  options + "\nspillway check -q mesh.ply --points " + input + " " +
                  (options.find("--dim") == std::string::npos ? options : ""));
    stats_ = nlohmann::json::parse(work_.read("stats.json"));
    EXPECT_EQ(stats_["filters"]["kept"], stats_["points"]) << options;
    return stats_["canonical_hash"];
  }

  Workspace work_;
  nlohmann::json stats_;
};

TEST_F(Filters, KeepAndDropClasses) {
  const std::string kept = hash("--keep-class 1,3-4");
  EXPECT_EQ(stats_["points"], kPoints * 3 / 5);
  EXPECT_EQ(stats_["filters"]["class"], kPoints * 2 / 5);
  EXPECT_EQ(hash("--drop-class 0,2"), kept);
  EXPECT_EQ(hash("--keep-class 0-4 --drop-class 2,0"), kept);
  EXPECT_NE(hash("--drop-class 1"), kept);
}

TEST_F(Filters, Returns) {
  EXPECT_NE(hash("--returns first"), hash("--returns last"));
  EXPECT_EQ(stats_["points"], kPoints / 3);
  EXPECT_EQ(hash("--returns first"), hash("--returns 1"));
  EXPECT_EQ(hash("--returns last,2"), hash("--returns 2,3"));
  EXPECT_EQ(stats_["filters"]["returns"], kPoints / 3);
}

TEST_F(Filters, EveryAndBounds) {
  hash("--every 7");
  EXPECT_EQ(stats_["points"], (kPoints + 6) / 7);
  hash("--bounds 500000,4000000,500500,4000500");
  const int inside = stats_["points"];
  EXPECT_GT(inside, kPoints / 5);
  EXPECT_LT(inside, kPoints / 3);
  hash("--bounds 500000,4000000,0,500500,4000500,3 --keep-withheld");
  EXPECT_LT(stats_["points"], inside / 2);
}

TEST_F(Filters, NegativeBoundsAreNoOptions) {
  work_.write("points.txt", "-3 -3 0\n-1 -3 0\n-2 -1 0\n5 5 0\n");
  hash("--bounds -4,-4,0,0", "points.txt");
  EXPECT_EQ(stats_["points"], 3);
}

TEST_F(Filters, WhatWasDroppedIsSaidInOneLine) {
  const Result result =
      work_.run("spillway triangulate in.las -o mesh.ply --keep-class 2 --every 2");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("3000 points read, 1500 skipped, 1200 of other "
                                    "classes, 300 kept\n"));
  EXPECT_THAT(work_.run("spillway triangulate in.las -o mesh.ply").err, Not(HasSubstr("kept")));
}

TEST_F(Filters, WhereNoClassIsKeptThoseThatThereAreAreNamed) {
  const std::string message = "3000 points read, 3000 of other classes (0-4), 0 kept";
  for (const std::string command :
       {"triangulate in.las -o a.ply", "convert in.las -o a.spp --sorted",
        "triangulate in.las -o a.ply --memory 32M --no-trust-headers", "convert in.las -o a.las"}) {
    const Result result = work_.run("spillway " + command + " --keep-class 6,9");
    EXPECT_THAT(result.err, HasSubstr(message)) << command;
  }
}

TEST_F(Filters, TheSameComesThroughAPipe) {
  const std::string options = "--keep-class 2 --bounds 500000,4000000,500800,4000800 --thin 20";
  const std::string of_file = hash(options);
  work_.succeed("cat in.las | spillway triangulate -q - -o - " + options +
                " | spillway info -q - --json > pipe.json");
  EXPECT_EQ(nlohmann::json::parse(work_.read("pipe.json"))["canonical_hash"], of_file);
}

TEST_F(Filters, ThinningInLittleMemoryIsThinningInMuch) {
  work_.succeed("spillway generate -q uniform --dim 3 -n 400000 -o in.npy");
  for (const std::string choice : {"first", "lowest", "highest", "center"}) {
    const std::string thin = "--thin 0.002:" + choice;
    const std::string much = hash(thin + " --memory 2G", "in.npy");
    EXPECT_EQ(hash(thin + " --memory 32M --threads 1", "in.npy"), much) << choice;
    EXPECT_GT(stats_["filters"]["thinned"], 0);
    work_.succeed("spillway triangulate -q in.npy -o four.ply --threads 4 --memory 32M " + thin +
                  "\ncmp mesh.ply four.ply");
  }
}

TEST_F(Filters, ThinnedPointsComeInOneOrderWhateverTheMemoryAndTheWay) {
  work_.succeed(
      "spillway generate -q terrain -n 60000 -o one.las && "
      "spillway generate -q terrain -n 60000 --seed 2 -o two.las");
  for (const std::string choice : {"first", "lowest", "highest", "center"}) {
    const std::string thin = "--thin 0.4:" + choice;
    work_.succeed("spillway convert -q one.las two.las -o all.las --memory 1G " + thin);
    const std::string expected = work_.read("all.las");
    EXPECT_GT(expected.size(), 100'000U);
    for (const std::string memory : {"1M", "3M", "5M", "32M"}) {
      work_.succeed("spillway convert -q one.las two.las -o all.las --memory " + memory + " " +
                    thin);
      EXPECT_TRUE(work_.read("all.las") == expected) << choice << ", " << memory;
    }
    work_.succeed("spillway convert -q - two.las -o all.las --memory 2M < one.las " + thin);
    EXPECT_TRUE(work_.read("all.las") == expected) << choice << ", a pipe";
    for (const std::string format : {"txt", "npy", "spp"}) {
      if (choice != "lowest") break;
      work_.succeed("spillway convert -q one.las -o few." + format + " --memory 1M " + thin +
                    " && spillway convert -q one.las -o many." + format + " --memory 1G " + thin +
                    " && cmp few." + format + " many." + format);
    }
  }
}

TEST_F(Filters, AMeshOfThinnedPointsHasTheSameBytesWhereTheyWereThinnedOnTheDisk) {
  // Tiles and leaves are given, so that nothing but the order of points could differ. 32M have room
  // for fewer cells than there are.
  work_.succeed("spillway generate -q terrain -n 120000 -o in.las");
  const std::string command =
      "spillway triangulate -q --thin 0.1:lowest --tile-points 5000 --leaf-points 500 ";
  work_.succeed(command + "in.las -o much.spm --memory 1G && " + command +
                "in.las -o little.spm --memory 32M --threads 1 --stats little.json && " + command +
                "- -o pipe.spm --memory 32M < in.las && cmp much.spm little.spm && "
                "cmp much.spm pipe.spm");
  EXPECT_GT(nlohmann::json::parse(work_.read("little.json"))["points"], 100'000);
}

TEST_F(Filters, ThinningChoosesHeights) {
  work_.write("points.txt", "0 0 5\n0.5 0.5 1\n0.9 0.9 9\n3 0 0\n0 3 0\n");
  const auto vertices = [&](const std::string& choice) {
    return work_.succeed("spillway triangulate -q points.txt -o - --output-format obj --thin 1" +
                         choice + " | grep '^v'");
  };
  EXPECT_THAT(vertices(""), HasSubstr("v 0 0 5\n"));
  EXPECT_THAT(vertices(":lowest"), HasSubstr("v 0.5 0.5 1\n"));
  EXPECT_THAT(vertices(":highest"), HasSubstr("v 0.9 0.9 9\n"));
  EXPECT_THAT(vertices(":center"), HasSubstr("v 0.5 0.5 1\n"));
}

TEST_F(Filters, CellsAreCubesInSpace) {
  work_.write("points.txt", "0 0 0\n0.5 0 5\n0.5 0.5 0\n9 0 0\n0 9 0\n");
  EXPECT_THAT(work_.run("spillway triangulate points.txt --dim 3 --thin 1 -o mesh.ply").err,
              HasSubstr("5 points read, 1 thinned, 4 kept"));
}

TEST_F(Filters, IndicesStayThoseOfTheInput) {
  work_.write("points.txt", "0 0 5\n7 7 7\n1 0 5\n8 7 7\n0 1 5\n");
  for (const std::string filter :
       {"--every 2", "--bounds 0,0,1,1", "--thin 0.5 --bounds 0,0,1,1"}) {
    const std::string mesh = work_.succeed(
        "spillway triangulate -q points.txt -o - --output-format ply-ascii --id " + filter);
    EXPECT_THAT(mesh,
                AllOf(HasSubstr("\n0 0 5 0\n"), HasSubstr("\n1 0 5 2\n"), HasSubstr("\n0 1 5 4\n")))
        << filter;
  }
}

TEST_F(Filters, InfoCountsAndMeasuresWhatIsLeft) {
  const auto info = nlohmann::json::parse(
      work_.succeed("spillway info -q --json in.las --keep-class 2 --thin 50"));
  EXPECT_EQ(info["filters"]["read"], kPoints);
  EXPECT_EQ(info["filters"]["class"], kPoints * 4 / 5);
  EXPECT_EQ(info["filters"]["kept"], info["points"]);
  EXPECT_GT(info["filters"]["thinned"], 0);
  EXPECT_TRUE(work_.info("in.las")["filters"].is_null());
}

TEST_F(Filters, ClassesOfAFileThatHasNoneAreAnError) {
  work_.succeed("spillway generate -q uniform -n 100 -o in.npy");
  const Result result = work_.run("spillway triangulate in.las in.npy -o mesh.ply --keep-class 2");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, StartsWith("spillway: error: in.npy: the points have no classification"));
  EXPECT_FALSE(work_.has("mesh.ply"));
}

TEST_F(Filters, NothingLeftIsAnError) {
  const Result result = work_.run("spillway triangulate in.las -o mesh.ply --keep-class 99");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("no points"));
}

TEST_F(Filters, ABoxTheWrongWayRoundIsSaidToBe) {
  EXPECT_THAT(work_.run("spillway info in.las --bounds 10,10,1,20").err,
              HasSubstr("has a least x above the most: 10 > 1"));
}

TEST_F(Filters, ResolutionIsForCopcAndLeavesOtherFilesWhole) {
  EXPECT_THAT(work_.run("spillway info in.las --resolution 2").err,
              HasSubstr("in.las is not a COPC file"));
  const std::string copc = shared_file("1.2-with-color.copc.laz").string();
  if (copc.empty()) GTEST_SKIP() << "no COPC file in " << shared_data_folder();
  const Result result = work_.run("spillway triangulate --force-crs --resolution 100 in.las '" +
                                  copc + "' -o mesh.ply --stats stats.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("1 of 2 inputs are not COPC files"));
  EXPECT_GT(nlohmann::json::parse(work_.read("stats.json"))["points"], kPoints);
}

class WrongFilter : public ::testing::TestWithParam<std::string> {};

TEST_P(WrongFilter, IsOneLineAndExitCodeTwo) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  const Result result = work.run("spillway triangulate in.txt -o x.ply " + GetParam());
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_FALSE(work.has("x.ply"));
}

INSTANTIATE_TEST_SUITE_P(Cli, WrongFilter,
                         ::testing::Values("--keep-class 2,", "--keep-class 300",
                                           "--keep-class 5-2", "--keep-class a",
                                           "--drop-class 1-2-3", "--returns 0", "--returns 16",
                                           "--returns none", "--bounds 0,0,1", "--bounds 1,0,0,1",
                                           "--bounds 0,0,nan,1", "--bounds 0,0,0,1,1", "--every 0",
                                           "--every x", "--thin 0", "--thin -1", "--thin 1:last",
                                           "--thin 1:first:2", "--thin inf", "--resolution 0",
                                           "--dim 3 --heights lowest"));

TEST(SharedData, GroundOfAutzen) {
  const std::string path = shared_file("autzen_trim.las").string();
  if (path.empty()) GTEST_SKIP() << "no autzen_trim.las in " << shared_data_folder();
  const Workspace work;
  work.succeed("spillway triangulate -q '" + path +
               "' --keep-class 2 -o ground.ply --stats stats.json\n"
               "spillway check -q ground.ply --keep-class 2 --points '" +
               path + "'");
  const auto stats = nlohmann::json::parse(work.read("stats.json"));
  EXPECT_EQ(stats["points"], 26107);
  EXPECT_EQ(stats["filters"]["class"], 83893);
}

}  // namespace
}  // namespace spillway::test
