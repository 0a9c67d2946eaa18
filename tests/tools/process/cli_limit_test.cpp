// Processes that may have little memory or few threads: success, or one line that says what is
// missing, and nothing left behind.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // whose runs need terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

class Limits : public ::testing::Test {
 protected:
  Limits() {
    work_.succeed("spillway generate -q terrain -n 2e5 -o in.las; mkdir out tmp");
    std::filesystem::permissions(work_.folder().parent_path(), std::filesystem::perms::all);
    for (const char* const folder : {"out", "tmp"}) {
      std::filesystem::permissions(work_.folder() / folder, std::filesystem::perms::all);
    }
  }

  /// Runs the command behind one that sets a limit; returns whether it came to its end.
  bool succeeds(const std::string& limit, const std::string& command, const std::string& what) {
    const Result result =
        work_.run(fmt::format("export TMPDIR=\"$PWD/tmp\"; {} {}", limit, command));
    const bool success = result.exit_code == 0;
    if (success) {
      EXPECT_EQ(result.err, "") << limit;
      work_.succeed("rm -f out/*");
    } else {
      EXPECT_EQ(result.exit_code, 1) << limit << ": " << command << "\n" << result.err;
      EXPECT_THAT(result.err, StartsWith("spillway: error: ")) << limit;
      EXPECT_THAT(result.err, AnyOf(HasSubstr(what), HasSubstr("(ulimit -v)"))) << limit;
      EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << limit << "\n" << result.err;
    }
    EXPECT_EQ(work_.succeed("ls -A out tmp"), "out:\n\ntmp:\n") << limit << ": " << command;
    return success;
  }

  Workspace work_;
};

TEST_F(Limits, OfMemory) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  if (kSanitized) GTEST_SKIP() << "not with a sanitizer";
  const std::string command = command_path();
  for (const std::string arguments :
       {"triangulate -q in.las -o out/mesh.ply --threads 8 --memory 32M",
        "dem -q in.las -o out/dem.tif --resolution 5 --threads 4", "info -q in.las > /dev/null"}) {
    int failures = 0;
    for (const int kibibytes : {26000, 34000, 38000, 40000, 41000, 42000, 43000, 49250,
                                56000, 80000, 100000, 200000, 600000, 2000000}) {
      const bool success =
          succeeds(fmt::format("ulimit -v {}; timeout 60", kibibytes), command + " " + arguments,
                   fmt::format("ulimit -v is {}", kibibytes));
      failures += success ? 0 : 1;
      EXPECT_TRUE(success || kibibytes < 2000000) << arguments;
    }
    EXPECT_GT(failures, 1) << arguments;
  }
}

TEST_F(Limits, OfThreads) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  if (kSanitized) GTEST_SKIP() << "not with a sanitizer";
  // The superuser has no such limit; a user that nothing else runs as has it for this alone.
  const std::string other = "setpriv --reuid 54321 --regid 54321 --clear-groups ";
  if (geteuid() != 0 ||
      work_.run("prlimit --nproc=2 " + other + "test -x " + command_path() + " -a -r in.las")
              .exit_code != 0) {
    GTEST_SKIP() << "cannot run as another user";
  }
  for (const std::string arguments :
       {"triangulate -q in.las -o out/mesh.ply --threads 6 --memory 32M",
        "dem -q in.las -o out/dem.tif --resolution 5 --threads 6"}) {
    int failures = 0;
    for (int processes = 2; processes < 16; ++processes) {
      const bool success =
          succeeds(fmt::format("timeout 60 prlimit --nproc={}", processes),
                   fmt::format("{} {} {}", other, command_path(), arguments),
                   fmt::format("cannot start a thread: the limit of processes or of memory is "
                               "reached (ulimit -u is {}",
                               processes));
      failures += success ? 0 : 1;
      EXPECT_TRUE(success || processes < 15) << arguments;
    }
    EXPECT_GT(failures, 1) << arguments;
  }
}

}  // namespace
}  // namespace spillway::test
