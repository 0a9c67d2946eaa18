// What the options of `triangulate` promise.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

nlohmann::json stats_of(const Workspace& work) {
  return nlohmann::json::parse(work.read("stats.json"));
}

/// The lines of an OBJ file that begin with `kind` and a space.
std::vector<std::string> obj_lines(const std::string& text, const std::string& kind) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(kind + " ", 0) == 0) lines.push_back(line.substr(kind.size() + 1));
  }
  return lines;
}

/// z of each vertex of an OBJ file.
std::vector<double> heights_of(const std::string& obj) {
  std::vector<double> heights;
  for (const std::string& line : obj_lines(obj, "v")) {
    heights.push_back(std::stod(line.substr(line.rfind(' '))));
  }
  return heights;
}

TEST(Triangulate, SaysWhatTheThirdColumnOfNpyIsTakenForUnlessDimIsGiven) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 100 --dim 3 -o in.npy\n"
      "spillway generate -q uniform -n 100 -o flat.npy\n"
      "spillway convert -q in.npy -o in.txt");
  const auto said = [&](const std::string& arguments) {
    const Result result = work.run("spillway triangulate -o mesh.ply " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  const std::string notice = "npy does not tell what its columns are";
  EXPECT_THAT(said("in.npy"), HasSubstr(notice));
  EXPECT_THAT(said("- --input-format npy < in.npy"), HasSubstr(notice));
  for (const std::string arguments :
       {"in.npy --dim 2", "in.npy --dim 3", "in.npy -q", "flat.npy", "in.txt"}) {
    EXPECT_THAT(said(arguments), ::testing::Not(HasSubstr(notice))) << arguments;
  }
}

TEST(Triangulate, OutputBytesDoNotDependOnThreads) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "for t in 1 2 4; do spillway triangulate -q in.las -o $t.ply --threads $t --leaf-points 500; "
      "done\n"
      "cmp 1.ply 2.ply; cmp 1.ply 4.ply");
}

TEST(Triangulate, TetrahedraDoNotDependOnThreads) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 4000 --dim 3 -o in.npy\n"
      "for t in 1 2 4; do spillway triangulate -q in.npy --dim 3 -o $t.ply --threads $t "
      "--leaf-points 500; done\n"
      "cmp 1.ply 2.ply; cmp 1.ply 4.ply");
}

TEST(Triangulate, HashDoesNotDependOnHowTheWorkIsDivided) {
  const Workspace work;
  work.succeed("spillway generate -q lattice -n 10000 -o in.las");
  std::string hash;
  for (const std::string options :
       {"", "--leaf-points 50", "--leaf-points 300 --division cycling",
        "--leaf-points 300 --division constant", "--leaf-points 100 --children 8"}) {
    work.succeed("spillway triangulate -q in.las -o mesh.ply --stats stats.json " + options);
    const std::string this_hash = stats_of(work)["canonical_hash"];
    if (hash.empty()) hash = this_hash;
    EXPECT_EQ(this_hash, hash) << options;
  }
}

TEST(Triangulate, SeveralInputsAreOneTriangulation) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 --seed 1 -o all.txt\n"
      "head -n 1000 all.txt > a.txt; tail -n +1001 all.txt > b.txt\n"
      "spillway triangulate -q all.txt -o all.ply --id\n"
      "spillway triangulate -q a.txt b.txt -o parts.ply --id\n"
      "cmp all.ply parts.ply");
}

TEST(Triangulate, InputsOnOneLatticeStayOnIt) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 --seed 1 -o a.las\n"
      "spillway generate -q terrain -n 3000 --seed 2 -o b.las\n"
      "spillway triangulate -q a.las b.las -o mesh.ply --stats stats.json\n"
      "spillway check -q mesh.ply --points a.las b.las");
  EXPECT_EQ(stats_of(work)["on_lattice"], true);
  EXPECT_EQ(work.info("mesh.ply")["on_lattice"], true);
}

