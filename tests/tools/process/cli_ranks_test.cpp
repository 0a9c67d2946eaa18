// The command under mpirun: the same triangulation for any number of ranks, from all kinds of
// inputs; and a job that ends at once, cleanly, when one of them cannot go on.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/report/progress_lines.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A command line that runs so many ranks.
std::string ranks(int count, const std::string& arguments) {
  return fmt::format("{} -n {} {} {}", mpirun_command(), count, command_path(), arguments);
}

/// The mesh that one process makes, and the same of ranks.
class RanksOfTheCommand : public ::testing::Test {
 protected:
  void expect_same_mesh(int count, const std::string& arguments, const std::string& name = "b.spm",
                        const std::string& before = "") const {
    SCOPED_TRACE(fmt::format("{} ranks, {}", count, arguments));
    work_.succeed(fmt::format("{}spillway triangulate -q {} -o a.spm", before, arguments));
    work_.succeed(before + ranks(count, fmt::format("triangulate -q {} -o {}", arguments, name)));
    const auto alone = work_.info("a.spm");
    const auto together = work_.info(name);
    for (const char* figure : {"vertices", "simplices", "hull_facets", "canonical_hash"}) {
      EXPECT_EQ(alone.at(figure), together.at(figure)) << figure;
    }
  }

  /// The lines of a mesh's vertices: coordinates and index, sorted.
  [[nodiscard]] std::multiset<std::string> vertex_lines(const std::string& name) const {
    work_.succeed(fmt::format("spillway convert -q {} -o v.ply --output-format ply-ascii", name));
    std::istringstream text(work_.read("v.ply"));
    std::multiset<std::string> lines;
    std::uint64_t vertices = 0;
    std::string line;
    while (std::getline(text, line) && line != "end_header") {
      if (line.starts_with("element vertex ")) vertices = std::stoull(line.substr(15));
    }
    for (std::uint64_t v = 0; v < vertices && std::getline(text, line); ++v) lines.insert(line);
    return lines;
  }

  Workspace work_;
};

TEST_F(RanksOfTheCommand, MakeTheSamePeriodicMeshAndItIsProved) {
  work_.succeed("spillway generate -q uniform -n 3000 --dim 3 -o in.npy");
  work_.succeed("spillway generate -q haloes -n 3000 --dim 2 -o haloes.npy");
  for (const int count : {2, 3, 5}) {
    for (const char* const arguments :
         {"in.npy --dim 3 --periodic 0,0,0,1,1,1", "in.npy --dim 3 --periodic 0,0,-,1,1,-",
          "haloes.npy --periodic 0,0,1,1", "haloes.npy --periodic=-,0,-,1"}) {
      expect_same_mesh(count, arguments);
      const std::string file = arguments;
      work_.succeed("spillway check -q b.spm --points " + file.substr(0, file.find(' ')));
    }
  }
}

TEST_F(RanksOfTheCommand, RefuseTooFewPeriodicPoints) {
  work_.succeed("spillway generate -q uniform -n 5 -o few.npy");
  const auto result = work_.run(ranks(3, "triangulate few.npy --periodic 0,0,1,1 -o few.spm"));
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("too few points for a triangulation of the periodic box"));
  EXPECT_FALSE(work_.has("few.spm"));
}

TEST_F(RanksOfTheCommand, SalvageAsOneProcessDoesAndNameTheFiles) {
  work_.succeed(
      "spillway generate -q terrain -n 200000 -o in.las\n"
      "spillway convert -q in.las -o in.laz\n"
      "head -c 1000000 in.las > cut.las\n"
      "head -c 300000 in.laz > cut.laz");
  std::string bytes = work_.read("in.laz");
  bytes.replace(bytes.size() / 2, 2000, 2000, '\xff');
  work_.write("bad.laz", bytes);
  const std::string files = "cut.las cut.laz bad.laz --salvage";
  expect_same_mesh(3, files);
  const Result together = work_.run(ranks(3, "triangulate --stats run.json -o b.spm " + files));
  EXPECT_EQ(together.exit_code, 0);
  for (const char* name : {"cut.las: ", "cut.laz: ", "bad.laz: "}) {
    EXPECT_THAT(together.err, HasSubstr(name));
  }
  const auto filters = nlohmann::json::parse(work_.read("run.json"))["filters"];
  EXPECT_EQ(filters["read"].get<int>() + filters["lost"].get<int>(), 600000);
}

