#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/halved_box.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A workspace with three point files in `in`, of which bad.las is broken.
class Batch : public ::testing::Test {
 protected:
  Batch() {
    space.succeed(
        "mkdir in && spillway generate terrain -n 2000 --seed 1 -o in/north.las &&"
        "spillway generate uniform --dim 3 -n 1000 --seed 2 -o in/south.spp &&"
        "head -c 5000 in/north.las > in/bad.las");
  }

  [[nodiscard]] nlohmann::json record(const std::string& job) const {
    return nlohmann::json::parse(space.read("out/" + job + ".status.json"));
  }

  [[nodiscard]] std::string mesh_hash(const std::string& points) const {
    space.succeed("spillway triangulate -q " + points + " -o hash.spm");
    return space.info("hash.spm")["canonical_hash"];
  }

  Workspace space;
};

TEST_F(Batch, DoesTheOtherJobsWhenOneFails) {
  const Result result = space.run("spillway batch 'in/*' --output-dir out --to ply");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(space.has("out/north.ply"));
  EXPECT_TRUE(space.has("out/south.ply"));
  EXPECT_FALSE(space.has("out/bad.ply"));
  EXPECT_THAT(result.err, HasSubstr("3 jobs: 2 done, 1 failed, 0 unchanged"));
  EXPECT_THAT(result.err, HasSubstr("failed: bad (out/bad.log)"));
  EXPECT_THAT(space.read("out/bad.log"), HasSubstr("the file ends at byte 5000"));
  EXPECT_EQ(record("bad")["status"], "failed");
  EXPECT_THAT(record("bad")["error"].get<std::string>(), HasSubstr("the file ends"));
  EXPECT_EQ(record("north")["status"], "done");
}

TEST_F(Batch, MakesSeveralOutputsOfOneTriangulation) {
  space.succeed("spillway batch in/north.las --output-dir out --to ply,vtu,spm");
  space.succeed("spillway triangulate in/north.las -o north.ply");
  const std::string hash = space.info("north.ply")["canonical_hash"];
  for (const char* name : {"out/north.ply", "out/north.vtu", "out/north.spm"}) {
    EXPECT_EQ(space.info(name)["canonical_hash"], hash) << name;
  }
}

TEST_F(Batch, DoesAJobWhoseHeadersAreFalse) {
  space.succeed("spillway generate terrain -n 40000 -q --grid 7x7 -o 'in/t_#.las'");
  halve_box(space, "in/t_04_04.las");
  space.write("jobs.toml",
              "to = ['spm', 'ply']\noptions = { tile = 2000 }\n[[jobs]]\nname = 'all'\n"
              "in = 'in/t_*.las'\n");
  space.succeed("spillway batch jobs.toml --output-dir out");
  EXPECT_THAT(space.read("out/all.log"), HasSubstr("all points are read again"));
  const std::string hash = mesh_hash("--no-trust-headers 'in/t_*.las'");
  EXPECT_EQ(space.info("out/all.spm")["canonical_hash"], hash);
  EXPECT_EQ(space.info("out/all.ply")["canonical_hash"], hash);
}

TEST_F(Batch, LeavesNoTemporaryMeshBehind) {
  space.succeed(
      "mkdir tmp && spillway batch in/north.las --output-dir out --to ply,vtu --scratch-folder "
      "tmp");
  EXPECT_EQ(space.succeed("ls -A tmp"), "");
  EXPECT_FALSE(space.has("out/north.spm"));
}

TEST_F(Batch, PassesOptionsOnToTheJobs) {
  space.succeed("spillway batch in/south.spp --output-dir out --to ply --dim 3");
  EXPECT_EQ(space.info("out/south.ply")["dimension"], 3);
}

TEST_F(Batch, SharesTheDiskOutAmongTheJobs) {
  space.succeed("spillway generate -q terrain -n 2e6 -o large.las");
  const std::string command = "spillway batch large.las --output-dir out --to spm --memory 64M";
  const Result result = space.run(command + " --max-tmp 1M");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(space.read("out/large.log"), HasSubstr("raise --max-tmp or --memory"));
  space.succeed(command + " --max-tmp 64M");
}

TEST_F(Batch, TakesFlagsWithoutValues) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed(
      "spillway batch --id in/north.las --output-dir out --to ply,dem.tif --cog --resolution 5");
  EXPECT_EQ(space.info("out/north.ply")["input_index"], true);
  EXPECT_TRUE(space.has("out/north.dem.tif"));
}

