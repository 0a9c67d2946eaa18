// What can go wrong while points are on the disk: one line that says so, and nothing left there nor
// beside the output.

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Enough to overflow what waits in memory under the least --memory for two dimensions.
constexpr int kPoints = 800'000;

constexpr const char* kTriangulate = "spillway triangulate -q --memory 32M --scratch-folder tmp ";

/// Points in in.las (or in.txt), temporary files in `tmp`.
class OutOfCoreFault : public ::testing::Test {
 protected:
  OutOfCoreFault() { fs::create_directory(work_.folder() / "tmp"); }

  void generate(const std::string& name, int count = kPoints) const {
    work_.succeed(fmt::format("spillway generate -q terrain -n {} -o {}", count, name));
  }

  /// Runs a command that must fail with one line like `message` and leave everything as it was.
  void expect_failure(const std::string& command, const ::testing::Matcher<std::string>& message,
                      int exit_code = 1) const {
    const auto before = work_.names();
    const Result result = work_.run(command);
    EXPECT_EQ(result.exit_code, exit_code) << command << "\n" << result.err;
    EXPECT_THAT(result.err, AllOf(StartsWith("spillway: error: "), message)) << command;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    EXPECT_EQ(work_.names(), before) << command;
    EXPECT_TRUE(nothing_in_tmp()) << command;
  }

  [[nodiscard]] bool nothing_in_tmp() const { return fs::is_empty(work_.folder() / "tmp"); }

  [[nodiscard]] bool something_spilled() const {
    std::error_code vanished;
    const fs::recursive_directory_iterator entries(work_.folder() / "tmp", vanished);
    return std::any_of(begin(entries), end(entries), [&](const fs::directory_entry& entry) {
      return entry.is_regular_file(vanished) && entry.file_size(vanished) > 0;
    });
  }