TEST_F(RanksOfTheCommand, MakeTheSameMeshInHigherDimensions) {
  for (const int dimension : {4, 5}) {
    for (const char* family : {"uniform", "lattice"}) {
      const int points = dimension == 4 ? 1'296 : 100;
      work_.succeed(fmt::format("spillway generate -q {} -n {} --dim {} -o in.npy", family, points,
                                dimension));
      for (const int count : {2, 3}) {
        expect_same_mesh(count, fmt::format("--dim {} in.npy --memory 1G", dimension));
        work_.succeed("spillway check -q b.spm --points in.npy");
      }
      // Each part tells the facets that it has alone, as its simplices show.
      work_.succeed(ranks(2, fmt::format("triangulate -q --dim {} in.npy --memory 1G --parts "
                                         "-o part.spm",
                                         dimension)));
      std::uint64_t simplices = 0;
      for (const char* part : {"part.0.spm", "part.1.spm"}) {
        const auto info = work_.info(part);
        simplices += info.at("simplices").get<std::uint64_t>();
        work_.succeed(fmt::format("spillway convert -q {} -o same.npy", part));
        EXPECT_EQ(work_.info("same.npy").at("hull_facets"), info.at("hull_facets")) << part;
      }
      EXPECT_EQ(work_.info("b.spm").at("simplices"), simplices);
    }
  }
}

TEST_F(RanksOfTheCommand, LeaveOutBrokenFilesWithExitCode1) {
  work_.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "head -c 9000 in.las > cut.las");
  work_.succeed("spillway triangulate -q in.las -o a.spm");
  const Result result =
      work_.run(ranks(2, "triangulate cut.las in.las missing.las -o b.spm --skip-broken"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cut.las: "), HasSubstr("missing.las: "),
                                HasSubstr("these 2 inputs are left out")));
  EXPECT_EQ(work_.info("b.spm")["canonical_hash"], work_.info("a.spm")["canonical_hash"]);
}

TEST_F(RanksOfTheCommand, EndEachPhaseOfTheProgressWithTheTotalsOfAll) {
  work_.succeed(
      "spillway generate -q terrain -n 200000 -o in.las\n"
      "spillway convert -q in.las -o in.txt");
  const auto run = [&](const std::string& command) {
    SCOPED_TRACE(command);
    const Result result = work_.run(command + " --stats run.json --progress json");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ended_phases(result.err);
  };
  using Phases = std::vector<EndedPhase>;
  for (const int count : {1, 2, 3}) {
    for (const std::string arguments : {"in.las -o a.spm", "in.las --every 2 -o a.spm",
                                        "in.las --thin 4 -o a.spm", "- -o a.spm < in.txt"}) {
      const Phases phases = run(ranks(count, "triangulate " + arguments));
      const auto stats = nlohmann::json::parse(work_.read("run.json"));
      EXPECT_EQ(phases, (Phases{{"read", 200000, "points"},
                                {"triangulate", stats["points"], "points"},
                                {"write", stats["simplices"], "triangles"}}))
          << count << ' ' << arguments;
    }
  }
  work_.succeed("spillway generate -q normal -n 2500000 -o many.spp");
  const Phases divided =
      run(ranks(2, "triangulate - --tile-points 20000 --memory 32M -o a.spm < many.spp"));
  const auto stats = nlohmann::json::parse(work_.read("run.json"));
  EXPECT_GT(stats["divided_points"], 0);
  EXPECT_EQ(divided, (Phases{{"read", 2500000, "points"},
                             {"divide", stats["divided_points"], "points"},
                             {"triangulate", 2500000, "points"},
                             {"write", stats["simplices"], "triangles"}}));
  const Phases dem = run(ranks(2, "dem in.las --resolution 5 -o a.tif"));
  const auto raster = nlohmann::json::parse(work_.read("run.json"))["raster"];
  const std::uint64_t pixels = raster["columns"].get<int>() * raster["rows"].get<int>();
  EXPECT_EQ(dem, (Phases{{"read", 200000, "points"},
                         {"triangulate", 200000, "points"},
                         {"write", pixels, "pixels"}}));
}

