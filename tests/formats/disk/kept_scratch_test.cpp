#include "formats/disk/kept_scratch.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class KeptScratch : public ::testing::Test {
 protected:
  KeptScratch() {
    std::string name = ::testing::TempDir() + "kept_scratch_test_XXXXXX";
    parent_ = ::mkdtemp(name.data());
  }
  ~KeptScratch() override { fs::remove_all(parent_); }

  [[nodiscard]] std::string path() const { return (parent_ / "scratch").string(); }
  [[nodiscard]] static std::vector<std::byte> bytes(std::size_t count) {
    return std::vector<std::byte>(count, std::byte{5});
  }

  fs::path parent_;
};

TEST_F(KeptScratch, FilesThatNobodyNeedsStayUntilTheyAreReleased) {
  KeptScratchFolder folder(path(), std::nullopt);
  std::unique_ptr<ScratchFile> file = folder.create("tile");
  file->append(bytes(10));
  const std::string name = file->name();
  file.reset();
  EXPECT_TRUE(fs::exists(name));
  folder.sync();
  EXPECT_TRUE(fs::exists(name));
  folder.release();
  EXPECT_FALSE(fs::exists(name));
}

TEST_F(KeptScratch, FollowsNoLinksThatSomebodyHasPutThere) {
  fs::create_directory(parent_ / "elsewhere");
  fs::create_symlink("elsewhere", path());
  EXPECT_THROW(KeptScratchFolder(path(), std::nullopt), SystemRefusal);
  fs::remove(path());
  KeptScratchFolder folder(path(), std::nullopt);
  fs::create_symlink("../elsewhere/file", parent_ / "scratch" / "tile-1");
  EXPECT_THROW(static_cast<void>(folder.create("tile")), SystemRefusal);
  EXPECT_TRUE(fs::is_empty(parent_ / "elsewhere"));
}

TEST_F(KeptScratch, GoesOnWithNoFileButThoseOfItsOwn) {
  KeptScratchFolder folder(path(), std::nullopt);
  folder.create("tile")->append(bytes(10));
  EXPECT_THROW(static_cast<void>(folder.reopen("../scratch/tile-1", 10)), BadInput);
  fs::create_symlink("tile-1", parent_ / "scratch" / "tile-2");
  EXPECT_THROW(static_cast<void>(folder.reopen("tile-2", 5)), BadInput);
  EXPECT_EQ(fs::file_size(parent_ / "scratch" / "tile-1"), 10U);
}

TEST_F(KeptScratch, OthersCannotReadIt) {
  KeptScratchFolder folder(path(), std::nullopt);
  const auto file = folder.create("tile");
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(file->name()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(KeptScratch, OutlivesItsFolder) {
  std::string name;
  {
    KeptScratchFolder folder(path(), std::nullopt);
    const auto file = folder.create("tile");
    file->append(bytes(10));
    name = KeptScratchFolder::file_name_of(*file);
  }
  KeptScratchFolder folder(path(), std::nullopt);
  folder.go_on_after(1);
  const auto file = folder.reopen(name, 10);
  file->append(bytes(5));
  std::vector<std::byte> all(15);
  file->read(0, all);
  EXPECT_EQ(all, bytes(15));
  EXPECT_NE(folder.create("tile")->name(), file->name());
}

TEST_F(KeptScratch, OfWhichBytesAreMissingIsRefused) {
  KeptScratchFolder folder(path(), std::nullopt);
  const auto file = folder.create("tile");
  file->append(bytes(10));
  const auto error_of = [&](const std::string& name, std::uint64_t size) -> std::string {
    try {
      const auto reopened = folder.reopen(name, size);
    } catch (const Failure& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of(KeptScratchFolder::file_name_of(*file), 11),
              AllOf(HasSubstr(file->name()), HasSubstr("byte 10"), HasSubstr("11 bytes")));
  EXPECT_THAT(error_of("tile-7", 1), AllOf(HasSubstr("tile-7"), HasSubstr("No such file")));
}

TEST_F(KeptScratch, KeepsToItsCapAcrossProcesses) {
  {
    KeptScratchFolder folder(path(), 100);
    const auto file = folder.create("tile");
    file->append(bytes(80));
  }
  KeptScratchFolder folder(path(), 100);
  const auto file = folder.reopen("tile-1", 80);
  EXPECT_THROW(file->append(bytes(30)), Failure);
}

}  // namespace
}  // namespace spillway::test
