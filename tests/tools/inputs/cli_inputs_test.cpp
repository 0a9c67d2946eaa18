// Many inputs: files, patterns, lists and folders make one triangulation, the same as one file of
// all points would; and what is said where they cannot.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kFiles = 6;
constexpr int kPointsOfFile = 500;

class Inputs : public ::testing::Test {
 protected:
  /// tiles/0.las, ... and all.las with the points of all of them.
  Inputs() {
    std::filesystem::create_directory(work_.folder() / "tiles");
    work_.write("all.las", scattered_las(0, kFiles * kPointsOfFile).bytes());
    for (int i = 0; i < kFiles; ++i) {
      work_.write(fmt::format("tiles/{}.las", i),
                  scattered_las(i * kPointsOfFile, kPointsOfFile).bytes());
    }
  }

  std::string hash(const std::string& arguments) {
    work_.succeed("spillway triangulate -q -o mesh.ply --stats stats.json " + arguments);
    stats_ = nlohmann::json::parse(work_.read("stats.json"));
    return stats_["canonical_hash"];
  }

  std::string error(const std::string& arguments) {
    const Result result = work_.run("spillway triangulate -o mesh.ply " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    return result.err;
  }

  Workspace work_;
  nlohmann::json stats_;
};

TEST_F(Inputs, FilesPatternsFoldersAndListsAreOneTriangulation) {
  const std::string truth = hash("all.las");
  EXPECT_EQ(stats_["points"], kFiles * kPointsOfFile);
  EXPECT_EQ(hash("tiles/3.las tiles/1.las tiles/0.las tiles/5.las tiles/4.las tiles/2.las"), truth);
  EXPECT_EQ(hash("'tiles/[0-9].la[sz]'"), truth);
  EXPECT_EQ(hash("tiles"), truth);
  EXPECT_EQ(hash("tiles/ --memory 32M"), truth);
  work_.write("tiles/list.lst", "# the first ones\n 0.las \r\n\n1.las\n[2-4].las\n");
  EXPECT_EQ(hash("@tiles/list.lst tiles/5.las"), truth);
  EXPECT_EQ(hash("--dim 3 all.las"), hash("--dim 3 tiles"));
}

TEST_F(Inputs, AListMayComeThroughAPipe) {
  const std::string truth = hash("all.las");
  work_.succeed("ls tiles/*.las | spillway triangulate -q @- -o mesh.ply");
  EXPECT_EQ(work_.info("mesh.ply")["canonical_hash"], truth);
}

TEST_F(Inputs, AFileWhoseNameLooksLikeAPatternIsTaken) {
  std::filesystem::copy(work_.folder() / "all.las", work_.folder() / "[all].las");
  EXPECT_EQ(hash("'[all].las'"), hash("all.las"));
}

TEST_F(Inputs, AFolderIsNotSearchedFurtherDown) {
  work_.write("tiles/notes.md", "no points\n");
  std::filesystem::create_directory(work_.folder() / "tiles" / "old");
  work_.write("tiles/old/6.las", scattered_las(3000, 10).bytes());
  EXPECT_EQ(hash("tiles"), hash("all.las"));
}

TEST_F(Inputs, HiddenFilesOfAFolderAreLeftOut) {
  work_.write("tiles/._0.las", "what some systems put beside a file");
  work_.write("tiles/.6.las", scattered_las(3000, 10).bytes());
  EXPECT_EQ(hash("tiles"), hash("all.las"));
}

TEST_F(Inputs, WithoutHeightsBesideOthersAreToldSo) {
  work_.write("flat.csv", "x,y\n0,0\n5,0\n0,5\n");
  work_.write("high.csv", "x,y,z\n7,7,7\n");
  EXPECT_THAT(work_.run("spillway triangulate flat.csv high.csv -o mesh.ply").err,
              HasSubstr("flat.csv: the points have no z, beside others that have: it is 0 there"));
}

TEST_F(Inputs, NpyMeshesOfAFolderAreNoPoints) {
  work_.succeed("spillway triangulate -q --id all.las -o tiles/mesh.npy");
  EXPECT_EQ(hash("tiles"), hash("all.las"));
  EXPECT_THAT(work_.run("spillway triangulate tiles -o mesh.ply").err,
              HasSubstr("3 files of npy meshes in folders left out"));
  EXPECT_THAT(error("tiles/mesh_simplices.npy"), HasSubstr("the simplices of an npy mesh"));
  EXPECT_EQ(hash("tiles/mesh_vertices.npy"), work_.info("tiles/mesh.npy")["canonical_hash"]);
}

TEST_F(Inputs, MeshesAreToldFromPoints) {
  work_.succeed("spillway triangulate -q all.las -o tin.ply");
  EXPECT_THAT(error("tin.ply"), HasSubstr("tin.ply: this is a mesh (PLY), not points"));
  EXPECT_THAT(work_.run("cat tin.ply | spillway info -").err,
              HasSubstr("only spm and sma are read from a pipe"));
  EXPECT_THAT(work_.run("spillway convert tin.ply -o x.las").err,
              HasSubstr("tin.ply: this is a mesh, and x.las would be points"));
}

TEST_F(Inputs, NamedPipesAreReadOnceFromTheirFirstByteOn) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed(
      "mkfifo pipe\n"
      "spillway generate -q uniform --dim 3 -n 30000 -o many.txt\n"
      "spillway triangulate -q many.txt -o many.spm\n"
      "cat many.txt > pipe & spillway convert -q pipe -o copy.txt; wait\n"
      "spillway convert -q many.txt -o direct.txt && cmp copy.txt direct.txt\n"
      "cat many.spm > pipe & spillway convert -q pipe -o copy.ply; wait\n"
      "spillway convert -q many.spm -o direct.ply && cmp copy.ply direct.ply\n"
      "cat many.spm > pipe & spillway check -q pipe; wait\n"
      "cat many.spm > pipe & spillway dem -q pipe --resolution 0.1 -o copy.tif; wait\n"
      "spillway dem -q many.spm --resolution 0.1 -o direct.tif && cmp copy.tif direct.tif\n"
      "cat many.txt > pipe & spillway dem -q pipe --resolution 0.1 -o copy.tif; wait\n"
      "cmp copy.tif direct.tif\n");
  const auto points = [&](const std::string& arguments) {
    const auto json = nlohmann::json::parse(
        work_.succeed("cat many.txt > pipe & spillway info -q --json " + arguments + "; wait"));
    return json["points"].get<int>();
  };
  EXPECT_EQ(points("pipe"), 30000);
  EXPECT_EQ(points("pipe --every 2"), 15000);
  EXPECT_EQ(points("pipe --bounds -9,-9,9,9"), 30000);
  EXPECT_EQ(points("/dev/fd/3 --every 3 3< pipe"), 10000);
}