TEST_F(RanksOfTheCommand, GiveTheSameMeshForAnyNumberOfThem) {
  work_.succeed("spillway generate -q terrain -n 300000 -o in.las");
  for (const int count : {1, 2, 3, 4, 5, 8}) expect_same_mesh(count, "in.las");
  work_.succeed("spillway check -q b.spm --points in.las");
  work_.succeed("spillway generate -q uniform --dim 3 -n 60000 -o space.npy");
  for (const int count : {2, 3, 5}) expect_same_mesh(count, "space.npy --dim 3");
  work_.succeed("spillway check -q b.spm --points space.npy");
}

TEST_F(RanksOfTheCommand, ShareTextCompressedTextPipesListsAndFilteredInputs) {
  work_.succeed(
      "spillway generate -q terrain -n 200000 -o one.las && "
      "spillway generate -q terrain --seed 2 -n 90000 -o two.las && "
      "spillway convert -q one.las -o one.txt && gzip -k one.txt && "
      "printf 'one.las\\ntwo.las\\n' > list");
  for (const int count : {2, 3}) {
    for (const char* input :
         {"one.txt", "one.txt.gz", "@list", "one.las two.las one.txt.gz", "one.las --thin 3:lowest",
          "one.las --every 3", "one.txt --every 3", "two.las one.las --max-edge 30"}) {
      expect_same_mesh(count, input);
    }
    expect_same_mesh(count, "-", "b.spm", "cat one.las | ");
    expect_same_mesh(count, "two.las -", "b.spm", "cat one.txt | ");
  }
}

TEST_F(RanksOfTheCommand, GiveEachVertexTheSameHeightAndIndexAsOneProcess) {
  // Many points of equal x and y, in files of which each is a piece of the exchange.
  work_.succeed(
      "for i in 1 2 3 4 5; do spillway generate -q duplicates -n 3000 --seed $i -o p$i.npy && "
      "spillway convert -q p$i.npy -o p$i.txt && "
      "awk -v i=$i '{ print $1, $2, NR * 5 + i }' p$i.txt > z$i.txt; done");
  for (const char* choice : {"first", "lowest", "highest", "mean"}) {
    expect_same_mesh(3,
                     fmt::format("z1.txt z2.txt z3.txt z4.txt z5.txt --id --heights {}", choice));
    EXPECT_EQ(vertex_lines("a.spm"), vertex_lines("b.spm")) << choice;
  }
}

TEST_F(RanksOfTheCommand, GiveEachVertexTheAttributesThatOneProcessDoes) {
  work_.succeed(
      "spillway generate -q duplicates -n 9000 -o p.npy && spillway convert -q p.npy -o p.txt\n"
      "awk 'BEGIN { print \"x y z number odd\" } "
      "{ print $1, $2, NR % 50, NR, NR * 0.1 }' p.txt > in.txt");
  for (const char* how : {"--heights highest", "--dim 3", "--tile-points 500"}) {
    for (const char* name : {"b.spm", "b.ply", "b.vtu"}) {
      expect_same_mesh(3, fmt::format("in.txt --id --attributes all {}", how), name);
      EXPECT_EQ(vertex_lines("a.spm"), vertex_lines(name)) << how << ", " << name;
    }
  }
  work_.succeed(ranks(2, "triangulate -q in.txt -o b.ply --parts --attributes number"));
  for (const char* part : {"b.0.ply", "b.1.ply"}) {
    EXPECT_THAT(work_.read(part), HasSubstr("property double number\n")) << part;
  }
}

TEST_F(RanksOfTheCommand, WriteOneFileInAnyFormatOrToAPipe) {
  work_.succeed("spillway generate -q terrain -n 100000 -o in.las");
  for (const char* name : {"b.spm", "b.ply", "b.vtu", "b.obj"}) {
    expect_same_mesh(3, "in.las", name);
    work_.succeed(fmt::format("spillway check -q {} --points in.las", name));
  }
  work_.succeed(ranks(2, "triangulate -q in.las -o - > piped.spm"));
  EXPECT_EQ(work_.info("piped.spm").at("canonical_hash"), work_.info("a.spm").at("canonical_hash"));
}

