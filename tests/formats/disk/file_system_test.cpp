#include "formats/disk/file_system.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stop_token>
#include <thread>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_bytes.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

class Disk : public ::testing::Test {
 protected:
  Disk() {
    std::string name = ::testing::TempDir() + "spillway_disk_XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~Disk() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  static std::string content(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  static void put_content(const std::string& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }

  fs::path folder_;
};

TEST_F(Disk, WritesBesideAndRenamesOnCommit) {
  const auto file = disk().create(path("a.ply"));
  file->write(as_bytes_of("hello"));
  const std::string temporary = file->temporary_path();
  EXPECT_THAT(temporary, AllOf(StartsWith(path("a.ply.")), EndsWith(".part")));
  EXPECT_TRUE(fs::exists(temporary));
  EXPECT_FALSE(disk().exists(path("a.ply")));
  file->commit();
  EXPECT_FALSE(fs::exists(temporary));
  EXPECT_EQ(file->temporary_path(), "");
  EXPECT_TRUE(disk().exists(path("a.ply")));
  EXPECT_EQ(content(path("a.ply")), "hello");
}

TEST_F(Disk, KeepsTheOldFileWithoutCommit) {
  put_content(path("a"), "old");
  {
    const auto file = disk().create(path("a"));
    file->write(as_bytes_of("new"));
  }
  EXPECT_EQ(content(path("a")), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Disk, PiecesOfAllSizesArriveInOrder) {
  std::string expected;
  const auto file = disk().create(path("a"));
  for (const std::size_t size : {1U, 1000000U, 100000U, 3000000U, 0U, 1048576U, 7U}) {
    const std::string piece(size, static_cast<char>('a' + size % 26));
    file->write(as_bytes_of(piece));
    expected += piece;
  }
  file->commit();
  EXPECT_EQ(content(path("a")), expected);
}

TEST_F(Disk, RewritesWhatWasWritten) {
  const auto file = disk().create(path("a"));
  file->write(as_bytes_of("0123456789"));
  EXPECT_TRUE(file->rewrite(2, as_bytes_of("ab")));
  file->write(as_bytes_of("end"));
  file->commit();
  EXPECT_EQ(content(path("a")), "01ab456789end");
}

TEST_F(Disk, WritesThroughASymbolicLink) {
  put_content(path("target"), "old");
  fs::create_symlink("target", path("link"));
  const auto file = disk().create(path("link"));
  file->write(as_bytes_of("new"));
  file->commit();
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content(path("target")), "new");
}

TEST_F(Disk, WritesStraightToADevice) {
  const auto file = disk().create("/dev/null");
  EXPECT_EQ(file->temporary_path(), "");
  file->write(as_bytes_of("gone"));
  EXPECT_FALSE(file->rewrite(0, as_bytes_of("gone")));
  file->commit();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Disk, WritesStraightToANamedPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = content(path("pipe")); });
  {
    const auto file = disk().create(path("pipe"));
    file->write(as_bytes_of("through"));
    file->commit();
  }
  reader.join();
  EXPECT_EQ(got, "through");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(Disk, AClosedPipeIsToldApart) {
  const auto old_handler = std::signal(SIGPIPE, SIG_IGN);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  const auto file = disk().create(path("pipe"));
  ::close(reader);
  file->write(as_bytes_of("lost"));
  EXPECT_THROW(file->commit(), ClosedPipe);
  std::signal(SIGPIPE, old_handler);
}

TEST_F(Disk, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "/dev/full is not there";
  const auto file = disk().create("/dev/full");
  file->write(as_bytes_of("x"));
  EXPECT_THAT(error_of([&] { file->commit(); }),
              AllOf(HasSubstr("/dev/full: No space left on device"), HasSubstr("free some space")));
  EXPECT_THAT(error_of([&] { file->write(as_bytes_of(std::string(3000000, 'x'))); }),
              HasSubstr("No space left"));
}

TEST_F(Disk, AMissingFolderIsAnError) {
  EXPECT_THAT(error_of([&] { disk().create(path("none/a")); }),
              AllOf(HasSubstr("cannot create"), HasSubstr("No such file or directory"),
                    HasSubstr("create the folder " + path("none") + " first")));
}

TEST_F(Disk, AFolderThatIsAFileIsAnError) {
  put_content(path("file"), "");
  EXPECT_THAT(error_of([&] { disk().create(path("file/a")); }), HasSubstr("Not a directory"));
}