  /// Waits until points have been spilled.
  void wait_for_spill() const {
    for (int i = 0; i < 4000 && !something_spilled(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(something_spilled());
  }

  Workspace work_;
};

TEST_F(OutOfCoreFault, InputThatIsCutShortOnAPipe) {
  generate("in.las");
  for (const std::string output : {"mesh.spm", "mesh.ply"}) {
    expect_failure(fmt::format("head -c 15900000 in.las | {} - -o {}", kTriangulate, output),
                   HasSubstr("byte 15900000"));
  }
}

TEST_F(OutOfCoreFault, InputWithABadLineLate) {
  generate("in.txt");
  work_.succeed("echo 1 2 x >> in.txt");
  for (const std::string output : {"mesh.spm", "mesh.vtu", "mesh.npy"}) {
    expect_failure(std::string(kTriangulate) + "in.txt -o " + output,
                   HasSubstr(fmt::format("line {}", kPoints + 1)));
  }
}

TEST_F(OutOfCoreFault, SecondInputThatIsDamaged) {
  generate("in.las");
  generate("late.txt", 10);
  work_.succeed("echo nonsense >> late.txt");
  expect_failure(std::string(kTriangulate) + "in.las late.txt -o mesh.spm",
                 HasSubstr("late.txt: line 11"));
}

TEST_F(OutOfCoreFault, MoreTemporaryFilesThanAllowed) {
  generate("in.las");
  expect_failure(std::string(kTriangulate) + "--max-tmp 300K in.las -o mesh.spm",
                 AllOf(HasSubstr("--max-tmp"), HasSubstr("307200 bytes")));
}

TEST_F(OutOfCoreFault, SizesThatAreNone) {
  generate("in.las", 100);
  for (const std::string option : {"--memory", "--max-tmp"}) {
    for (const std::string size : {"lots", "0", "12Q", "nan"}) {
      expect_failure(fmt::format("spillway triangulate -q in.las -o mesh.spm {} {}", option, size),
                     AllOf(HasSubstr(option), HasSubstr(size), HasSubstr("512M")), 2);
    }
  }
}

TEST_F(OutOfCoreFault, TooLittleMemoryIsRefusedWithTheLeastThatWillDo) {
  generate("in.las", 100);
  for (const std::string options : {"--dim 2", "--dim 3"}) {
    const std::string command = "spillway triangulate -q --scratch-folder tmp in.las -o mesh.spm ";
    const std::string memory = options + " --memory ";
    expect_failure(
        command + memory + "1M",
        AllOf(HasSubstr("MiB are the least"), HasSubstr("M is enough\n"), Not(HasSubstr("may be"))),
        2);
    const std::string message = work_.run(command + memory + "1M").err;
    const std::string least = message.substr(message.find("--memory ") + 9);
    work_.succeed(command + memory + least.substr(0, least.find(' ')));
  }
}

/// The first size after `words` in a message; "" if there is none.
std::string size_after(const std::string& message, const std::string& words) {
  const std::size_t at = message.find(words);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + words.size();
  return message.substr(begin, message.find('M', begin) + 1 - begin);
}

TEST_F(OutOfCoreFault, TheLeastMemoryIsNamedWithWhatOutputsTakeThemselves) {
  generate("in.las", 3000);
  for (const std::string command : {"contour in.las -o c.geojson --interval 5 --force-crs",
                                    "render --dim 3 in.las -o p.png --size 100"}) {
    const std::string limited = "spillway " + command + " -q --memory ";
    const std::string message = work_.run(limited + (command[0] == 'c' ? "20M" : "96M")).err;
    EXPECT_THAT(message, HasSubstr("MiB are the least"));
    work_.succeed(limited + size_after(message, "--memory "));
  }
}

TEST_F(OutOfCoreFault, MoreTilesThanThereIsMemoryForAreRefused) {
  generate("in.las", 1500000);
  const std::string command =
      "spillway triangulate -q --tile-points 100 in.las -o mesh.spm --memory ";
  const std::string message = work_.run(command + "32M").err;
  EXPECT_THAT(message,
              AllOf(HasSubstr("tiles of at most 100 points"), HasSubstr("M may be enough")));
  work_.succeed(command + size_after(message, "--memory "));
}

struct Refusal {
  const char* points;
  const char* memory;
  bool all_border;  ///< in the plane, so that what is enough for any points can be told
};

class OutOfCoreRefusal : public ::testing::TestWithParam<Refusal> {};

TEST_P(OutOfCoreRefusal, NamesMemoryThatIsEnough) {
  const Workspace work;
  const Refusal& refusal = GetParam();
  work.succeed(fmt::format("spillway generate -q {} -o in.spp", refusal.points));
  const std::string dimension =
      std::string(refusal.points).find("--dim 3") == std::string::npos ? "" : "--dim 3 ";
  const std::string command = "spillway triangulate -q --scratch-folder . " + dimension +
                              "in.spp -o /dev/null --output-format spm --memory ";
  const Result refused = work.run(command + refusal.memory);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("of memory are too little for"));
  if (refusal.all_border) {
    EXPECT_THAT(refused.err, AllOf(HasSubstr(" is enough"), Not(HasSubstr("may be"))));
  } else {
    EXPECT_THAT(refused.err, HasSubstr(" may be enough"));
  }
  const std::string told = size_after(refused.err, "--memory ");
  EXPECT_LT(std::stoi(told), 800) << refused.err;
  work.succeed(command + told);
}

INSTANTIATE_TEST_SUITE_P(Points, OutOfCoreRefusal,
                         ::testing::Values(Refusal{"circle -n 3e5", "32M", true},
                                           Refusal{"lines -n 3e5", "32M", true},
                                           Refusal{"circle --dim 3 -n 100000", "96M", false},
                                           Refusal{"lines --dim 3 -n 5000", "96M", false},
                                           Refusal{"normal --dim 3 -n 6e6", "96M", false}));

TEST_F(OutOfCoreFault, FoldersThatCannotBeWrittenTo) {
  generate("in.las", 100);
  work_.write("file", "");
  const std::string command = "spillway triangulate -q in.las -o mesh.spm --scratch-folder ";
  expect_failure(command + "nowhere", AllOf(HasSubstr("--scratch-folder"),
                                            HasSubstr("nowhere: No such file or directory")));
  expect_failure(command + "file", HasSubstr("file: Not a directory"));
  generate("large.las");
  expect_failure(
      "TMPDIR=nowhere spillway triangulate -q --memory 32M large.las -o mesh.spm",
      AllOf(HasSubstr("nowhere: No such file or directory"), HasSubstr("--scratch-folder")));
}

TEST_F(OutOfCoreFault, FolderOfAReadOnlyDisk) {
  generate("in.las", 100);
  const fs::path disk = work_.folder() / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", MS_RDONLY, "size=64k") != 0) {
    GTEST_SKIP() << "a file system cannot be mounted here";
  }
  expect_failure("spillway triangulate -q in.las -o mesh.spm --scratch-folder disk",
                 HasSubstr("disk: Read-only file system"));
  umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(OutOfCoreFault, FullDisk) {
  generate("in.las");
  const fs::path disk = work_.folder() / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "a small file system cannot be mounted here";
  }
  expect_failure("spillway triangulate -q --memory 32M in.las -o mesh.spm --scratch-folder disk",
                 AllOf(HasSubstr("No space left"), HasSubstr("--scratch-folder")));
  EXPECT_TRUE(fs::is_empty(disk));
  umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(OutOfCoreFault, TheDefaultFolderIsTheEnvironmentS) {
  generate("in.las");
  expect_failure(
      "TMPDIR=tmp spillway triangulate -q --memory 32M --max-tmp 300K in.las -o mesh.spm",
      HasSubstr("cannot write tmp/spillway-"));
  work_.succeed("TMPDIR=tmp spillway triangulate -q --memory 32M in.las -o mesh.spm");
  EXPECT_TRUE(nothing_in_tmp());
}

TEST_F(OutOfCoreFault, ClosedPipeEndsEveryStageQuietly) {
  for (const std::string format : {"spm", "sma", "ply"}) {
    const Result result = work_.run(fmt::format(
        "{{ spillway generate -q terrain -n {}; echo $? > first; }} | "
        "{{ {} - -o - --output-format {}; echo $? > second; }} | head -c 100 > /dev/null",
        kPoints, kTriangulate, format));
    EXPECT_EQ(work_.read("second"), "141\n") << format;
    EXPECT_THAT(work_.read("first"), ::testing::AnyOf("0\n", "141\n")) << format;
    EXPECT_EQ(result.err, "") << format;
    EXPECT_TRUE(nothing_in_tmp()) << format;
  }
}

TEST_F(OutOfCoreFault, MeshThatIsCutShortAnywhere) {
  generate("in.las", 300);
  work_.succeed("spillway triangulate -q in.las -o mesh.spm --tile-points 60");
  const std::string mesh = work_.read("mesh.spm");
  for (std::size_t cut = 1; cut < 12; ++cut) {
    const std::size_t size = cut < 8 ? mesh.size() * cut / 8 : mesh.size() - (cut - 7);
    work_.write("short.spm", mesh.substr(0, size));
    for (const std::string command : {"check", "info"}) {
      expect_failure(fmt::format("spillway {} -q short.spm", command),
                     HasSubstr("short.spm: the mesh is cut short"));
      expect_failure(fmt::format("cat short.spm | spillway {} -q -", command),
                     HasSubstr("standard input: the mesh is cut short"));
    }
  }
}

class OutOfCoreInterrupted : public OutOfCoreFault, public ::testing::WithParamInterface<int> {
 protected:
  /// Sends the signal and expects that nothing is left but what was there.
  void interrupt(pid_t process, const std::vector<std::string>& before) {
    kill(process, GetParam());
    EXPECT_EQ(wait_for_exit(process), 128 + GetParam());
    EXPECT_EQ(work_.names(), before);
    EXPECT_TRUE(nothing_in_tmp());
  }