TEST_F(RanksOfTheCommand, MakeTheSameRasterToTheByte) {
  work_.succeed("spillway generate -q terrain -n 200000 -o in.las");
  for (const std::string products : {"height,slope,curvature,facet-hillshade,density",
                                     "height,count,p50,max --fill-voids", "mean,count"}) {
    const std::string options = "-q in.las --resolution 0.4 --product " + products;
    work_.succeed(fmt::format("spillway dem {} -o a.tif", options));
    for (const int count : {1, 2, 5}) {
      work_.succeed(ranks(count, fmt::format("dem {} -o b.tif", options)));
      EXPECT_TRUE(work_.read("a.tif") == work_.read("b.tif")) << products << ", " << count;
    }
  }
}

/// Lines come in another order.
TEST_F(RanksOfTheCommand, DrawTheSameContours) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed("spillway generate -q terrain -n 200000 -o in.las");
  const auto lines = [this](const std::string& name) {
    std::vector<std::string> sorted;
    std::istringstream text(work_.read(name));
    for (std::string line; std::getline(text, line);) {
      if (line.find("LineString") == std::string::npos) continue;
      if (line.back() == ',') line.pop_back();
      sorted.push_back(line);
    }
    std::ranges::sort(sorted);
    return sorted;
  };
  const std::string exact = "contour -q in.las --interval 3 --force-crs --stats ";
  const std::string shape = "--smooth 1 --simplify 0.3 --min-length 20 ";
  for (const auto& [options, count] :
       {std::pair(exact, 1), std::pair(exact, 2), std::pair(exact, 5),
        std::pair("contour " + shape + exact.substr(8), 3)}) {
    work_.succeed("spillway " + options + "a.json -o a.geojson");
    ASSERT_GT(lines("a.geojson").size(), 300U);
    work_.succeed(ranks(count, options + "b.json -o b.geojson"));
    EXPECT_EQ(lines("a.geojson"), lines("b.geojson")) << count << " ranks";
    const auto statistics = [this](const char* name) {
      return nlohmann::json::parse(work_.read(name)).at("contours");
    };
    EXPECT_EQ(statistics("a.json").at("lines"), statistics("b.json").at("lines"));
    EXPECT_EQ(statistics("a.json").at("points"), statistics("b.json").at("points"));
    EXPECT_EQ(statistics("a.json").at("short_lines"), statistics("b.json").at("short_lines"));
  }
}

TEST_F(RanksOfTheCommand, DrawTheSameBands) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed("spillway generate -q terrain -n 50000 -o in.las");
  const std::string options = "contour -q in.las --interval 4 --force-crs --bands --simplify 0.5 ";
  work_.succeed("spillway " + options + "-o a.geojson");
  for (const int count : {1, 2, 5}) {
    work_.succeed(ranks(count, options + "-o b.geojson"));
    work_.succeed("sed s/'\"b\"'/'\"a\"'/ b.geojson | cmp - a.geojson");
  }
}

TEST_F(RanksOfTheCommand, WorkWithFewerPointsThanThereAreOfThem) {
  work_.write("four.txt", "0 0 1\n1 0 2\n0 1 3\n1 1 4\n");
  expect_same_mesh(8, "four.txt");
}

TEST_F(RanksOfTheCommand, KeepTilesOnDisksOfTheirOwn) {
  work_.succeed("mkdir one two && spillway generate -q terrain -n 1500000 -o in.las");
  const std::string common = "triangulate -q --memory 32M in.las -o b.spm --stats s.json";
  work_.succeed(
      fmt::format("{0} -n 1 {1} {2} --scratch-folder one : -n 1 {1} {2} --scratch-folder two",
                  mpirun_command(), command_path(), common));
  const auto stats = nlohmann::json::parse(work_.read("s.json"));
  for (const auto& rank : stats.at("ranks").at("each")) EXPECT_GT(rank.at("spilled_bytes"), 0);
  EXPECT_TRUE(fs::is_empty(work_.folder() / "one"));
  EXPECT_TRUE(fs::is_empty(work_.folder() / "two"));
  work_.succeed("spillway triangulate -q in.las -o a.spm");
  EXPECT_EQ(work_.info("a.spm").at("canonical_hash"), work_.info("b.spm").at("canonical_hash"));
}

