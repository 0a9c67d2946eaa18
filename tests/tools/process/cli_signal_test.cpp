// Signals: the exit code, a line that tells, and nothing left behind, at whatever moment they come.

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Starts a command, waits until `ready`, sends the signal and returns the exit code.
int interrupt(const Workspace& work, const std::vector<std::string>& arguments, int signal_number,
              const std::function<bool()>& ready) {
  const pid_t process = work.start(arguments);
  bool was_ready = ready();  // it need not stay so
  for (int i = 0; i < 12000 && !was_ready; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    was_ready = ready();
  }
  EXPECT_TRUE(was_ready);
  kill(process, signal_number);
  return wait_for_exit(process);
}

class Interrupted : public ::testing::TestWithParam<int> {};

TEST_P(Interrupted, LongGenerateLeavesNothingBehind) {
  const Workspace work;
  const int exit_code =
      interrupt(work, {"generate", "terrain", "-n", "1e9", "-o", "long.las", "-q"}, GetParam(),
                [&] { return work.has_unfinished("long.las"); });
  EXPECT_EQ(exit_code, 128 + GetParam());
  EXPECT_TRUE(work.names().empty());
  EXPECT_EQ(work.messages(),
            fmt::format("spillway: interrupted by SIG{}; nothing was written to long.las\n",
                        sigabbrev_np(GetParam())))
      << "with -q, too";
}

/// Whether there are folders of unfinished files with two files or more in them: the one that is
/// made on trial has fewer.
bool has_unfinished_files(const Workspace& work) {
  std::error_code missing;
  int files = 0;
  for (std::filesystem::recursive_directory_iterator entry(work.folder(), missing), end;
       !missing && entry != end; entry.increment(missing)) {
    files += entry.depth() > 0 ? 1 : 0;
  }
  return files >= 2;
}

/// The folder is made once before, to see whether that can be done.
TEST_P(Interrupted, LongGridLeavesNothingBehind) {
  const Workspace work;
  const int exit_code = interrupt(
      work, {"generate", "terrain", "-n", "3e7", "--grid", "9x9", "-o", "long_#.las", "-q"},
      GetParam(), [&] { return has_unfinished_files(work); });
  EXPECT_EQ(exit_code, 128 + GetParam());
  EXPECT_TRUE(work.names().empty());
  EXPECT_EQ(work.messages(),
            fmt::format("spillway: interrupted by SIG{}; nothing was written to long_#.las\n",
                        sigabbrev_np(GetParam())));
}

TEST_P(Interrupted, ProgramsReadThatAsJson) {
  const Workspace work;
  interrupt(work, {"generate", "terrain", "-n", "1e9", "-o", "long.las", "--progress", "json"},
            GetParam(), [&] { return work.has_unfinished("long.las"); });
  std::istringstream lines(work.messages());
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  const auto json = nlohmann::json::parse(last, nullptr, false);
  ASSERT_TRUE(json.contains("message")) << last;
  EXPECT_THAT(json["message"].get<std::string>(), HasSubstr("nothing was written to long.las"));
}

TEST_P(Interrupted, WaitingForInputEnds) {
  const Workspace work;
  const auto start = std::chrono::steady_clock::now();
  const auto a_while = [&] {
    return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(300);
  };
  EXPECT_EQ(interrupt(work, {"info", "-", "-q"}, GetParam(), a_while), 128 + GetParam());
}

INSTANTIATE_TEST_SUITE_P(BySignal, Interrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& test) { return std::string(sigabbrev_np(test.param)); });

TEST(Signals, OfTheFirstMomentsLeaveNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 1e6 -o in.las; mkdir tmp");
  const auto before = work.names();
  std::mt19937 random(22);
  for (int run = 0; run < 40; ++run) {
    const pid_t process =
        work.start({"triangulate", "-q", "in.las", "-o", "mesh.ply", "--scratch-folder", "tmp"});
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
    kill(process, SIGTERM);
    EXPECT_EQ(wait_for_exit(process), 128 + SIGTERM);
    EXPECT_THAT(work.messages(), ::testing::AnyOf("", StartsWith("spillway: interrupted by SIG")))
        << "before main a signal ends the process at once";
    ASSERT_EQ(work.names(), before) << "run " << run;
    ASSERT_TRUE(std::filesystem::is_empty(work.folder() / "tmp")) << "run " << run;
  }
}