TEST(Triangulate, InputsOnDifferentLatticesAreTriangulatedOnACommonOne) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o a.las\n"
      "spillway generate -q lattice -n 100 -o b.las\n"
      "spillway triangulate -q a.las b.las -o mesh.ply --stats stats.json\n"
      "spillway check -q mesh.ply --points a.las b.las");
  EXPECT_EQ(stats_of(work)["on_lattice"], true);
}

TEST(Triangulate, InputsWithoutACommonLatticeAreTriangulatedInOutputCoordinates) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o a.las\n"
      "spillway generate -q uniform -n 100 -o b.npy\n"
      "spillway triangulate -q a.las b.npy -o mesh.ply --stats stats.json\n"
      "spillway check -q mesh.ply --points a.las b.npy");
  EXPECT_EQ(stats_of(work)["on_lattice"], false);
}

TEST(Triangulate, ReadsAndWritesPipes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 2000 -o in.las\n"
      "spillway triangulate -q in.las -o file.obj\n"
      "cat in.las | spillway triangulate -q - -o - --output-format obj > pipe.obj\n"
      "cmp file.obj pipe.obj");
  EXPECT_EQ(work.names(), (std::vector<std::string>{"file.obj", "in.las", "pipe.obj"}));
}

TEST(Triangulate, GeneratedPointsComeThroughAPipe) {
  const Workspace work;
  for (const char* options : {"", "-o -", "--output-format text", "--output-format npy"}) {
    work.succeed(fmt::format(
        "spillway generate -q circle -n 500 {} | spillway triangulate -q - -o disc.ply\n"
        "cp -n disc.ply first.ply; cmp disc.ply first.ply",
        options));
  }
  EXPECT_EQ(work.info("disc.ply")["vertices"].get<int>() > 3, true);
}

// Four points at the corners of a square, the first of them three times.
constexpr const char* kStack = "0 0 5\n1 0 0\n0 1 0\n1 1 0\n0 0 2\n0 0 11\n";

TEST(Triangulate, DuplicatesKeepTheHeightThatIsAskedFor) {
  const Workspace work;
  work.write("in.txt", kStack);
  const std::vector<std::pair<std::string, double>> cases = {
      {"first", 5}, {"lowest", 2}, {"highest", 11}, {"mean", 6}};
  for (const auto& [choice, height] : cases) {
    const std::string obj =
        work.succeed("spillway triangulate -q in.txt -o - --output-format obj --heights " + choice);
    const auto heights = heights_of(obj);
    EXPECT_EQ(heights.size(), 4U);
    EXPECT_THAT(heights, ::testing::UnorderedElementsAre(height, 0, 0, 0)) << choice;
  }
}

TEST(Triangulate, MeanHeightsOffTheLatticePassTheCheck) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.ply --heights mean\n"
      "spillway check -q mesh.ply --points in.las");
}

TEST(Triangulate, IdIsTheIndexOfThePointThatGaveTheHeight) {
  const Workspace work;
  work.write("in.txt", kStack);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"first", "0"}, {"lowest", "4"}, {"highest", "5"}};
  for (const auto& [choice, index] : cases) {
    const std::string ply = work.succeed(
        "spillway triangulate -q in.txt -o - --output-format ply-ascii --id --heights " + choice);
    EXPECT_THAT(ply, ::testing::ContainsRegex("\n0 0 [0-9]+ " + index + "\n")) << ply;
  }
}

TEST(Triangulate, IdsRunOnThroughTheInputs) {
  const Workspace work;
  work.write("a.txt", "0 0 0\n1 0 0\n");
  work.write("b.txt", "0 1 0\n");
  const std::string ply =
      work.succeed("spillway triangulate -q a.txt b.txt -o - --output-format ply-ascii --id");
  EXPECT_THAT(ply, HasSubstr("\n0 1 0 2\n"));
}