TEST_F(RanksOfTheCommand, TellWhatWasSentAndMergedByEach) {
  work_.succeed("spillway generate -q terrain -n 300000 -o in.las");
  work_.succeed(ranks(4, "triangulate -q in.las -o b.spm --stats s.json"));
  const auto ranks_of_run = nlohmann::json::parse(work_.read("s.json")).at("ranks");
  EXPECT_EQ(ranks_of_run.at("count"), 4);
  EXPECT_GT(ranks_of_run.at("point_bytes_sent_per_point"), 0);
  EXPECT_GT(ranks_of_run.at("border_bytes_sent_per_border_simplex"), 0);
  ASSERT_EQ(ranks_of_run.at("each").size(), 4U);
  std::uint64_t points = 0;
  std::uint64_t triangulated = 0;
  for (const auto& rank : ranks_of_run.at("each")) {
    points += rank.at("points").get<std::uint64_t>();
    ASSERT_EQ(rank.at("merges").size(), 2U) << "of two ranks, and of all";
    EXPECT_EQ(rank.at("merges")[0].at("ranks"), 2);
    const auto& root = rank.at("merges")[1];
    EXPECT_EQ(root.at("ranks"), 4);
    EXPECT_GT(root.at("exposed_simplices"), 0);
    EXPECT_LE(root.at("exposed_simplices"), root.at("border_simplices"));
    triangulated += root.at("retriangulated_points").get<std::uint64_t>();
  }
  EXPECT_EQ(points, 300'000U);
  EXPECT_EQ(triangulated, ranks_of_run.at("each")[0].at("merges")[1].at("border_points"));
}

/// What mpirun itself adds is not looked at: the message comes once, and nothing is left.
class RanksThatFail : public RanksOfTheCommand {
 protected:
  void expect_failure(const std::string& command, const std::string& message,
                      int exit_code = 1) const {
    const auto before = work_.names();
    const Result result = work_.run(command);
    EXPECT_EQ(result.exit_code, exit_code) << command << "\n" << result.err;
    const std::size_t first = result.err.find("spillway: error: ");
    EXPECT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("spillway: error: ", first + 1), std::string::npos) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(work_.names(), before) << command;
  }
};

TEST_F(RanksThatFail, SayOnceWhatIsWrongWithInputOptionsAndOutput) {
  work_.write("line.txt", "0 0\n1 1\n2 2\n5 5\n");
  work_.write("none.txt", "\n");
  work_.write("bad.txt", "0 0\n1 0\n0 x\n");
  work_.succeed(
      "spillway generate -q terrain -n 90000 -o in.las && head -c 900000 in.las > cut.las");
  expect_failure(ranks(3, "triangulate -q line.txt -o b.ply"), "lie on one line");
  expect_failure(ranks(3, "triangulate -q none.txt -o b.ply"), "no points");
  expect_failure(ranks(3, "triangulate -q bad.txt -o b.ply"), "bad.txt");
  expect_failure(ranks(3, "triangulate -q missing.las -o b.ply"), "cannot open missing.las");
  expect_failure(ranks(3, "triangulate -q cut.las -o b.ply"), "cut.las");
  expect_failure(ranks(3, "triangulate -q in.las -o nowhere/b.ply"), "create the folder nowhere");
  expect_failure(ranks(3, "triangulate -q in.las -o b.ply --scratch-folder nowhere"),
                 "--scratch-folder");
  expect_failure(ranks(3, "triangulate -q in.las -o b.ply --max-edge 0.0001"), "nothing is left");
  expect_failure(ranks(3, "triangulate -q in.las"), "--output", 2);
  expect_failure(ranks(3, "triangulate -q in.las -o b.ply --simulate-cores 1,2"), "mpirun", 2);
  expect_failure(ranks(3, "triangulate -q in.las -o b.ply --tasks t.jsonl"), "mpirun", 2);
  expect_failure(ranks(3, "info in.las"), "start it without mpirun", 2);
  expect_failure("spillway triangulate -q in.las -o b.ply --parts", "start it with mpirun", 2);
}