TEST_F(Inputs, AnEmptyPipeIsAnErrorAndAnEmptyTextIsNone) {
  work_.write("empty.txt", "");
  work_.write("empty.las", "");
  EXPECT_EQ(work_.info("empty.txt")["points"], 0);
  for (const std::string command : {"info -", "check -", "convert - -o x.las", "info empty.las"}) {
    const Result result = work_.run("spillway " + command);
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_THAT(result.err, HasSubstr(": the input is empty; ")) << command;
  }
  EXPECT_FALSE(work_.has("x.las"));
}

TEST_F(Inputs, InfoGoesOnAfterAFileThatCannotBeRead) {
  const Result result = work_.run("spillway info -q tiles/0.las gone.las tiles/1.las");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("tiles/0.las\n"), HasSubstr("tiles/1.las\n")));
  EXPECT_THAT(result.err, HasSubstr("gone.las"));
}

TEST_F(Inputs, CheckAndInfoTakeThemToo) {
  hash("tiles");
  work_.succeed("spillway check -q mesh.ply --points 'tiles/*.las'");
  const std::string lines = work_.succeed("spillway info -q --json tiles");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), kFiles + 1);  // and their total
}

TEST_F(Inputs, FineAndCoarseScalesMakeWhatOneFineFileMakes) {
  LasFile fine = scattered_las(0, kPointsOfFile);
  LasFile both = scattered_las(0, 2 * kPointsOfFile);
  both.scale = fine.scale = {0.005, 0.005, 0.005};
  fine.offset = both.offset;
  for (auto& record : both.records) record = {2 * record.x, 2 * record.y, 2 * record.z};
  for (auto& record : fine.records) record = {2 * record.x, 2 * record.y, 2 * record.z};
  work_.write("fine.las", fine.bytes());
  work_.write("both.las", both.bytes());
  const std::string truth = hash("both.las");
  EXPECT_EQ(hash("tiles/1.las fine.las"), truth);
  EXPECT_EQ(stats_["on_lattice"], true);
  EXPECT_EQ(hash("fine.las tiles/1.las"), truth);
  work_.succeed("spillway check -q mesh.ply --points tiles/1.las fine.las");
}

TEST_F(Inputs, AllThatCannotBeReadAreNamed) {
  work_.write("tiles/7.las", "LASF");
  work_.write("tiles/8.las", "LASF");
  EXPECT_THAT(error("tiles gone.las"),
              AllOf(HasSubstr("3 of 9 inputs cannot be read:\n"), HasSubstr("\n  tiles/7.las: "),
                    HasSubstr("\n  tiles/8.las: "), HasSubstr("gone.las")));
  EXPECT_FALSE(work_.has("mesh.ply"));
}

