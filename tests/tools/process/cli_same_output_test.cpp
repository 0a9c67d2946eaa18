// Runs that write to one name at the same time: each ends well, the last one wins, and what is
// there is whole.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

class SameOutput : public ::testing::Test {
 protected:
  SameOutput() {
    work_.succeed(
        "mkdir out; spillway generate -q terrain -n 6000 --seed 1 -o a.las\n"
        "spillway generate -q terrain -n 5000 --seed 2 -o b.las\n"
        "spillway triangulate -q a.las -o a.spm; spillway triangulate -q b.las -o b.spm");
    a_ = work_.info("a.spm")["canonical_hash"];
    b_ = work_.info("b.spm")["canonical_hash"];
  }

  /// Runs the command, in which IN is an input, for both inputs, each three times, all at once.
  void run_all(std::string command) const {
    const std::string::size_type place = command.find("IN");
    std::string script = "pids=\n";
    for (const std::string input : {"a.las", "b.las", "a.las", "b.las", "a.las", "b.las"}) {
      script += std::string(command).replace(place, 2, input) + " & pids=\"$pids $!\"\n";
    }
    script += "bad=0; for p in $pids; do wait $p || bad=$((bad + 1)); done; exit $bad";
    const Result result = work_.run(script);
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.err;
    EXPECT_EQ(work_.run("ls -A out | grep -c part").out, "0\n") << command;
  }

  Workspace work_;
  std::string a_;
  std::string b_;
};

TEST_F(SameOutput, IsAWholeMesh) {
  for (const std::string name : {"m.ply", "m.spm", "m.npy", "m.vtu"}) {
    const std::string found = "out/" + (name == "m.npy" ? std::string("m_vertices.npy") : name);
    for (int round = 0; round < 4; ++round) {
      run_all("spillway triangulate -q IN -o out/" + name + " --stats out/stats.json");
      EXPECT_THAT(work_.succeed("spillway check -q " + found), HasSubstr("proved to be the"));
      EXPECT_THAT(work_.info(found)["canonical_hash"], AnyOf(a_, b_)) << name;
      EXPECT_TRUE(nlohmann::json::accept(work_.read("out/stats.json")));
    }
  }
}

TEST_F(SameOutput, IsAWholeSetOfFilesOfGdal) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  for (const std::string name : {"m.shp", "m.gpkg"}) {
    for (int round = 0; round < 2; ++round) {
      run_all("spillway triangulate -q IN -o out/" + name);
      work_.succeed("spillway check -q out/" + name);
    }
  }
  run_all("spillway dem -q IN -o out/dem.tif --resolution 20");
}

TEST_F(SameOutput, IsAWholeJobOfABatch) {
  work_.succeed("mkdir in; cp a.las in/job.las");
  run_all("spillway batch -q in --output-dir out --to ply,npy -j 1; : IN");
  work_.succeed("spillway check -q out/job.ply; spillway check -q out/job_vertices.npy");
  EXPECT_EQ(nlohmann::json::parse(work_.read("out/job.status.json"))["status"], "done");
  EXPECT_THAT(work_.read("out/job.log"), HasSubstr("vertices"));
}

}  // namespace
}  // namespace spillway::test
