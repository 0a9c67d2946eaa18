#include "formats/disk/scratch_folder.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/scratch_file.h"
#include "formats/disk/unfinished_files.h"
#include "tests/error_facts.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Scratch : public ::testing::Test {
 protected:
  Scratch() {
    std::string name = ::testing::TempDir() + "scratch_test_XXXXXX";
    parent_ = ::mkdtemp(name.data());
  }
  ~Scratch() override { fs::remove_all(parent_); }

  [[nodiscard]] std::unique_ptr<ScratchFolder> folder(
      std::optional<std::uint64_t> cap = std::nullopt) const {
    return make_scratch_folder(parent_, cap);
  }

  fs::path parent_;
};

std::string content(const ScratchFile& file, std::uint64_t offset, std::size_t size) {
  std::vector<std::byte> buffer(size);
  file.read(offset, buffer);
  return std::string(as_text(buffer));
}

TEST_F(Scratch, WhatIsAppendedIsRead) {
  const auto scratch = folder();
  const auto first = scratch->create("tile");
  const auto second = scratch->create("tile");
  first->append(as_bytes_of("hello "));
  second->append(as_bytes_of("other"));
  first->append(as_bytes_of("world"));
  EXPECT_EQ(first->size(), 11U);
  EXPECT_EQ(content(*first, 0, 11), "hello world");
  EXPECT_EQ(content(*first, 4, 5), "o wor");
  EXPECT_EQ(content(*second, 0, 5), "other");
  EXPECT_EQ(fs::path(first->name()).filename().string().substr(0, 4), "tile");
}

TEST_F(Scratch, TheFolderIsPrivateAndMadeWithTheFirstFile) {
  const auto scratch = folder();
  EXPECT_TRUE(fs::is_empty(parent_));
  const auto file = scratch->create("tile");
  const fs::path made = fs::path(file->name()).parent_path();
  EXPECT_EQ(made.parent_path(), parent_);
  EXPECT_THAT(made.filename().string(), StartsWith("spillway-"));
  EXPECT_EQ(fs::status(made).permissions(), fs::perms::owner_all);
}

TEST_F(Scratch, AFileThatIsNotNeededAnyMoreServesAnew) {
  const auto scratch = folder(10);
  auto first = scratch->create("tile");
  first->append(as_bytes_of("ten bytes."));
  const std::string name = first->name();
  first.reset();
  const auto other = scratch->create("mesh");
  EXPECT_NE(other->name(), name) << "it has another label";
  const auto again = scratch->create("tile");
  EXPECT_EQ(again->name(), name);
  EXPECT_EQ(again->size(), 0U);
  again->append(as_bytes_of("again"));
  EXPECT_EQ(content(*again, 0, 5), "again");
  EXPECT_THROW(content(*again, 5, 1), Failure);
  EXPECT_EQ(scratch->peak_bytes(), 10U);
  EXPECT_NE(scratch->create("tile")->name(), name) << "it is in use";
}

/// Lets files of this process become no longer than that while it lives.
class ShortFiles {
 public:
  explicit ShortFiles(rlim_t most) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit few{most, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &few);
    signal_ = ::signal(SIGXFSZ, SIG_IGN);
  }
  ~ShortFiles() {
    ::signal(SIGXFSZ, signal_);
    ::setrlimit(RLIMIT_FSIZE, &old_);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;

 private:
  rlimit old_{};
  sighandler_t signal_ = SIG_DFL;
};

TEST_F(Scratch, AFileOfWhichAWriteFailedHalfwayServesAnew) {
  const auto scratch = folder();
  auto first = scratch->create("tile");
  const std::string name = first->name();
  first->append(as_bytes_of("12345"));
  {
    const ShortFiles limit(8);
    EXPECT_THROW(first->append(as_bytes_of("67890")), Failure);
  }
  EXPECT_EQ(fs::file_size(name), 8U);
  first.reset();
  const auto again = scratch->create("tile");
  ASSERT_EQ(again->name(), name);
  again->append(as_bytes_of("hello world"));
  EXPECT_EQ(content(*again, 0, 11), "hello world");
}

TEST_F(Scratch, AFileThatHasBecomeLongIsRemoved) {
  const auto scratch = folder();
  std::vector<std::string> names;
  for (int i = 0; i < 4; ++i) {
    const auto file = scratch->create("tile");
    names.push_back(file->name());
    for (int mebibyte = 0; mebibyte < 24; ++mebibyte) {
      file->append(std::vector<std::byte>(1 << 20));
    }
  }
  EXPECT_EQ(names[2], names[0]);
  EXPECT_NE(names[3], names[0]) << "after 72 MiB";
  EXPECT_FALSE(fs::exists(names[0]));
}

TEST_F(Scratch, NothingIsLeft) {
  auto scratch = folder();
  auto first = scratch->create("tile");
  const auto second = scratch->create("tile");
  first->append(std::vector<std::byte>(1 << 20));
  const std::string name = first->name();
  first.reset();
  struct stat found {};
  ASSERT_EQ(::stat(name.c_str(), &found), 0);
  EXPECT_LE(found.st_blocks * 512, 8192) << "its bytes are gone at once";
  EXPECT_TRUE(fs::exists(second->name()));
  scratch.reset();
  EXPECT_TRUE(fs::is_empty(parent_));
}