TEST(Triangulate, MaxEdgeLeavesOutLongTrianglesAndSaysHowMany) {
  const Workspace work;
  // A unit square, and one point far away: two triangles are short, the others reach out to it.
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n100 0.5 0\n");
  const Result result =
      work.run("spillway triangulate in.txt -o mesh.obj --max-edge 2 --stats stats.json");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("left out"));
  const auto stats = stats_of(work);
  EXPECT_EQ(stats["simplices"], 2);
  EXPECT_GT(stats["left_out"], 0);
  EXPECT_EQ(stats["hull_facets"], 4);
  EXPECT_EQ(stats["canonical_hash"], work.info("mesh.obj")["canonical_hash"]);
  EXPECT_EQ(obj_lines(work.read("mesh.obj"), "f").size(), 2U);
  EXPECT_EQ(work.run("spillway check -q mesh.obj").exit_code, 1);
}

TEST(Triangulate, StatsHaveTheirDocumentedKeys) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.ply --stats stats.json --leaf-points 500");
  const auto stats = stats_of(work);
  for (const char* key :
       {"version", "dimension", "threads", "inputs", "output", "output_format", "on_lattice",
        "points", "withheld", "duplicates", "vertices", "simplices", "left_out", "hull_facets",
        "canonical_hash", "peak_rss_bytes", "seconds", "phases", "task_sums"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["points"], 5000);
  EXPECT_EQ(stats["points"].get<int>() - stats["duplicates"].get<int>(), stats["vertices"]);
  EXPECT_GT(stats["peak_rss_bytes"], 1 << 20);
  const auto& leaves = stats["task_sums"][0];
  EXPECT_EQ(leaves["scope"], "in_tile");
  EXPECT_EQ(leaves["level"], 0);
  EXPECT_EQ(leaves["kind"], "base_case");
  EXPECT_EQ(leaves["tasks"], stats["leaves"]);
  EXPECT_EQ(leaves["points"], 5000);
  EXPECT_GT(leaves["seconds"], 0.0);
  EXPECT_EQ(leaves["pieces"], stats["leaves"]);
}

TEST(Triangulate, TasksAreALineForEachNodeChildrenFirst) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.ply --stats stats.json --tasks tasks.jsonl "
      "--tile-points 2000 --leaf-points 500");
  std::istringstream lines(work.read("tasks.jsonl"));
  std::set<int> waiting;
  int tiles = 0;
  int points = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto node = nlohmann::json::parse(line);
    for (const int child : node["below"]) EXPECT_EQ(waiting.erase(child), 1U);
    EXPECT_TRUE(waiting.insert(node["number"].get<int>()).second);
    EXPECT_EQ(node["level"] == 0, node["below"].empty());
    EXPECT_GT(node["task"]["pieces"], 0);
    if (node["level"] != 0) continue;
    ++tiles;
    points += node["task"]["points"].get<int>();
    EXPECT_EQ(node["task"]["before"][0]["kind"], "divide");
  }
  EXPECT_EQ(waiting.size(), 1U);
  EXPECT_EQ(points, 20000);
  EXPECT_EQ(tiles, stats_of(work)["tiles"]);
}

TEST(Triangulate, TasksGetTheirFileOnlyIfTheRunEndsWell) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  const auto fails = [&](const std::string& options, const char* words, int code) {
    const Result result = work.run("spillway triangulate -q in.txt -o mesh.obj " + options);
    EXPECT_EQ(result.exit_code, code) << options;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(work.folder() / "mesh.obj"));
    EXPECT_FALSE(std::filesystem::exists(work.folder() / "tasks.jsonl"));
  };
  fails("--tasks tasks.jsonl --max-edge 0.1", "nothing is left", 1);
  fails("--tasks no/tasks.jsonl", "create the folder no", 1);
  fails("--tasks mesh.obj", "the mesh and --tasks cannot go to the same place", 2);
  fails("--tasks tasks.jsonl --stats tasks.jsonl", "--stats and --tasks cannot go", 2);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(work.folder()), {}), 1);
}