/// What is to be removed is the folder that was given, not that of one rank.
TEST_F(RanksThatFail, NameTheFolderOfTheRunThatTheyCannotGoOnWith) {
  work_.write("line.txt", "1 1\n2 2\n3 3\n4 4\n");
  const std::string run = "triangulate -q line.txt -o b.ply --memory 64M --resume state";
  EXPECT_EQ(work_.run(ranks(2, run)).exit_code, 1);
  expect_failure(ranks(3, run), "the run in state: number of ranks is 3, and was 2");
  EXPECT_EQ(work_.succeed("ls state"), "rank-0\nrank-1\n");
}

TEST_F(RanksThatFail, RefuseDegenerateInputsInBothDimensions) {
  std::string plane;
  std::string equal;
  for (int i = 0; i < 60; ++i) {
    plane += fmt::format("{} {} 5\n", i % 7, i * i % 11);
    equal += "3 4 5\n";
  }
  work_.write("plane.txt", plane);
  work_.write("equal.txt", equal);
  work_.write("one.txt", "1 2 3\n");
  expect_failure(ranks(8, "triangulate -q plane.txt --dim 3 -o b.ply"), "lie in one plane");
  expect_failure(ranks(8, "triangulate -q equal.txt -o b.ply"), "only 1 distinct point");
  expect_failure(ranks(5, "triangulate -q equal.txt --dim 3 -o b.ply"), "only 1 distinct point");
  expect_failure(ranks(8, "triangulate -q one.txt -o b.ply"), "only 1 distinct point");
  // Much more than the borders of such points could have.
  work_.succeed(
      "spillway generate -q collinear -n 400000 -o line.spp && "
      "spillway generate -q coplanar --dim 3 -n 400000 -o plane.spp");
  expect_failure(ranks(3, "triangulate -q line.spp --memory 32M -o b.ply"),
                 "all 400000 points lie on one line");
  expect_failure(ranks(3, "triangulate -q plane.spp --dim 3 --memory 96M -o b.ply"),
                 "all 400000 points lie in one plane");
}

TEST_F(RanksThatFail, SayWhatIsWrongWithOneOfThem) {
  work_.succeed("mkdir one two && spillway generate -q terrain -n 90000 -o in.las");
  const auto both = [&](const std::string& first, const std::string& second) {
    const std::string common = command_path() + " triangulate -q in.las -o b.spm ";
    return fmt::format("{0} -n 1 {1} {2} : -n 1 {1} {3}", mpirun_command(), common, first, second);
  };
  expect_failure(both("--scratch-folder one", "--scratch-folder nowhere"),
                 "--scratch-folder: cannot write to nowhere");
  expect_failure(both("", "--bogus"), "--bogus", 2);
  for (const char* different :
       {"--max-edge 30", "--id", "--dim 3", "--heights lowest", "--parts", "--every 2"}) {
    expect_failure(both("", different), "other options", 2);
  }
  EXPECT_TRUE(fs::is_empty(work_.folder() / "one"));
}

TEST_F(RanksThatFail, TellWhichOfThemSeesAnotherFileOfTheSameName) {
  work_.succeed(
      "mkdir one two && spillway generate -q terrain -n 300000 -o one/in.las && "
      "spillway generate -q terrain -n 300000 --seed 2 -o two/in.las");
  const auto job = [&] {
    return fmt::format("{0} -n 1 -wdir one {1} {2} : -n 1 -wdir two {1} {2}", mpirun_command(),
                       command_path(), "triangulate -q in.las -o ../b.spm");
  };
  expect_failure(job(), "in.las: rank 1 reads another file of this name");
  // Another scale of z alone.
  work_.succeed(
      "cp one/in.las two/in.las && printf '\\001' |"
      " dd of=two/in.las bs=1 seek=147 conv=notrunc status=none");
  expect_failure(job(), "of the same size, but with other contents");
  work_.succeed("head -c 6000000 one/in.las > two/in.las");
  expect_failure(job(), "rank 1 reads another file of this name");
  work_.succeed("cp one/in.las two/in.las && " + job());
  EXPECT_EQ(work_.info("b.spm").at("points"), 300'000);
}

TEST_F(RanksThatFail, AskBeforeARasterOfManyPixelsForFewPoints) {
  work_.write("far.txt", "0 0 1\n1 0 2\n0 1 3\n5000 5000 4\n");
  expect_failure(ranks(2, "dem -q far.txt --resolution 1 -o b.tif"), "5000 x 5000 pixels");
}

TEST_F(RanksThatFail, RefuseMeshesForRasters) {
  work_.succeed("spillway generate -q terrain -n 1000 -o in.las");
  work_.succeed("spillway triangulate -q in.las -o mesh.ply");
  expect_failure(ranks(2, "dem -q mesh.ply -o b.tif --resolution 1"), "is a mesh", 2);
}

/// Processes of a running job, found by an argument that only they have: ranks, or mpirun.
std::vector<pid_t> processes_with(const std::string& argument, const std::string& program) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "cmdline", std::ios::binary);
    const std::string line((std::istreambuf_iterator<char>(file)), {});
    if (line.starts_with(program) && line.find(argument) != std::string::npos) {
      found.push_back(std::stoi(name));
    }
  }
  return found;
}