TEST_F(Disk, AFolderIsNoOutput) {
  EXPECT_THAT(error_of([&] { disk().create(folder_); }), HasSubstr("Is a directory"));
}

TEST_F(Disk, AProtectedFolderIsAnError) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write anywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(error_of([&] { disk().create(path("a")); }),
              AllOf(HasSubstr("Permission denied"), HasSubstr("choose a folder other than")));
  fs::permissions(folder_, fs::perms::owner_all);
}

TEST_F(Disk, AProtectedFileIsAnError) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write anywhere";
  put_content(path("a"), "keep");
  fs::permissions(path("a"), fs::perms::owner_read);
  EXPECT_THAT(error_of([&] { disk().create(path("a")); }), HasSubstr("write-protected"));
}

TEST_F(Disk, ReadsToTheEnd) {
  put_content(path("a"), "0123456789");
  const auto file = disk().open(path("a"));
  EXPECT_EQ(file->size(), 10U);
  EXPECT_EQ(file->name(), path("a"));
  std::string buffer(8, ' ');
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(buffer));
  EXPECT_EQ(file->read(bytes), 8U);
  EXPECT_EQ(buffer, "01234567");
  EXPECT_EQ(file->read(bytes), 2U);
  EXPECT_EQ(file->read(bytes), 0U);
}

TEST_F(Disk, ReadsOnFromAnyByteOfAFile) {
  put_content(path("a"), "0123456789");
  InputBytes source(disk().open(path("a")));
  EXPECT_EQ(as_text(source.peek(4)), "0123");
  std::string buffer(3, ' ');
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(buffer));
  for (const std::uint64_t place : {6, 1, 0, 7}) {
    ASSERT_TRUE(source.seek(place));
    EXPECT_EQ(source.position(), place);
    EXPECT_EQ(as_text(source.peek(2)), std::string("0123456789").substr(place, 2));
    EXPECT_EQ(source.read(bytes), 3U);
    EXPECT_EQ(buffer, std::string("0123456789").substr(place, 3));
    EXPECT_EQ(source.position(), place + 3);
  }
  ASSERT_TRUE(source.seek(20));
  EXPECT_EQ(source.read(bytes), 0U);
}

TEST_F(Disk, ReadsAtAnyByteBesideWhatIsReadInOrder) {
  put_content(path("a"), "0123456789");
  InputBytes source(disk().open(path("a")));
  std::string buffer(3, ' ');
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(buffer));
  EXPECT_EQ(source.read(bytes), 3U);
  EXPECT_EQ(source.read_at(6, bytes), 3U);
  EXPECT_EQ(buffer, "678");
  EXPECT_EQ(source.read_at(8, bytes), 2U);
  EXPECT_EQ(source.read_at(20, bytes), 0U);
  EXPECT_EQ(source.read(bytes), 3U);
  EXPECT_EQ(buffer, "345");
}

TEST_F(Disk, AFileThatIsCutOffOrGrowsWhileItIsReadIsAnError) {
  std::string buffer(8, ' ');
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(buffer));
  for (const std::string& now : std::vector<std::string>{"01234", "0123456789ab"}) {
    put_content(path("a"), "0123456789");
    const auto file = disk().open(path("a"));
    put_content(path("a"), now);
    const auto read_to_the_end = [&] {
      while (file->read(bytes) > 0) {
      }
    };
    EXPECT_THAT(read_to_the_end,
                ThrowsMessage<BadInput>(AllOf(HasSubstr("had 10 bytes when it was opened"),
                                              HasSubstr(fmt::format("now has {}", now.size())))));
  }
}

TEST_F(Disk, AFileThatIsRemovedWhileItIsReadIsReadToItsEnd) {
  put_content(path("a"), "0123456789");
  const auto file = disk().open(path("a"));
  fs::remove(path("a"));
  std::string buffer(20, ' ');
  EXPECT_EQ(file->read(std::as_writable_bytes(std::span(buffer))), 10U);
}

TEST_F(Disk, OutputsThatAreKeptFollowNoLinks) {
  fs::create_symlink("elsewhere", path("a.ABCDEF.part"));
  const auto kept = keep_outputs("ABCDEF");
  EXPECT_THROW(static_cast<void>(kept->create(path("a"))), SystemRefusal);
  EXPECT_FALSE(fs::exists(path("elsewhere")));
}

