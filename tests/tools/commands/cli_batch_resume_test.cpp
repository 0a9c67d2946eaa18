// A batch with --resume goes on in the midst of the jobs that were under way when it was killed.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/child_processes.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kFolder = "out/a.spm.resume";

/// A workspace with two files of points, of which each keeps a job busy for a while.
class ResumedBatch : public ::testing::Test {
 protected:
  ResumedBatch() {
    space.succeed(
        "mkdir in; spillway generate terrain -n 150000 --seed 1 -o in/a.las -q;"
        "spillway generate terrain -n 150000 --seed 2 -o in/b.las -q");
  }

  struct Budget {
    std::string jobs = "2";
    std::string memory = "256M";
  };

  [[nodiscard]] static std::vector<std::string> arguments(const std::string& kinds,
                                                          const Budget& budget) {
    return {
        "batch", "in", "--output-dir", "out",      "--to",        kinds,      "--tile-points",
        "5000",  "-j", budget.jobs,    "--memory", budget.memory, "--resume", "--checkpoint-every",
        "0.01"};
  }
  [[nodiscard]] static std::string command(const std::string& kinds) {
    return command(kinds, Budget());
  }
  [[nodiscard]] static std::string command(const std::string& kinds, const Budget& budget) {
    return fmt::format("spillway {}", fmt::join(arguments(kinds, budget), " "));
  }

  /// Sends a signal to a batch once the job of `a` has a checkpoint. With SIGKILL its jobs get it,
  /// too.
  void end_batch(int signal, const std::string& kinds = "spm") const {
    const pid_t batch = space.start(arguments(kinds, Budget()));
    while (!space.has(std::string(kFolder) + "/state")) {
      ASSERT_FALSE(space.has("out/a.spm")) << "it was too fast to be killed";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::vector<pid_t> jobs = children_of(batch);
    kill(batch, signal);
    if (signal == SIGKILL) {
      for (const pid_t job : jobs) kill(job, SIGKILL);
    }
    ASSERT_EQ(wait_for_exit(batch), 128 + signal);
    ASSERT_TRUE(space.has(kFolder));
  }

  /// The names of what is neither a complete output nor a log or a record.
  [[nodiscard]] std::vector<std::string> left() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(space.folder() / "out")) {
      const std::string extension = entry.path().extension();
      if (extension == ".resume" || extension == ".part") names.push_back(entry.path().filename());
    }
    return names;
  }

  [[nodiscard]] nlohmann::json record(const std::string& job) const {
    return nlohmann::json::parse(space.read("out/" + job + ".status.json"));
  }

  void expect_the_bytes_of_an_undisturbed_batch() const {
    space.succeed("mv out killed && " + command("spm") + " -q && cmp out/a.spm killed/a.spm &&" +
                  "cmp out/b.spm killed/b.spm");
  }

  Workspace space;
};