TEST(Triangulate, SimulatedCoresAreATableAndInTheStats) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 5000 -o in.npy");
  const Result result = work.run(
      "spillway triangulate in.npy -o mesh.ply --leaf-points 200 --simulate-cores 1,2,...,16 "
      "--stats stats.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("speed-up"));
  const auto runs = stats_of(work)["simulated"];
  ASSERT_EQ(runs.size(), 5U);
  EXPECT_EQ(runs[4]["cores"], 16);
  EXPECT_EQ(runs[0]["speed_up"], 1.0);
  EXPECT_NE(runs[4]["bottleneck"], "");
  EXPECT_EQ(runs[4]["bottlenecks"][0]["name"], runs[4]["bottleneck"]);
  EXPECT_LT(runs[4]["bottlenecks"][0]["seconds_without"], runs[4]["seconds"]);
  EXPECT_EQ(stats_of(work)["threads"], 1);
  EXPECT_EQ(stats_of(work)["simulated_points"], 5000);
}

TEST(Triangulate, SimulatedRunsMayBeLargerAndWaitForADisk) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 20000 -o in.las");
  work.succeed(
      "spillway triangulate -q in.las -o a.spm --tile-points 3000 --simulate-cores 64 "
      "--simulate-points 1e5 --simulate-disk 1M --stats stats.json");
  EXPECT_EQ(stats_of(work)["simulated_points"], 100000);
  const auto run = stats_of(work)["simulated"][0];
  EXPECT_EQ(run["bottleneck"], "disk");
  // The input and the output of five times the points.
  EXPECT_GT(run["seconds"],
            5 * (20 * 20000 + stats_of(work)["output_bytes"].get<double>()) / (1 << 20));
}

TEST(Triangulate, ReplacesAnOutputThatIsThere) {
  const Workspace work;
  work.write("mesh.obj", "something else");
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  work.succeed("spillway triangulate -q in.txt -o mesh.obj");
  EXPECT_EQ(work.info("mesh.obj")["simplices"], 1);
}

TEST(Triangulate, OutputMayReplaceItsOwnInput) {
  const Workspace work;
  work.write("points.txt", "0 0 0\n1 0 0\n0 1 0\n");
  work.succeed("spillway triangulate -q points.txt -o points.txt --output-format off");
  EXPECT_THAT(work.read("points.txt"), HasSubstr("OFF"));
}

TEST(Triangulate, ProgressForProgramsIsOneObjectALine) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 1000 -o in.npy");
  const Result result = work.run("spillway triangulate in.npy -o mesh.ply --progress json");
  std::istringstream lines(result.err);
  std::vector<std::string> phases;
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(json.is_object()) << line;
    if (json.contains("phase") && json["finished"] == true) phases.push_back(json["phase"]);
  }
  EXPECT_EQ(phases, (std::vector<std::string>{"read", "triangulate", "write"}));
}

TEST(Triangulate, QuietSaysNothing) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 1000 -o in.npy");
  const Result result = work.run("spillway triangulate -q in.npy -o mesh.ply");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST(CliTriangulate, MaxEdgeMayLeaveOutNearlyEverything) {
  const Workspace space;
  space.succeed("spillway generate uniform -n 20000 --seed 3 -o p.spp");
  for (const std::string length : {"0.001", "0.002", "0.004", "0.008"}) {
    space.succeed("spillway triangulate p.spp -o m.spm --leaf-points 500 --max-edge " + length);
    space.succeed("spillway triangulate p.spp -o m.ply --leaf-points 500 --max-edge " + length);
    EXPECT_EQ(space.info("m.spm")["simplices"], space.info("m.ply")["simplices"]) << length;
    EXPECT_EQ(space.info("m.spm")["vertices"], 20000) << length;
  }
}

}  // namespace
}  // namespace spillway::test
