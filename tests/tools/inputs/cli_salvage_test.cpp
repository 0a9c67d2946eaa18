// Files that are cut off or broken: --salvage takes what is whole of them and counts the rest,
// --skip-broken leaves them out and names them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kPoints = 120000;

class Salvage : public ::testing::Test {
 protected:
  Salvage() {
    work_.succeed(
        fmt::format("spillway generate terrain -q -n {} -o all.las && "
                    "spillway convert -q all.las -o 'all_12.laz' --las-version 1.2 && "
                    "spillway convert -q all.las -o 'all_14.laz' --las-version 1.4 && "
                    "spillway convert -q all.las -o all.xyz",
                    kPoints));
    for (const std::string name : {"all.las", "all_12.laz", "all_14.laz"}) {
      const std::string bytes = work_.read(name);
      work_.write("cut_" + name, bytes.substr(0, bytes.size() * 6 / 10));
    }
  }

  /// Runs a command that must succeed and say that points of a file are lost.
  std::string salvage(const std::string& command, const std::string& name) {
    const Result result = work_.run("spillway " + command + " --salvage");
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr(name + ": "), HasSubstr(" lost"))) << command;
    return result.out;
  }

  /// The points of a file in text, which must be the first ones of all.
  std::size_t count_first_points(const std::string& csv) {
    const std::string all = work_.read("all.xyz");
    const std::string some = work_.read(csv);
    EXPECT_TRUE(all.starts_with(some)) << csv;
    return static_cast<std::size_t>(std::ranges::count(some, '\n')) -
           static_cast<std::size_t>(std::ranges::count(all, '\n')) + kPoints;
  }

  Workspace work_;
};

TEST_F(Salvage, ConvertWritesWhatIsWholeInEveryFormat) {
  for (const std::string name : {"cut_all.las", "cut_all_12.laz", "cut_all_14.laz"}) {
    SCOPED_TRACE(name);
    const Result strict = work_.run("spillway convert " + name + " -o x.xyz");
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_THAT(strict.err, HasSubstr("--salvage"));
    salvage("convert " + name + " -o some.xyz", name);
    const std::size_t count = count_first_points("some.xyz");
    EXPECT_GE(count, 50000U);
    for (const std::string format : {"las", "laz", "npy", "spp"}) {
      salvage(fmt::format("convert {} -o some.{}", name, format), name);
      EXPECT_EQ(work_.info("some." + format)["points"], count);
    }
    salvage(fmt::format("convert {} -o sorted.spp --sorted", name), name);
    EXPECT_EQ(work_.info("sorted.spp")["points"], count);
    salvage(fmt::format("convert - -o piped.xyz < {}", name), "standard input");
    EXPECT_EQ(count_first_points("piped.xyz"), count);
    const Result pipe =
        work_.run(fmt::format("cat {} | spillway convert - -o pipe.xyz --salvage", name));
    EXPECT_EQ(pipe.exit_code, 0);
    EXPECT_THAT(pipe.err, HasSubstr("lost"));
    EXPECT_EQ(count_first_points("pipe.xyz"), count);
  }
}

TEST_F(Salvage, TriangulationsCountWhatIsLost) {
  for (const std::string name : {"cut_all.las", "cut_all_12.laz", "cut_all_14.laz"}) {
    SCOPED_TRACE(name);
    salvage("triangulate " + name + " -o mesh.ply --stats stats.json", name);
    const auto stats = nlohmann::json::parse(work_.read("stats.json"));
    EXPECT_EQ(stats["filters"]["read"].get<int>() + stats["filters"]["lost"].get<int>(), kPoints);
    EXPECT_GT(stats["filters"]["lost"], 0);
    const auto info = nlohmann::json::parse(salvage("info --json " + name, name));
    EXPECT_EQ(info["lost"], stats["filters"]["lost"]);
    EXPECT_EQ(info["points"], stats["points"]);
    work_.succeed("spillway check -q mesh.ply --salvage --points " + name);
  }
}

TEST_F(Salvage, OfManyFilesOnlyTheOneThatIsCutOffLosesPoints) {
  const std::string files = "cut_all.las all_14.laz cut_all_12.laz";
  salvage("triangulate --id " + files + " -o mesh.ply", "cut_all.las");
  salvage("triangulate " + files + " -o late.ply --no-trust-headers", "cut_all.las");
  EXPECT_EQ(work_.info("mesh.ply")["canonical_hash"], work_.info("late.ply")["canonical_hash"]);
}

TEST_F(Salvage, ADamagedChunkIsLeftOutAndTheOthersAreTriangulated) {
  std::string bytes = work_.read("all_12.laz");
  bytes.replace(bytes.size() / 2, 2000, 2000, '\xff');
  work_.write("bad.laz", bytes);
  EXPECT_EQ(work_.run("spillway triangulate bad.laz -o mesh.ply").exit_code, 1);
  salvage("triangulate bad.laz -o mesh.ply --stats stats.json", "bad.laz");
  const auto filters = nlohmann::json::parse(work_.read("stats.json"))["filters"];
  EXPECT_EQ(filters["lost"], 50000);
  EXPECT_EQ(filters["read"], kPoints - 50000);
  salvage("convert bad.laz -o some.las", "bad.laz");
  EXPECT_EQ(work_.info("some.las")["points"], kPoints - 50000);
}

