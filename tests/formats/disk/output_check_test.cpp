// An output is tried before the work without a trace in its folder, for a process that is killed
// meanwhile cleans nothing up.

#include "formats/disk/output_check.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "src/error.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using formats::check_can_create;

class OutputCheck : public ::testing::Test {
 protected:
  OutputCheck() {
    std::string name = ::testing::TempDir() + "spillway_check_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~OutputCheck() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  fs::path folder_;
};

TEST_F(OutputCheck, MakesNoNameInTheFolder) {
  const int unnamed = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (unnamed < 0) GTEST_SKIP() << "this file system has no files without names";
  ::close(unnamed);
  std::ofstream(path("old.tif")) << "old";
  const int watch = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  ASSERT_GE(::inotify_add_watch(watch, folder_.c_str(), IN_CREATE | IN_DELETE | IN_MOVE), 0);
  check_can_create(path("new.tif"));
  check_can_create(path("old.tif"));
  std::array<char, 4096> events{};
  EXPECT_LT(::read(watch, events.data(), events.size()), 0) << "something was created there";
  ::close(watch);
}

TEST_F(OutputCheck, SaysWhatCannotBeCreated) {
  const auto refusal_of = [&](const std::string& name) -> std::string {
    try {
      check_can_create(path(name));
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  };
  fs::create_directory(path("folder"));
  EXPECT_THAT(refusal_of("missing/x.tif"), ::testing::HasSubstr("create the folder"));
  EXPECT_THAT(refusal_of("folder"), ::testing::HasSubstr("Is a directory"));
  EXPECT_EQ(refusal_of("new.tif"), "");
}

}  // namespace
}  // namespace spillway::test