/// As what a batch starts: a signal that comes between fork and main waits.
TEST(Signals, ThatWaitWhereTheyAreBlockedAreTakenInMain) {
  const Workspace work;
  const std::string output = (work.folder() / "long.las").string();
  const std::string messages = (work.folder() / "messages").string();
  const pid_t process = fork();
  ASSERT_GE(process, 0);
  if (process == 0) {
    sigset_t term;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    sigprocmask(SIG_BLOCK, &term, nullptr);
    kill(getpid(), SIGTERM);
    dup2(open(messages.c_str(), O_WRONLY | O_CREAT, 0666), STDERR_FILENO);
    execl(command_path().c_str(), "spillway", "generate", "terrain", "-n", "1e9", "-q", "-o",
          output.c_str(), nullptr);
    _exit(1);
  }
  EXPECT_EQ(wait_for_exit(process), 128 + SIGTERM);
  EXPECT_THAT(work.read("messages"), StartsWith("spillway: interrupted by SIGTERM"));
  EXPECT_THAT(work.names(), ::testing::ElementsAre("messages"));
}

/// A signal that comes after the output has its name finds it complete.
TEST(Signals, WhileScratchFilesComeAndGoLeaveNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 1e6 -o in.las; mkdir tmp");
  const auto before = work.names();
  const std::filesystem::path mesh = work.folder() / "mesh.ply";
  work.succeed("spillway triangulate -q in.las -o mesh.ply --tile-points 4000 --memory 32M");
  const std::uintmax_t complete_size = file_size(mesh);
  remove(mesh);
  std::mt19937 random(20);
  constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
  int interrupted = 0;
  for (int run = 0; run < 14; ++run) {
    const pid_t process =
        work.start({"triangulate", "-q", "in.las", "-o", "mesh.ply", "--tile-points", "4000",
                    "--memory", "32M", "--scratch-folder", "tmp"});
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 700));
    const int number = kSignals[run % kSignals.size()];
    kill(process, number);
    const int exit_code = wait_for_exit(process);
    if (exists(mesh)) {
      EXPECT_EQ(file_size(mesh), complete_size);
      EXPECT_THAT(work.messages(), Not(HasSubstr("nothing was written")));
      remove(mesh);
    } else {
      EXPECT_NE(exit_code, 0);
    }
    EXPECT_THAT(exit_code, ::testing::AnyOf(0, 128 + number)) << work.messages();
    if (exit_code != 0) ++interrupted;
    // Before main a signal ends the process at once.
    EXPECT_THAT(work.messages(), ::testing::AnyOf("", StartsWith("spillway: interrupted by SIG")));
    ASSERT_EQ(work.names(), before) << "run " << run;
    ASSERT_TRUE(std::filesystem::is_empty(work.folder() / "tmp")) << "run " << run;
  }
  EXPECT_GT(interrupted, 0);
}

TEST(Signals, WhileGdalWritesLeaveNothing) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 3e5 -o in.las; mkdir tmp");
  const auto before = work.names();
  std::mt19937 random(21);
  const std::vector<std::string> outputs = {"lines.shp", "lines.gpkg", "lines.dxf"};
  for (std::size_t run = 0; run < 3 * outputs.size(); ++run) {
    const std::string& output = outputs[run % outputs.size()];
    const pid_t process = work.start(
        {"contour", "-q", "in.las", "-o", output, "--interval", "1", "--scratch-folder", "tmp"});
    // GDAL's folder is there, and not only the file by which an output is tried at the beginning.
    for (int i = 0; i < 1000 && work.run("test -d " + output + ".*.part").exit_code != 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 50));
    kill(process, SIGTERM);
    EXPECT_EQ(wait_for_exit(process), 128 + SIGTERM);
    EXPECT_THAT(work.messages(), HasSubstr("nothing was written to " + output));
    ASSERT_EQ(work.names(), before) << "run " << run;
    ASSERT_TRUE(std::filesystem::is_empty(work.folder() / "tmp")) << "run " << run;
  }
}

TEST(Signals, EndARunWhoseMessagesNobodyTakes) {
  const Workspace work;
  // The pipe is full, and its reader takes nothing.
  const Result result = work.run(
      "mkfifo pipe; sleep 20 < pipe & reader=$!\n"
      "{ " +
      command_path() +
      " generate uniform -n 1e9 -o long.npy -q & run=$!\n"
      "head -c 65536 /dev/zero >&2; sleep 0.3; kill -TERM $run; wait $run; echo $? > code; } 2> "
      "pipe\n"
      "kill $reader");
  EXPECT_EQ(work.read("code"), "143\n") << result.err;
  EXPECT_FALSE(work.has_unfinished("long.npy"));
}

TEST(Signals, ATerminalsProgressLineIsWipedFirst) {
  const Workspace work;
  if (work.run("command -v script").exit_code != 0) GTEST_SKIP() << "no script";
  const Result result = work.run("TERM=xterm script -qec 'timeout -s INT 0.5 " + command_path() +
                                 " generate terrain -n 1e9 -o long.las' /dev/null");
  EXPECT_THAT(result.out, HasSubstr("\r\x1b[Kspillway: interrupted by SIGINT; nothing was written "
                                    "to long.las\r\n"));
}

}  // namespace
}  // namespace spillway::test
