// A batch that is interrupted ends when its jobs have ended, and none of them leaves anything.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/child_processes.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

void sleep_for(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// A workspace with four files that take a while, and a folder for temporary ones.
class InterruptedBatch : public ::testing::TestWithParam<int> {
 protected:
  InterruptedBatch() {
    space.succeed(
        "mkdir in tmp; spillway generate uniform -n 1e6 -o in/a.spp -q;"
        "for i in b c d; do cp in/a.spp in/$i.spp; done");
  }

  /// Two outputs of each, of which the mesh stream is in the temporary folder.
  [[nodiscard]] static std::vector<std::string> arguments() {
    return {"batch",   "in",
            "-q",      "--output-dir",
            "out",     "--to",
            "ply,obj", "-j",
            "4",       "--threads",
            "4",       "--memory",
            "1G",      "--scratch-folder",
            "tmp"};
  }

  [[nodiscard]] bool has_begun() const { return names_in("tmp").size() == 1; }

  [[nodiscard]] std::vector<std::string> names_in(const std::string& folder) const {
    std::vector<std::string> names;
    std::error_code missing;
    for (std::filesystem::directory_iterator entry(space.folder() / folder, missing), end;
         !missing && entry != end; entry.increment(missing)) {
      if (entry->path().extension() != ".log") names.push_back(entry->path().filename().string());
    }
    return names;
  }

  /// Sends a signal to a batch that has begun, after a while, and returns the exit code.
  [[nodiscard]] int interrupt(int number, int milliseconds) const {
    const pid_t process = space.start(arguments());
    for (int i = 0; i < 2000 && !has_begun(); ++i) sleep_for(5);
    sleep_for(milliseconds);
    kill(process, number);
    return wait_for_exit(process);
  }

  Workspace space;
};

TEST_P(InterruptedBatch, LeavesNothingOfItsJobs) {
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  int interrupted = 0;
  for (int run = 0; run < 6; ++run) {
    const int exit_code = interrupt(GetParam(), static_cast<int>(random() % 1500));
    ASSERT_THAT(names_in("tmp"), IsEmpty()) << "run " << run;
    for (const std::string& name : names_in("out")) {
      ASSERT_FALSE(name.ends_with(".part")) << "run " << run << ": " << name;
    }
    if (exit_code == 0) continue;
    ++interrupted;
    ASSERT_EQ(exit_code, 128 + GetParam());
    ASSERT_EQ(space.messages(),
              fmt::format("spillway: interrupted by SIG{}\n", sigabbrev_np(GetParam())));
  }
  EXPECT_GT(interrupted, 0);
}

INSTANTIATE_TEST_SUITE_P(BySignal, InterruptedBatch, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& test) { return std::string(sigabbrev_np(test.param)); });

using SignalledBatch = InterruptedBatch;

TEST_F(SignalledBatch, WhoseWholeGroupIsSignalledSaysSoOnce) {
  // `timeout` signals the group that it makes, as a terminal does on Ctrl-C.
  const Result result = space.run(fmt::format("timeout --preserve-status -s INT 1 {} {}",
                                              command_path(), fmt::join(arguments(), " ")));
  EXPECT_EQ(result.exit_code, 128 + SIGINT);
  EXPECT_EQ(result.err, "spillway: interrupted by SIGINT\n");
  EXPECT_THAT(names_in("tmp"), IsEmpty());
}

TEST_F(SignalledBatch, EndsJobsThatAreHeld) {
  const pid_t process = space.start(arguments());
  std::vector<pid_t> children;
  for (int i = 0; i < 2000 && !(has_begun() && children.size() == 4); ++i) {
    sleep_for(5);
    children = children_of(process);
  }
  EXPECT_THAT(children, SizeIs(4));
  for (const pid_t child : children) kill(child, SIGSTOP);
  kill(process, SIGTERM);
  EXPECT_EQ(wait_for_exit(process), 128 + SIGTERM);
  EXPECT_THAT(names_in("tmp"), IsEmpty());
}

}  // namespace
}  // namespace spillway::test
