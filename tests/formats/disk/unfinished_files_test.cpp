// What is written under temporary names, and that nothing of it is left when a run is ended. The
// end of the run is for good, so these tests end in processes of their own.

#include "formats/disk/unfinished_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/disk/file_system.h"
#include "formats/disk/folder_lock.h"
#include "formats/disk/scratch_folder.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::ExitedWithCode;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

constexpr std::chrono::milliseconds kAWhile{50};

class Unfinished : public ::testing::Test {
 protected:
  Unfinished() {
    std::string name = ::testing::TempDir() + "spillway_unfinished_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~Unfinished() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }

  static std::string content(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  [[nodiscard]] unsigned permissions(const std::string& name) const {
    return static_cast<unsigned>(fs::status(path(name)).permissions());
  }

  void write(const std::string& name, const std::string& text) const {
    const auto file = disk().create(path(name));
    file->write(as_bytes_of(text));
    file->commit();
  }

  /// In a process of its own: exit code 0 if the folder is empty after `work`.
  template <typename Work>
  void expect_that_nothing_is_left(const Work& work) {
    EXPECT_EXIT(
        {
          work();
          _exit(fs::is_empty(folder_) ? 0 : 1);
        },
        ExitedWithCode(0), "");
  }

  fs::path folder_;
};

TEST_F(Unfinished, TwoWritersOfOneNameDontMeetAndTheLastWins) {
  const auto first = disk().create(path("a"));
  const auto second = disk().create(path("a"));
  EXPECT_EQ(names().size(), 2U);
  for (const std::string& name : names())
    EXPECT_THAT(name, MatchesRegex("a\\.[0-9A-Za-z]{6}\\.part"));
  first->write(as_bytes_of("the first one"));
  second->write(as_bytes_of("second"));
  second->commit();
  EXPECT_EQ(content(path("a")), "second");
  first->commit();
  EXPECT_EQ(content(path("a")), "the first one");
  EXPECT_THAT(names(), ElementsAre("a"));
}

TEST_F(Unfinished, ANewFileHasThePermissionsThatTheUmaskLeaves) {
  const mode_t old = ::umask(027);
  write("a", "x");
  ::umask(old);
  EXPECT_EQ(permissions("a"), 0640U);
}

TEST_F(Unfinished, AReplacedFileKeepsItsPermissions) {
  write("a", "old");
  for (const auto mode : {0600U, 0664U, 0755U}) {
    fs::permissions(path("a"), static_cast<fs::perms>(mode));
    write("a", "new");
    EXPECT_EQ(permissions("a"), mode);
  }
}

TEST_F(Unfinished, NamesMayBeAsLongAsTheSystemTakes) {
  std::string umlauts;
  for (int i = 0; i < 127; ++i) umlauts += "\xC3\xA4";
  for (const std::string& name : {std::string(255, 'n'), umlauts, std::string(137, 'n')}) {
    const auto file = disk().create(path(name));
    const std::string temporary = fs::path(file->temporary_path()).filename();
    EXPECT_LT(temporary.size(), 145U);
    EXPECT_NE(static_cast<unsigned char>(temporary[temporary.find(".part") - 8]), 0xC3U)
        << "half a character";
    file->commit();
    EXPECT_TRUE(fs::exists(path(name)));
  }
  EXPECT_THAT(error_of([&] { disk().create(path(std::string(256, 'n'))); }),
              HasSubstr("File name too long; choose a shorter name"));
}

TEST_F(Unfinished, TemporaryPathsAreToldFromOthers) {
  for (const std::string& name : {std::string("a.ply"), std::string(200, 'n')}) {
    const auto file = disk().create(path(name));
    const std::string folder = make_folder_beside(path(name), name);
    for (const std::string& temporary : {file->temporary_path(), folder}) {
      EXPECT_TRUE(is_temporary_path(temporary, path(name))) << temporary;
      EXPECT_FALSE(is_temporary_path(temporary, path("b.ply")));
      EXPECT_FALSE(is_temporary_path(temporary, path("folder/" + name)));
    }
    remove_temporary_folder(folder);
  }
  for (const char* const other :
       {"a.ply", "a.ply.part", "a.ply.log", "a.ply.xyz", "a.plyABCDEFG.part"}) {
    EXPECT_FALSE(is_temporary_path(path(other), path("a.ply"))) << other;
  }
}

TEST_F(Unfinished, ALinkToWhatIsYetToBeMadeIsFollowed) {
  fs::create_directory(path("folder"));
  fs::create_symlink("folder/next", path("link"));
  fs::create_symlink("target", path("folder/next"));
  write("link", "x");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content(path("folder/target")), "x");
  fs::create_symlink("round", path("round"));
  EXPECT_THAT(error_of([&] { disk().create(path("round")); }), HasSubstr("symbolic links"));
}

TEST_F(Unfinished, TheEndOfARunRemovesFilesAndNamesThem) {
  expect_that_nothing_is_left([&] {
    const auto b = disk().create(path("b"));
    const auto a = disk().create(path("a"));
    b->write(as_bytes_of("x"));
    const std::string folder = make_folder_beside(path("c"), "c");
    std::ofstream(folder + "/c") << "x";
    fs::create_directories(folder + "/deep/er");
    EXPECT_THAT(remove_unfinished_files(), ElementsAre(path("a"), path("b"), "c"));
    EXPECT_THAT(remove_unfinished_files(), ElementsAre()) << "once is enough";
    if (HasFailure()) _exit(2);
  });
}

TEST_F(Unfinished, TheEndOfARunLeavesFinishedFiles) {
  EXPECT_EXIT(
      {
        write("a", "x");
        _exit(remove_unfinished_files().empty() ? 0 : 1);
      },
      ExitedWithCode(0), "");
  EXPECT_THAT(names(), ElementsAre("a"));
}

TEST_F(Unfinished, TheEndOfARunRemovesWhatOtherProcessesHaveNotFinished) {
  EXPECT_EXIT(
      {
        std::ofstream(path("a.part")) << "x";
        std::ofstream(path("b.part")) << "x";
        const OthersUnfinishedFile others(path("a.part"));
        OthersUnfinishedFile(path("b.part"));
        _exit(remove_unfinished_files().empty() ? 0 : 1);
      },
      ExitedWithCode(0), "");
  EXPECT_THAT(names(), ElementsAre("b.part")) << "its owner has gone on";
}

TEST_F(Unfinished, NothingIsCreatedOnceTheRunIsEnding) {
  expect_that_nothing_is_left([&] {
    const auto scratch = make_scratch_folder(folder_, std::nullopt);
    const auto file = scratch->create("tile");
    const auto output = disk().create(path("a"));
    remove_unfinished_files();
    std::atomic<int> got_on = 0;
    std::thread([&] { disk().create(path("b")), ++got_on; }).detach();
    std::thread([&] { output->commit(), ++got_on; }).detach();
    std::thread([&] { scratch->create("tile"), ++got_on; }).detach();
    std::thread([&] { file->append(as_bytes_of("x")), ++got_on; }).detach();
    std::thread([&] { stop_if_run_is_ending(), ++got_on; }).detach();
    std::this_thread::sleep_for(kAWhile);
    if (got_on > 0) _exit(2);
  });
}

TEST_F(Unfinished, AFolderGoesWhileThreadsCreateAndRemoveFilesInIt) {
  for (int round = 0; round < 10; ++round) {
    expect_that_nothing_is_left([&] {
      const auto scratch = make_scratch_folder(folder_, std::nullopt);
      const auto first = scratch->create("tile");
      const fs::path private_folder = make_folder_beside(path("a"), "a");
      for (int t = 0; t < 3; ++t) {
        std::thread([&] {  // as tiles come and go
          std::vector<std::unique_ptr<ScratchFile>> files(100);
          for (std::size_t i = 0;; i = (i + 7) % files.size()) files[i] = scratch->create("tile");
        })
            .detach();
      }
      std::thread([&] {  // as a library writes by itself
        for (int i = 0;; ++i) std::ofstream(private_folder / std::to_string(i % 200)) << "x";
      })
          .detach();
      std::this_thread::sleep_for(std::chrono::milliseconds(2 * round));
      remove_unfinished_files();
      _exit(fs::is_empty(folder_) ? 0 : 1);  // the threads go on using what is here
    });
  }
}

TEST_F(Unfinished, AFolderOfThousandsOfFilesGoes) {
  expect_that_nothing_is_left([&] {
    const auto scratch = make_scratch_folder(folder_, std::nullopt);
    std::vector<std::unique_ptr<ScratchFile>> files(5000);
    for (auto& file : files) file = scratch->create("tile");
    std::thread([&] { files.clear(); }).detach();
    remove_unfinished_files();
    _exit(fs::is_empty(folder_) ? 0 : 1);  // without waiting for that thread
  });
}

TEST_F(Unfinished, TheEndOfARunWaitsForNamesThatBelongTogether) {
  expect_that_nothing_is_left([&] {
    std::atomic<bool> held = false;
    std::atomic<bool> named = false;
    std::thread([&] {
      const auto undisturbed = hold_off_end_of_run();
      held = true;
      std::this_thread::sleep_for(kAWhile);
      named = true;
    }).detach();
    while (!held) std::this_thread::yield();
    remove_unfinished_files();
    if (!named) _exit(2);
  });
}

TEST_F(Unfinished, OneRunAfterTheOtherGivesNamesInAFolder) {
  std::atomic<bool> second = false;
  std::thread other;
  {
    const FolderLock lock(path("a"));
    other = std::thread([&] {
      const FolderLock next(path("b"));
      second = true;
    });
    std::this_thread::sleep_for(kAWhile);
    EXPECT_FALSE(second);
  }
  other.join();
  EXPECT_TRUE(second);
  EXPECT_TRUE(names().empty());
  const FolderLock nowhere(path("none/a"));
}

}  // namespace
}  // namespace spillway::test