TEST_F(Batch, SaysFailuresWithQuietToo) {
  const Result result = space.run("spillway batch in/bad.las --output-dir out --to ply -q");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "spillway: failed: bad (out/bad.log)\n");
}

TEST_F(Batch, ReadsAListInToml) {
  space.write("in/jobs.toml",
              "to = ['ply']\n[[jobs]]\nin = 'south.spp'\noptions = { dim = 3 }\n"
              "[[jobs]]\nname = 'both'\nin = ['north.las', 'south.spp']\nto = 'obj'\n");
  space.succeed("spillway batch in/jobs.toml --output-dir out");
  EXPECT_EQ(space.info("out/south.ply")["dimension"], 3);
  EXPECT_TRUE(space.has("out/both.obj"));
}

TEST_F(Batch, ReadsAListInJson) {
  space.write("jobs.json", R"({"jobs": [{"in": "in/north.las", "to": ["off"]}]})");
  space.succeed("spillway batch jobs.json --output-dir out");
  EXPECT_TRUE(space.has("out/north.off"));
}

TEST_F(Batch, RefusesAListWithMistakesBeforeAnyWork) {
  const auto error_of_list = [&](const std::string& name, const std::string& content) {
    space.write(name, content);
    const Result result = space.run("spillway batch " + name + " --output-dir out --to ply");
    EXPECT_NE(result.exit_code, 0);
    EXPECT_FALSE(space.has("out"));
    return result.err;
  };
  EXPECT_THAT(error_of_list("a.json", "{"), HasSubstr("a.json, byte 2: this is not JSON"));
  EXPECT_THAT(error_of_list("a.toml", "to = [\n\n=]"),
              HasSubstr("a.toml, line 3: this is not TOML"));
  EXPECT_THAT(error_of_list("b.json", "{}"), HasSubstr("there is no list \"jobs\""));
  EXPECT_THAT(error_of_list("c.json", R"({"jobs": [{"inn": "x"}]})"),
              HasSubstr("c.json, job 1: the key \"inn\" is not known"));
  EXPECT_THAT(error_of_list("d.json", R"({"jobs": [{"in": "in/north.las", "to": "dwg"}]})"),
              HasSubstr("no output can be made as \"dwg\""));
  EXPECT_THAT(
      error_of_list("e.json", R"({"jobs": [{"in": "in/north.las", "options": {"colour": 1}}]})"),
      HasSubstr("uses the option --colour"));
  EXPECT_THAT(
      error_of_list("f.json", R"({"jobs": [{"in": "in/north.las", "options": {"dim": 7}}]})"),
      HasSubstr("--dim"));
  EXPECT_THAT(error_of_list("g.json", R"({"jobs": [{"in": "a/x.las"}, {"in": "b/x.las"}]})"),
              HasSubstr("two jobs are called x, one of a/x.las and one of b/x.las"));
  EXPECT_THAT(
      error_of_list("h.json", R"({"jobs": [{"in": "in/north.las", "options": {"threads": 2}}]})"),
      HasSubstr("--threads is for all jobs together"));
  EXPECT_THAT(
      error_of_list("i.json", R"({"jobs": [{"in": "in/north.las", "to": ["ply", "ply"]}]})"),
      HasSubstr("the output ply appears twice"));
  EXPECT_THAT(
      error_of_list(
          "j.json",
          R"({"jobs": [{"in": "in/north.las", "options": {"tile": 9, "tile-points": 8}}]})"),
      HasSubstr("\"tile\" is the former name of \"tile-points\": give one of them"));
}

TEST_F(Batch, NamesBothInputsWhoseFilesWouldHaveTheSameNames) {
  space.succeed("cp in/north.las in/north.txt");
  const Result result =
      space.run("spillway batch in/north.las in/north.txt --output-dir out --to ply");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              HasSubstr("two jobs are called north, one of in/north.las and one of in/north.txt"));
  EXPECT_FALSE(space.has("out"));
}

TEST_F(Batch, TakesNoNameForAnOption) {
  space.succeed("cp in/north.las ./--help; cp in/north.las -- -x.las; cp in/north.las '[ab]'");
  space.write("jobs.json", R"({"to": ["ply", "obj"], "jobs": [
      {"in": ["--help"]}, {"in": "-*.las", "name": "--quiet"}, {"in": "[ab]"}]})");
  space.succeed("spillway batch jobs.json --output-dir=-o");
  const std::string hash = mesh_hash("in/north.las");
  for (const std::string name : {"--help", "--quiet", "[ab]"}) {
    EXPECT_EQ(space.info("./-o/" + name + ".ply")["canonical_hash"], hash) << name;
    EXPECT_TRUE(space.has("-o/" + name + ".obj")) << name;
  }
  space.succeed("spillway batch --output-dir out --to ply -- --help");
  EXPECT_TRUE(space.has("out/--help.ply"));
}