  [[nodiscard]] pid_t triangulate(const std::string& input, const std::string& output) const {
    return work_.start({"triangulate", "-q", "--memory", "32M", "--scratch-folder", "tmp", input,
                        "-o", output, "--output-format", "spm"});
  }
};

TEST_P(OutOfCoreInterrupted, WhileItSpills) {
  generate("in.txt");
  ASSERT_EQ(mkfifo((work_.folder() / "pipe").c_str(), 0600), 0);
  const auto before = work_.names();
  const pid_t process = triangulate("pipe", "mesh.spm");
  const int pipe = open((work_.folder() / "pipe").c_str(), O_WRONLY | O_CLOEXEC);
  const std::string text = work_.read("in.txt");
  EXPECT_EQ(write(pipe, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  wait_for_spill();
  EXPECT_TRUE(work_.has_unfinished("mesh.spm"));
  interrupt(process, before);
  close(pipe);
}

TEST_P(OutOfCoreInterrupted, WhileItWritesWhatIsFinal) {
  generate("in.las");
  ASSERT_EQ(mkfifo((work_.folder() / "pipe").c_str(), 0600), 0);
  const auto before = work_.names();
  const pid_t process = triangulate("in.las", "pipe");
  const int pipe = open((work_.folder() / "pipe").c_str(), O_RDONLY | O_CLOEXEC);
  std::string begin(100'000, '\0');  // more than the header: some tiles are done
  for (std::size_t got = 0; got < begin.size();) {
    const ssize_t more = read(pipe, begin.data() + got, begin.size() - got);
    ASSERT_GT(more, 0);
    got += static_cast<std::size_t>(more);
  }
  EXPECT_TRUE(something_spilled());
  interrupt(process, before);
  close(pipe);
}

INSTANTIATE_TEST_SUITE_P(BySignal, OutOfCoreInterrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& test) { return std::string(sigabbrev_np(test.param)); });

TEST_F(OutOfCoreFault, PointsThatSpanNothingAreToldByTheirOwnNameNotByTheMemoryTheyWouldTake) {
  work_.succeed(
      "spillway generate -q collinear -n 2000000 -o line.spp\n"
      "spillway generate -q coplanar --dim 3 -n 2000000 -o plane.spp\n"
      "yes '3 4 5' | head -n 3000000 > equal.txt");
  expect_failure("spillway triangulate -q line.spp --memory 32M -o out.ply --scratch-folder tmp",
                 HasSubstr("all 2000000 points lie on one line: there is no triangle to make"));
  expect_failure("spillway triangulate -q line.spp --memory 2G -o out.ply --scratch-folder tmp",
                 HasSubstr("all 2000000 points lie on one line: there is no triangle to make"));
  expect_failure(
      "spillway triangulate -q plane.spp --dim 3 --memory 96M -o out.ply --scratch-folder tmp",
      HasSubstr("all 2000000 points lie in one plane: there is no tetrahedron to make"));
  for (const char* const how : {"--memory 32M", "--memory 2G", "--memory 96M --dim 3"}) {
    expect_failure(
        fmt::format("spillway triangulate -q equal.txt {} -o out.ply --scratch-folder tmp", how),
        HasSubstr("the input has only 1 distinct point"));
  }
}

}  // namespace
}  // namespace spillway::test
