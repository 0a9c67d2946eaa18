// Bad input, bad output: one line that says what and where, the right exit code, and
// nothing left behind.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "tests/test_paths.h"
#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Runs a command that must fail with exit code 1 and one line that mentions `what`, and must leave
/// the folder as it was.
void expect_failure(const Workspace& work, const std::string& command, const std::string& what) {
  const auto before = work.names();
  const Result result = work.run(command);
  EXPECT_EQ(result.exit_code, 1) << command;
  EXPECT_THAT(result.err, StartsWith("spillway: error: ")) << command;
  EXPECT_THAT(result.err, HasSubstr(what)) << command;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_EQ(work.names(), before) << command;
}

/// A command for input `name` in this file's commonest form.
std::string triangulate(const std::string& name) {
  return fmt::format("spillway triangulate --progress none '{}' -o mesh.ply", name);
}

TEST(BadInput, MissingFile) {
  expect_failure(Workspace(), triangulate("nowhere.las"), "nowhere.las");
}

TEST(BadInput, Folder) {
  const Workspace work;
  std::filesystem::create_directory(work.folder() / "folder.las");
  expect_failure(work, triangulate("folder.las"), "folder.las");
}

TEST(BadInput, TruncatedLas) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 1000 -o whole.las\n"
      "head -c 10000 whole.las > in.las; rm whole.las");
  expect_failure(work, triangulate("in.las"), "in.las");
}

TEST(BadInput, TruncatedLasFromAPipe) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 1000 -o whole.las");
  expect_failure(work, "head -c 10000 whole.las | " + triangulate("-"), "");
}

TEST(BadInput, LasCountLargerThanTheFile) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 1000 -o in.las");
  std::string bytes = work.read("in.las");
  ASSERT_GT(bytes.size(), 227U);
  const std::size_t legacy_count = 107;  // where LAS 1.0 to 1.3 have the number of points
  for (int i = 0; i < 4; ++i) bytes[legacy_count + i] = '\x7f';
  work.write("in.las", bytes);
  expect_failure(work, triangulate("in.las"), "in.las");
}

TEST(BadInput, SampleFilesThatAreDamaged) {
  const Workspace work;
  for (const std::string name : {"1.2-with-color-clipped.las", "garbage_nVariableLength.las"}) {
    const auto path = shared_file(name);
    if (path.empty()) GTEST_SKIP() << "no " << name << " in " << shared_data_folder();
    expect_failure(work, triangulate(path.string()), name);
  }
}

TEST(BadInput, TextThatIsNoNumber) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 one 0\n");
  expect_failure(work, triangulate("in.txt"), "3");
}

TEST(BadInput, NotANumberAndInfinity) {
  const Workspace work;
  work.write("nan.txt", "0 0 0\n1 nan 0\n0 1 0\n");
  expect_failure(work, triangulate("nan.txt"), "nan.txt");
  work.write("inf.txt", "0 0 0\n1 0 0\ninf 1 0\n");
  expect_failure(work, triangulate("inf.txt"), "inf.txt");
}

TEST(BadInput, UnknownFormat) {
  const Workspace work;
  work.write("in.dat", std::string("\x01\x02\x03\x04\xff\xfe binary", 13));
  expect_failure(work, triangulate("in.dat"), "in.dat");
}

TEST(BadInput, EmptyFile) {
  const Workspace work;
  work.write("in.txt", "");
  expect_failure(work, triangulate("in.txt"), "no points");
}

TEST(BadInput, TooFewDistinctPoints) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n0 0 1\n1 1 1\n");
  expect_failure(work, triangulate("in.txt"), "only 2 distinct points");
}

TEST(BadInput, AllPointsOnOneLine) {
  const Workspace work;
  std::string text;
  for (int i = 0; i < 57; ++i) text += std::to_string(i) + " " + std::to_string(2 * i) + " 0\n";
  work.write("in.txt", text);
  expect_failure(work, triangulate("in.txt"),
                 "all 57 points lie on one line: there is no triangle to make");
}