TEST_F(Batch, TakesNoValueForAnOptionAndNoOptionForAValue) {
  const auto error_of = [&](const std::string& options) {
    space.write("jobs.json",
                R"({"to": "ply", "jobs": [{"in": "in/north.las", "options": )" + options + "}]}");
    const Result result = space.run("spillway batch -q jobs.json --output-dir out");
    EXPECT_NE(result.exit_code, 0) << options;
    return result.err + (space.has("out") ? space.read("out/north.log") : "");
  };
  EXPECT_THAT(error_of(R"({"keep-class": "--help"})"),
              HasSubstr("--keep-class: \"--help\" is not a list of classes"));
  EXPECT_THAT(error_of(R"({"max-edge": "-q"})"),
              HasSubstr("--max-edge: \"-q\" is not a number above 0"));
  for (const char* const nothing : {"\"\"", "true", "[]", "[\"1\", \"\"]"}) {
    EXPECT_THAT(error_of(std::string(R"({"bounds": )") + nothing + "}"),
                HasSubstr("north: --bounds has no value: give one, or leave it out"));
  }
  EXPECT_THAT(error_of(R"({"help": true})"), HasSubstr("uses the option --help"));
}

TEST_F(Batch, SaysThatAFolderCannotBeWritten) {
  space.write("file", "");
  const Result no_folder = space.run("spillway batch 'in/*' --output-dir file/out --to ply");
  EXPECT_EQ(no_folder.exit_code, 1);
  EXPECT_EQ(no_folder.err,
            "spillway: error: --output-dir: cannot create the folder file/out: Not a directory; "
            "choose another one\n");
  const Result no_scratch =
      space.run("TMPDIR=none spillway batch 'in/*' --output-dir out --to ply");
  EXPECT_EQ(no_scratch.exit_code, 1);
  EXPECT_THAT(no_scratch.err, HasSubstr("cannot create a temporary folder in none: No such file or "
                                        "directory; choose another folder with --scratch-folder"));
  EXPECT_FALSE(space.has("out"));
}

TEST_F(Batch, SaysThatAFolderIsProtected) {
  const std::string other = "setpriv --reuid 54321 --regid 54321 --clear-groups ";
  space.succeed("mkdir locked; chmod 755 . .. locked");
  if (geteuid() != 0 ||
      space.run(other + "test -x " + command_path() + " -a -r in").exit_code != 0) {
    GTEST_SKIP() << "cannot run as another user";
  }
  const Result result =
      space.run(other + command_path() + " batch 'in/*' --output-dir locked --to ply");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "spillway: error: --output-dir: cannot write to locked: Permission denied; choose "
            "another folder, or change its permissions\n");
}

TEST_F(Batch, ResumeLeavesOutWhatIsCompleteAndUnchanged) {
  space.succeed("rm in/bad.las");
  const std::string command = "spillway batch 'in/*' --output-dir out --to ply --resume";
  EXPECT_THAT(space.run(command).err, HasSubstr("2 done, 0 failed, 0 unchanged"));
  EXPECT_THAT(space.run(command).err, HasSubstr("0 done, 0 failed, 2 unchanged"));
  EXPECT_THAT(space.run(command + " --max-edge 100").err, HasSubstr("2 done"));
  EXPECT_THAT(space.run(command + " --max-edge 100").err, HasSubstr("2 unchanged"));
  space.succeed("spillway generate terrain -n 2001 --seed 1 -o in/north.las");
  EXPECT_THAT(space.run(command + " --max-edge 100").err,
              HasSubstr("1 done, 0 failed, 1 unchanged"));
  space.succeed("rm out/south.ply");
  EXPECT_THAT(space.run(command + " --max-edge 100").err,
              HasSubstr("1 done, 0 failed, 1 unchanged"));
}

TEST_F(Batch, GoesOnWhenInputsOrRecordsOfAJobMakeNoSense) {
  space.write("jobs.json",
              R"({"jobs": [{"in": "in/none-*.las", "name": "none"}, {"in": "in/north.las"}]})");
  space.succeed("mkdir out && echo '{\"status\": 3}' > out/north.status.json");
  const Result result = space.run("spillway batch jobs.json --output-dir out --to ply --resume");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("2 jobs: 1 done, 1 failed"));
  EXPECT_TRUE(space.has("out/north.ply"));
}

}  // namespace
}  // namespace spillway::test