TEST_F(Scratch, ASignalRemovesTheFolder) {
  const auto scratch = folder();
  const auto file = scratch->create("tile");
  file->append(as_bytes_of("x"));
  EXPECT_EXIT(
      {
        remove_unfinished_files();
        _exit(0);
      },
      ::testing::ExitedWithCode(0), "");
  EXPECT_TRUE(fs::is_empty(parent_));
}

TEST_F(Scratch, CountsBytes) {
  const auto scratch = folder();
  auto first = scratch->create("a");
  first->append(as_bytes_of("12345"));
  first.reset();
  const auto second = scratch->create("b");
  second->append(as_bytes_of("123"));
  EXPECT_EQ(scratch->bytes_written(), 8U);
  EXPECT_EQ(scratch->peak_bytes(), 5U);
}

TEST_F(Scratch, CountsBytesOfManyThreads) {
  const auto scratch = folder();
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 50; ++i) scratch->create("tile")->append(as_bytes_of("0123456789"));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(scratch->bytes_written(), 2000U);
  EXPECT_LE(scratch->peak_bytes(), 40U);
}

TEST_F(Scratch, TheCapHoldsForWhatIsThere) {
  const auto scratch = folder(10);
  auto first = scratch->create("a");
  const auto second = scratch->create("b");
  first->append(as_bytes_of("123456"));
  second->append(as_bytes_of("1234"));
  EXPECT_THAT(error_of([&] { second->append(as_bytes_of("5")); }),
              AllOf(HasSubstr("cannot write " + second->name()), HasSubstr("10 bytes")));
  EXPECT_EQ(facts_of([&] { second->append(as_bytes_of("5")); }).remedy, Remedy::kScratchLimit);
  EXPECT_EQ(second->size(), 4U);
  first.reset();
  second->append(as_bytes_of("56789"));
  EXPECT_EQ(content(*second, 0, 9), "123456789");
}

TEST_F(Scratch, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "/dev/full is not there";
  ScratchUsage usage(std::nullopt);
  DiskScratchFile file("/dev/full", 0, 0, usage);
  const auto append = [&] { file.append(as_bytes_of("x")); };
  EXPECT_THAT(error_of(append), HasSubstr("cannot write /dev/full: No space left on device"));
  EXPECT_EQ(facts_of(append).file, "/dev/full");
  EXPECT_EQ(facts_of(append).system_error, ENOSPC);
  EXPECT_EQ(facts_of(append).remedy, Remedy::kScratchFolder);
}

TEST_F(Scratch, ALinkInPlaceOfAFileIsNotFollowed) {
  const auto scratch = folder();
  const auto file = scratch->create("tile");
  const fs::path elsewhere = parent_ / "elsewhere";
  fs::rename(file->name(), elsewhere);
  fs::create_symlink(elsewhere, file->name());
  EXPECT_THROW(file->append(as_bytes_of("x")), SystemRefusal);
  EXPECT_EQ(fs::file_size(elsewhere), 0U);
}

TEST_F(Scratch, AFileThatShrankIsAnError) {
  const auto scratch = folder();
  const auto file = scratch->create("tile");
  file->append(as_bytes_of("12345"));
  fs::resize_file(file->name(), 3);
  EXPECT_THAT(error_of([&] { content(*file, 1, 4); }),
              AllOf(HasSubstr("cannot read " + file->name()), HasSubstr("ends at byte 3")));
  fs::remove(file->name());
  EXPECT_THAT(error_of([&] { content(*file, 1, 4); }), HasSubstr("No such file or directory"));
  EXPECT_THAT(error_of([&] { file->append(as_bytes_of("x")); }),
              HasSubstr("No such file or directory"));
}

TEST_F(Scratch, AMissingParentIsAnError) {
  const auto scratch = make_scratch_folder(parent_ / "none", std::nullopt);
  const auto create = [&] { scratch->create("tile"); };
  EXPECT_THAT(error_of(create),
              HasSubstr((parent_ / "none").string() + ": No such file or directory"));
  EXPECT_EQ(facts_of(create).remedy, Remedy::kScratchFolder);
}

TEST_F(Scratch, MoreFilesThanDescriptors) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &old), 0);
  const rlimit few{32, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  const auto scratch = folder();
  std::vector<std::unique_ptr<ScratchFile>> files;
  for (int i = 0; i < 100; ++i) {
    files.push_back(scratch->create("tile"));
    files.back()->append(as_bytes_of(std::to_string(100 + i)));
  }
  EXPECT_EQ(content(*files[42], 0, 3), "142");
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &old), 0);
}

TEST_F(Scratch, TheDefaultParentIsTheEnvironmentS) {
  ASSERT_EQ(::setenv("TMPDIR", parent_.c_str(), 1), 0);
  const auto file = make_scratch_folder("", std::nullopt)->create("tile");
  EXPECT_EQ(fs::path(file->name()).parent_path().parent_path(), parent_);
  ASSERT_EQ(::unsetenv("TMPDIR"), 0);
}

}  // namespace
}  // namespace spillway::test