TEST_F(Salvage, PointsThatTheHeaderDoesNotCountAreSaidAndRead) {
  std::string bytes = work_.read("all.las");
  const std::uint32_t told = 1000;
  std::memcpy(&bytes[107], &told, sizeof(told));
  work_.write("few.las", bytes);
  const Result strict = work_.run("spillway convert few.las -o few.spp");
  EXPECT_EQ(strict.exit_code, 0);
  EXPECT_THAT(strict.err, HasSubstr("room for 119000 more, which are not read"));
  EXPECT_EQ(work_.info("few.spp")["points"], 1000);
  const Result result = work_.run("spillway convert few.las -o more.spp --salvage");
  EXPECT_THAT(result.err, HasSubstr("119000 more points are read"));
  EXPECT_EQ(work_.info("more.spp")["points"], kPoints);
}

class SkipBroken : public ::testing::Test {
 protected:
  SkipBroken() {
    work_.succeed(
        "spillway generate terrain -q -n 3000 -o a.las && "
        "spillway generate terrain -q -n 3000 --seed 2 -o b.las && "
        "spillway generate uniform -q -n 3000 -o c.npy");
    work_.write("cut.las", work_.read("a.las").substr(0, 9000));
    work_.write("head.las", work_.read("a.las").substr(0, 100));
    work_.write("no.las", "these are no points at all");
    work_.write("no.npy", "\x93NUMPY\x01" + std::string(30, '?'));
    work_.write("empty.las", "");
  }

  Workspace work_;
  const std::string broken_ = "cut.las head.las no.las no.npy empty.las missing.las";
};

TEST_F(SkipBroken, TheOutputIsCompleteWithoutThemAndTheyAreNamedAtTheEnd) {
  for (const std::string command : {"triangulate", "convert"}) {
    SCOPED_TRACE(command);
    const std::string out = command == "convert" ? "out.spp" : "out.spm";
    work_.succeed(fmt::format("spillway {} -q a.las b.las -o expected_{}", command, out));
    const Result strict =
        work_.run(fmt::format("spillway {} a.las {} b.las -o {}", command, broken_, out));
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_FALSE(work_.has(out));
    const Result result = work_.run(
        fmt::format("spillway {} -q a.las {} b.las -o {} --skip-broken", command, broken_, out));
    EXPECT_EQ(result.exit_code, 1);
    for (const char* name :
         {"cut.las: ", "head.las: ", "no.las: ", "no.npy: ", "empty.las: ", "missing.las: "}) {
      EXPECT_THAT(result.err, HasSubstr(name));
    }
    EXPECT_THAT(result.err, HasSubstr("these 6 inputs are left out; the output is complete"));
    EXPECT_EQ(work_.read(out), work_.read("expected_" + out));
  }
}

TEST_F(SkipBroken, StatisticsNameThemToo) {
  const Result result =
      work_.run("spillway triangulate a.las no.las -o a.spm --skip-broken --stats stats.json");
  EXPECT_EQ(result.exit_code, 1);
  const auto skipped = nlohmann::json::parse(work_.read("stats.json"))["skipped_files"];
  ASSERT_EQ(skipped.size(), 1U);
  EXPECT_EQ(skipped[0]["path"], "no.las");
  EXPECT_THAT(skipped[0]["message"].get<std::string>(), HasSubstr("no.las: "));
  work_.succeed("spillway triangulate -q a.las -o a.spm --skip-broken --stats stats.json");
  EXPECT_TRUE(nlohmann::json::parse(work_.read("stats.json"))["skipped_files"].empty());
}

TEST_F(SkipBroken, ItIsAnErrorIfThereAreNoOthers) {
  const Result result = work_.run("spillway triangulate -q " + broken_ + " -o x.ply --skip-broken");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("6 of 6 inputs cannot be read"));
  EXPECT_FALSE(work_.has("x.ply"));
}

TEST_F(SkipBroken, WhatPointsLackForTheRunIsNoBrokenFile) {
  work_.write("plane.txt", "0 0\n1 0\n0 1\n");
  const Result result =
      work_.run("spillway triangulate a.las plane.txt --dim 3 -o x.ply --skip-broken");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("have no z"), Not(HasSubstr("left out"))));
  EXPECT_FALSE(work_.has("x.ply"));
}

TEST_F(SkipBroken, ACutFileIsSalvagedRatherThanLeftOut) {
  const Result result =
      work_.run("spillway convert cut.las no.las -o out.spp --skip-broken --salvage");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("lost"), HasSubstr("no.las: "), HasSubstr("this input is left out")));
  EXPECT_GT(work_.info("out.spp")["points"], 300);
}

TEST_F(SkipBroken, AJobOfABatchThatLeavesOutAFileHasFailed) {
  const Result result =
      work_.run("spillway batch a.las no.las --to ply --output-dir out --skip-broken");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(work_.has("out/a.ply"));
}

}  // namespace
}  // namespace spillway::test