/// A job that spills, disturbed so many milliseconds after its ranks have begun: while they read,
/// triangulate, merge or write, as it happens.
class RanksThatAreStopped : public RanksThatFail, public ::testing::WithParamInterface<int> {
 protected:
  /// At times mpirun of Open MPI 4.1 waits for a lock of its own for ever once a rank was killed,
  /// though all ranks are gone.
  static void end_stuck_mpirun(const std::string& scratch, const std::atomic<bool>& ended) {
    for (int without_ranks = 0; !ended;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      without_ranks = processes_with(scratch, command_path()).empty() ? without_ranks + 1 : 0;
      if (without_ranks < 150) continue;
      for (const pid_t process : processes_with(scratch, mpirun_path())) kill(process, SIGKILL);
    }
  }

  void stop_job(int signal, const std::function<pid_t(const std::vector<pid_t>&)>& choose) const {
    work_.succeed("mkdir tmp && spillway generate -q terrain -n 3000000 -o in.las");
    const auto before = work_.names();
    const std::string scratch = work_.folder() / "tmp";
    Result result{};
    std::atomic<bool> ended = false;
    std::jthread job([&] {
      result = work_.run(
          ranks(3, "triangulate -q --memory 32M in.las -o b.spm --scratch-folder " + scratch));
      ended = true;
    });
    std::vector<pid_t> processes;
    while (processes.size() < 3 && !ended) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      processes = processes_with(scratch, command_path());
    }
    if (processes.size() == 3) {
      std::this_thread::sleep_for(std::chrono::milliseconds(GetParam()));
      if (const pid_t process = choose(processes); process > 0) kill(process, signal);
    }
    end_stuck_mpirun(scratch, ended);
    job.join();
    ASSERT_EQ(processes.size(), 3U)
        << "mpirun ended by itself with " << result.exit_code << ": " << result.err;
    if (work_.has("b.spm")) {  // done before mpirun had ended it: then it is complete
      EXPECT_EQ(work_.info("b.spm").at("points"), 3'000'000);
      std::filesystem::remove(work_.folder() / "b.spm");
    } else {
      EXPECT_NE(result.exit_code, 0);
    }
    EXPECT_EQ(work_.names(), before);
    // What a killed one had on its disk nobody else can know of.
    std::size_t folders_left = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(scratch)) ++folders_left;
    EXPECT_LE(folders_left, signal == SIGKILL ? 1U : 0U);
  }
};

TEST_P(RanksThatAreStopped, ByTheDeathOfOneLeaveNothing) {
  stop_job(SIGKILL, [](const std::vector<pid_t>& processes) { return processes[1]; });
}

TEST_P(RanksThatAreStopped, ByTheDeathOfTheFirstLeaveNothing) {
  stop_job(SIGKILL, [](const std::vector<pid_t>& processes) {
    return *std::min_element(processes.begin(), processes.end());
  });
}

TEST_P(RanksThatAreStopped, ByAnInterruptOfMpirunLeaveNothing) {
  stop_job(SIGINT, [](const std::vector<pid_t>& processes) {
    std::ifstream status(fmt::format("/proc/{}/stat", processes[0]));
    std::string word;
    for (int i = 0; i < 3; ++i) status >> word;
    pid_t parent = 0;  // nobody, if the job is done
    status >> parent;
    return parent;
  });
}

INSTANTIATE_TEST_SUITE_P(AfterMilliseconds, RanksThatAreStopped, ::testing::Values(100, 900));

}  // namespace
}  // namespace spillway::test