TEST(BadInput, AllPointsInOnePlane) {
  const Workspace work;
  work.write("in.txt", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n2 5 1\n");
  expect_failure(work, triangulate("in.txt") + " --dim 3", "in one plane");
}

TEST(BadInput, ThreeDimensionsOfPointsWithoutZ) {
  const Workspace work;
  work.write("in.txt", "0 0\n1 0\n0 1\n1 1\n");
  expect_failure(work, triangulate("in.txt") + " --dim 3", "--dim 2");
}

TEST(BadInput, DamagedMesh) {
  const Workspace work;
  work.write("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  expect_failure(work, "spillway check -q mesh.off", "mesh.off");
  work.write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\n");
  expect_failure(work, "spillway info -q mesh.ply", "mesh.ply");
}

constexpr const char* kTriangle = "0 0 0\n1 0 0\n0 1 0\n";

TEST(BadOutput, FolderIsMissing) {
  const Workspace work;
  work.write("in.txt", kTriangle);
  expect_failure(work, "spillway triangulate -q in.txt -o no/mesh.ply", "no/mesh.ply");
  expect_failure(work, "spillway triangulate -q in.txt -o mesh.ply --stats no/s.json", "no/s.json");
  expect_failure(work, "spillway generate -q uniform -n 10 -o no/points.txt", "no/points.txt");
}

TEST(BadOutput, OutputIsAFolder) {
  const Workspace work;
  work.write("in.txt", kTriangle);
  std::filesystem::create_directory(work.folder() / "mesh.ply");
  expect_failure(work, "spillway triangulate -q in.txt -o mesh.ply", "mesh.ply");
}

TEST(BadOutput, FullDeviceBehindStandardOutput) {
  const Workspace work;
  work.write("in.txt", kTriangle);
  expect_failure(work, "spillway triangulate -q in.txt -o - --output-format obj > /dev/full",
                 "No space left");
  expect_failure(work, "spillway info -q in.txt > /dev/full", "No space left");
  expect_failure(work, "spillway --help > /dev/full", "No space left");
}

TEST(BadOutput, FileBeyondTheSizeLimit) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 20000 -o in.npy");
  expect_failure(work, "ulimit -f 8; spillway generate -q terrain -n 1e5 -o out.las", "out.las");
  expect_failure(work, "ulimit -f 8; spillway generate -q terrain -n 1e5 --grid 2x2 -o out_#.las",
                 "cannot write out_00_00.las: File too large");
  expect_failure(work, "ulimit -f 8; spillway triangulate -q in.npy -o mesh.ply", "mesh.ply");
}

TEST(BadOutput, ContoursBeyondTheSizeLimit) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 20000 -o in.las");
  for (const std::string name : {"a.dxf", "a.geojson", "a.gpkg", "a.shp"}) {
    for (const std::string what : {" --interval 2", " --interval 2 --bands"}) {
      if (name == "a.dxf" && what.ends_with("--bands")) continue;
      expect_failure(work,
                     "ulimit -f 100; spillway contour -q in.las --force-crs -o " + name + what,
                     "cannot write " + name);
    }
  }
}

/// GDAL's driver looks for the end of a line in what it could not read of a file that is cut off.
TEST(BadOutput, DrawingsThatMayNotGrowEndWithAnErrorAtAnySize) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 20000 -o in.las");
  std::vector<int> limits(16);
  std::iota(limits.begin(), limits.end(), 100);
  limits.insert(limits.end(), {4, 12, 31, 33, 40});  // KiB; the driver's own header has 6
  for (const int kibibytes : limits) {
    expect_failure(
        work,
        fmt::format("ulimit -f {}; spillway contour -q in.las -o a.dxf --interval 2", kibibytes),
        "cannot write a.dxf");
  }
}

TEST(BadOutput, FullDisk) {
  const Workspace work;
  const auto disk = work.folder() / "disk";
  std::filesystem::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=128k") != 0) {
    GTEST_SKIP() << "a small file system cannot be mounted here";
  }
  const Result result = work.run("spillway generate -q terrain -n 1e5 -o disk/out.las");
  const bool left_behind = !std::filesystem::is_empty(disk);
  umount2(disk.c_str(), MNT_DETACH);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("No space left"));
  EXPECT_FALSE(left_behind);
}

TEST(BadOutput, FailedRunLeavesTheOldOutputAlone) {
  const Workspace work;
  work.write("mesh.ply", "precious");
  work.write("in.txt", "0 0 0\nnonsense\n");
  expect_failure(work, triangulate("in.txt"), "in.txt");
  EXPECT_EQ(work.read("mesh.ply"), "precious");
}

TEST(ClosedPipe, EndsTheRunQuietly) {
  const Workspace work;
  const Result result = work.run(
      "{ spillway generate -q uniform -n 1e8 -o -; echo $? > code; } | head -c 10 > /dev/null");
  EXPECT_EQ(work.read("code"), "141\n");
  EXPECT_EQ(result.err, "");
}

}  // namespace
}  // namespace spillway::test