TEST_F(Inputs, WhatNamesNothingIsAnError) {
  std::filesystem::create_directory(work_.folder() / "empty");
  work_.write("empty.lst", "# nothing\n");
  work_.write("nested.lst", "@empty.lst\n");
  EXPECT_THAT(error("empty"), HasSubstr("empty: the folder has no point files"));
  EXPECT_THAT(error("'*.copc'"), HasSubstr("*.copc: no file matches this pattern"));
  EXPECT_THAT(error("@empty.lst"), HasSubstr("empty.lst: the list is empty"));
  EXPECT_THAT(error("@nested.lst"), HasSubstr("nested.lst, line 1: "));
  EXPECT_THAT(error("@gone.lst"), HasSubstr("a file of that name is ./@gone.lst"));
}

TEST_F(Inputs, DifferentCoordinateSystemsNeedForce) {
  LasFile a = scattered_las(0, kPointsOfFile);
  LasFile b = scattered_las(kPointsOfFile, kPointsOfFile);
  a.vlrs = {epsg_keys(32632)};
  b.vlrs = {epsg_keys(25832)};
  work_.write("a.las", a.bytes());
  work_.write("b.las", b.bytes());
  EXPECT_THAT(error("a.las b.las"), AllOf(HasSubstr("b.las has the coordinate system EPSG:25832"),
                                          HasSubstr("but a.las has EPSG:32632")));
  EXPECT_EQ(hash("a.las b.las --force-crs"), hash("tiles/0.las tiles/1.las"));
  EXPECT_THAT(work_.run("spillway triangulate a.las tiles/1.las -o mesh.ply").err,
              HasSubstr("warning: tiles/1.las names no coordinate system"));
}

TEST(Help, GroupsTheFilters) {
  const Workspace work;
  for (const std::string command : {"triangulate", "info", "check"}) {
    const std::string help = work.succeed("spillway " + command + " --help");
    EXPECT_THAT(help, AllOf(HasSubstr("\nFilters"), HasSubstr("--keep-class LIST"),
                            HasSubstr("--thin CELL[:CHOICE]")));
  }
}

TEST(Help, IsShortWithoutArguments) {
  const Workspace work;
  const Result result = work.run("spillway");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("Usage: spillway"), HasSubstr("Examples:")));
  EXPECT_EQ(result.out, "");
}

TEST(LasRecords, ThatAreNotThereAreSaidOnceByEveryCommand) {
  const Workspace work;
  std::string bytes = scattered_las(0, kPointsOfFile).bytes();
  put(bytes, 100, std::uint32_t{3});
  work.write("in.las", bytes);
  const std::string notice = ": the header counts 3 variable length records, but none lies";
  for (const std::string command :
       {"info in.las", "triangulate in.las -o a.ply", "convert in.las -o a.spp",
        "render in.las -o a.png", "triangulate in.las in.las -o b.ply"}) {
    const Result result = work.run("spillway " + command);
    EXPECT_EQ(result.exit_code, 0) << command;
    const std::size_t said = result.err.find(notice);
    ASSERT_NE(said, std::string::npos) << command;
    EXPECT_EQ(result.err.find(notice, said + 1), std::string::npos) << command;
  }
}

TEST(Slips, GetASuggestion) {
  const Workspace work;
  EXPECT_THAT(work.run("spillway triangluate").err, HasSubstr("(did you mean triangulate?)"));
  EXPECT_THAT(work.run("spillway triangulate a -o b --bound=1,2").err,
              HasSubstr("(did you mean --bounds?)"));
  EXPECT_THAT(work.run("spillway triangulate a -o b --frobnicate").err,
              Not(HasSubstr("did you mean")));
}

TEST(SharedData, ManyFilesAreOneTriangulation) {
  const std::filesystem::path path = shared_file("autzen_trim.las");
  if (path.empty()) GTEST_SKIP() << "no autzen_trim.las in " << shared_data_folder();
  const Workspace work;
  work.succeed("spillway triangulate -q '" + (path.parent_path() / "autzen_trim*.las").string() +
               "' -o both.ply --stats both.json --force-crs\n"
               "spillway triangulate -q '" +
               path.string() + "' -o one.ply --stats one.json");
  const auto both = nlohmann::json::parse(work.read("both.json"));
  const auto one = nlohmann::json::parse(work.read("one.json"));
  EXPECT_EQ(both["points"], 220000);
  EXPECT_EQ(both["simplices"], 219955);
  EXPECT_EQ(both["canonical_hash"], one["canonical_hash"]);
}

}  // namespace
}  // namespace spillway::test