TEST_F(ResumedBatch, GoesOnAndEndsWithTheSameBytes) {
  end_batch(SIGKILL);
  EXPECT_EQ(record("a")["status"], "running");
  const Result result = space.run(command("spm"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: goes on with out/a.spm.resume"));
  EXPECT_THAT(result.err, HasSubstr("2 jobs: 2 done"));
  EXPECT_THAT(space.read("out/a.log"), HasSubstr("goes on with the run in out/a.spm.resume"));
  EXPECT_THAT(left(), IsEmpty());
  EXPECT_EQ(record("a")["status"], "done");
  EXPECT_THAT(space.run(command("spm")).err, HasSubstr("0 done, 0 failed, 2 unchanged"));
  expect_the_bytes_of_an_undisturbed_batch();
}

TEST_F(ResumedBatch, GoesOnWhenItWasInterrupted) {
  end_batch(SIGTERM);
  const Result result = space.run(command("spm"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: goes on with out/a.spm.resume"));
  EXPECT_THAT(left(), IsEmpty());
  expect_the_bytes_of_an_undisturbed_batch();
}

TEST_F(ResumedBatch, RemovesRecordsThatWereNotComplete) {
  space.succeed("mkdir out; touch out/a.status.json.Ab12Cd.part out/other.json.Ab12Cd.part");
  space.succeed(command("spm"));
  EXPECT_THAT(left(), ::testing::ElementsAre("other.json.Ab12Cd.part"));
}

TEST_F(ResumedBatch, GoesOnWithTheMemoryThatAJobHadWhateverTheOthersGet) {
  end_batch(SIGKILL);
  const Result result = space.run(command("spm", {"1", "1G"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: goes on with out/a.spm.resume"));
  EXPECT_THAT(left(), IsEmpty());
  expect_the_bytes_of_an_undisturbed_batch();
}

TEST_F(ResumedBatch, BeginsAJobAgainThatHadMoreMemory) {
  end_batch(SIGKILL);
  const Result result = space.run(command("spm", {"2", "64M"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              HasSubstr("a: begins again, as it had 128 MiB of memory, more than there is"));
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(ResumedBatch, BeginsAJobAgainThatIsAnotherOne) {
  end_batch(SIGKILL);
  space.succeed("spillway generate terrain -n 1000 -o in/a.las");
  const Result result = space.run(command("spm"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: begins again, as its options, its inputs or the version "
                                    "are other ones than before"));
  EXPECT_EQ(space.info("out/a.spm")["points"], 1000);
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(ResumedBatch, KeepsNothingWithoutResume) {
  end_batch(SIGKILL);
  const Result result = space.run("spillway batch in/a.las --output-dir out --to spm");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: begins again, as --resume is not given"));
  EXPECT_THAT(left(), Not(::testing::Contains(::testing::StartsWith("a."))));
}

TEST_F(ResumedBatch, SaysWhichFileOfAJobIsDamagedAndWhatToRemove) {
  end_batch(SIGKILL);
  space.succeed("truncate -s 100 out/a.spm.resume/state");
  for (int time = 0; time < 2; ++time) {
    const Result result = space.run(command("spm"));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("a: failed"));
    EXPECT_THAT(result.err, HasSubstr("out/a.spm.resume/state"));
    EXPECT_THAT(result.err, HasSubstr("remove out/a.spm.resume to begin again"));
  }
  space.succeed("rm -r out/a.spm.resume && " + command("spm"));
}

TEST_F(ResumedBatch, GoesOnWithTheMeshOfWhichOtherOutputsAreMade) {
  end_batch(SIGKILL, "spm,ply");
  const Result result = space.run(command("spm,ply"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a: goes on with out/a.spm.resume"));
  EXPECT_THAT(left(), IsEmpty());
  EXPECT_EQ(space.info("out/a.ply")["canonical_hash"], space.info("out/a.spm")["canonical_hash"]);
}

TEST_F(ResumedBatch, DoesWhatCannotGoOnAsBefore) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed(
      "spillway triangulate -q in/a.las -o mesh.spm;"
      "spillway batch mesh.spm --output-dir out --to dem.tif --resolution 5 --resume;"
      "spillway batch in/b.las --output-dir out --to ply,dem.tif --resolution 5 --resume");
  EXPECT_TRUE(space.has("out/mesh.dem.tif"));
  EXPECT_TRUE(space.has("out/b.dem.tif"));
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(ResumedBatch, LeavesNothingOfJobsThatFail) {
  space.succeed("head -c 5000 in/a.las > in/c.las; rm in/a.las in/b.las");
  EXPECT_EQ(space.run(command("spm")).exit_code, 1);
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(ResumedBatch, HasNoUseForCheckpointsWithoutResume) {
  const Result result =
      space.run("spillway batch in --output-dir out --to spm --checkpoint-every 1");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--checkpoint-every has no effect without --resume"));
}

}  // namespace
}  // namespace spillway::test