TEST_F(Disk, FillsTheBufferFromAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::thread writer([&] {
    std::ofstream stream(path("pipe"));
    for (int i = 0; i < 1000; ++i) stream << "piece" << std::flush;
  });
  const auto file = disk().open(path("pipe"));
  EXPECT_FALSE(file->size());
  std::vector<std::byte> buffer(10000);
  EXPECT_EQ(file->read(buffer), 5000U);
  EXPECT_FALSE(file->seek(0));
  EXPECT_FALSE(file->read_at(0, buffer));
  writer.join();
}

TEST_F(Disk, AStopEndsTheWaitForAPipeWithoutAWriterAndForOneThatIsSilent) {
  const std::string name = path("pipe");
  ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
  for (const bool silent : {false, true}) {
    std::stop_source stop;
    const auto input = disk_until(stop.get_token())->open(name);
    const int writer = silent ? ::open(name.c_str(), O_WRONLY) : -1;
    const std::jthread later([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      stop.request_stop();
    });
    std::array<std::byte, 4> bytes{};
    EXPECT_THROW(input->read(bytes), Interrupted);
    if (writer >= 0) ::close(writer);
  }
}

TEST_F(Disk, APipeThatCanBeStoppedIsReadToItsEndFromAWriterThatComesLater) {
  const std::string name = path("pipe");
  ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
  const std::stop_source stop;
  const auto input = disk_until(stop.get_token())->open(name);
  const std::jthread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    put_content(name, std::string(100'000, 'x'));
  });
  std::vector<std::byte> bytes(200'000);
  EXPECT_EQ(input->read(bytes), 100'000u);
}

TEST_F(Disk, AMissingFileIsAnError) {
  EXPECT_THAT(
      error_of([&] { disk().open(path("none.las")); }),
      AllOf(HasSubstr("cannot open " + path("none.las")), HasSubstr("No such file or directory")));
}

TEST_F(Disk, AFolderIsNoInput) {
  EXPECT_THAT(error_of([&] { disk().open(folder_); }), HasSubstr("it is a folder"));
}

TEST_F(Disk, StandardInputIsADash) {
  put_content(path("a"), "from elsewhere");
  const int saved = ::dup(STDIN_FILENO);
  const int replacement = ::open(path("a").c_str(), O_RDONLY);
  ::dup2(replacement, STDIN_FILENO);
  ::lseek(STDIN_FILENO, 5, SEEK_SET);
  const auto file = disk().open("-");
  ::dup2(saved, STDIN_FILENO);
  ::close(saved);
  ::close(replacement);
  EXPECT_EQ(file->name(), "standard input");
  EXPECT_EQ(file->size(), 9U) << "what was read before does not count";
  std::vector<std::byte> buffer(100);
  EXPECT_EQ(as_text(std::span(buffer).first(file->read(buffer))), "elsewhere");
  ASSERT_TRUE(file->seek(4));
  EXPECT_EQ(as_text(std::span(buffer).first(file->read(buffer))), "where");
}

/// Exchanges a standard descriptor for one opened in that way; back at the end of the scope.
class Exchanged {
 public:
  Exchanged(int descriptor, const char* path, int flags)
      : descriptor_(descriptor), saved_(::dup(descriptor)) {
    const int opened = ::open(path, flags);
    ::dup2(opened, descriptor_);
    ::close(opened);
  }
  ~Exchanged() {
    ::dup2(saved_, descriptor_);
    ::close(saved_);
  }
  Exchanged(const Exchanged&) = delete;
  Exchanged& operator=(const Exchanged&) = delete;

 private:
  int descriptor_;
  int saved_;
};

TEST_F(Disk, AClosedStandardInputOrOutputIsAnError) {
  // What stands for a closed one goes into the other direction only.
  const Exchanged input(STDIN_FILENO, "/dev/null", O_WRONLY);
  EXPECT_THAT(error_of([&] { disk().open("-"); }),
              HasSubstr("cannot read standard input: it is closed"));
  const Exchanged output(STDOUT_FILENO, "/dev/null", O_RDONLY);
  EXPECT_THAT(error_of([&] { disk().create("-"); }),
              HasSubstr("cannot write standard output: it is closed"));
}

}  // namespace
}  // namespace spillway::test
