// What an input holds is recognised, and looking loses nothing of a pipe.

#include "formats/inputs/input_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_points.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/spm/spm_format.h"
#include "src/error.h"
#include "tests/faulty_file_system.h"

namespace spillway::test {
namespace {

ContentKind kind_of(const std::string& path, const std::string& content) {
  FaultyFileSystem files;
  files.files[path] = content;
  ProbedInput input(files, path);
  return kind_of_content(input);
}

const std::string kSpm = std::string(kSpmMagic) + '\0' + "and so on";

TEST(InputKindTest, NamesTellMeshStreams) {
  EXPECT_EQ(kind_of("a.spm", "1 2 3\n"), ContentKind::kMeshStream);
  EXPECT_EQ(kind_of("A.SMA", "1 2 3\n"), ContentKind::kMeshStream);
}

TEST(InputKindTest, FirstBytesTellMeshStreamsInFilesAndPipes) {
  for (const std::string path : {"-", "noname"}) {
    EXPECT_EQ(kind_of(path, kSpm), ContentKind::kMeshStream);
    EXPECT_EQ(kind_of(path, "v 1 2 3\nv 2 3 4\n"), ContentKind::kMeshStream);
    EXPECT_EQ(kind_of(path, "# a comment\r\n#\n\nv 1 2 3\n"), ContentKind::kMeshStream);
    EXPECT_EQ(kind_of(path, "1 2 3\n"), ContentKind::kPoints);
    EXPECT_EQ(kind_of(path, "# 1 2 3\n1 2 3\n"), ContentKind::kPoints);
    EXPECT_EQ(kind_of(path, "# only a comment"), ContentKind::kPoints);
    EXPECT_EQ(kind_of(path, "LASF"), ContentKind::kPoints);
    EXPECT_EQ(kind_of(path, ""), ContentKind::kPoints);
  }
}

TEST(InputKindTest, OtherMeshesAreToldFromStreams) {
  EXPECT_EQ(kind_of("mesh.obj", "v 1 2 3\n"), ContentKind::kMesh);
  EXPECT_EQ(kind_of("noname", "OFF\n0 0 0\n"), ContentKind::kMesh);
  EXPECT_EQ(kind_of("noname", "# spillway dimension 2\nv 1 2 3\n"), ContentKind::kMesh);
  EXPECT_EQ(kind_of("noname", std::string(kSmaNote) + "\nv 1 2 3\n"), ContentKind::kMeshStream);
}

TEST(InputKindTest, FirstBytesGoBeforeNames) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 0\nelement face 1\nend_header\n";
  for (const std::string name : {"a.ply", "a.spm", "a.sma", "a.obj", "a.txt", "a.las"}) {
    EXPECT_EQ(kind_of(name, "LASF and so on"), ContentKind::kPoints) << name;
    EXPECT_EQ(kind_of(name, "\x1f\x8b and so on"), ContentKind::kPoints) << name;
    EXPECT_EQ(kind_of(name, kSpm), ContentKind::kMeshStream) << name;
    EXPECT_EQ(kind_of(name, ply), ContentKind::kMesh) << name;
    EXPECT_EQ(kind_of(name, std::string(kSmaNote) + "\nv 1 2 3\n"), ContentKind::kMeshStream)
        << name;
  }
}

TEST(InputKindTest, PointsNamedAsAMeshAreNoMesh) {
  FaultyFileSystem files;
  files.files["a.ply"] = "LASF and so on";
  EXPECT_FALSE(is_mesh(files, "a.ply"));
  try {
    read_mesh(files, "a.ply");
    ADD_FAILURE() << "no Error was thrown";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("a.ply: this begins as points in LAS"));
  }
}

TEST(InputKindTest, LookingLosesNothing) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = "1 2 3\n4 5 6\n";
  ProbedInput input(files, "-");
  EXPECT_EQ(kind_of_content(input), ContentKind::kPoints);
  EXPECT_EQ(kind_of_content(input), ContentKind::kPoints);
  std::vector<std::byte> bytes(100);
  const auto opened = input.open("-");
  bytes.resize(opened->read(bytes));
  EXPECT_EQ(as_text(bytes), "1 2 3\n4 5 6\n");
  EXPECT_EQ(files.count(Call::kOpen), 1);
}

TEST(InputKindTest, OtherFilesAreThoseBeneath) {
  FaultyFileSystem files;
  files.files["a"] = "1 2 3\n";
  files.files["b"] = "other";
  ProbedInput input(files, "a");
  input.source();
  std::vector<std::byte> bytes(100);
  bytes.resize(input.open("b")->read(bytes));
  EXPECT_EQ(as_text(bytes), "other");
  EXPECT_TRUE(input.exists("a"));
  EXPECT_FALSE(input.exists("c"));
}

TEST(InputKindTest, PointsOfFormatsThatAreNotReadAreNamed) {
  const std::string ptx =
      "3\r\n1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n0 0 1\r\n1 0 0 0\r\n0 1 0 0\r\n0 0 1 0\r\n0 0 0 1\r\n";
  const std::vector<std::pair<std::string, std::string>> unread = {
      {std::string("ASTM-E57\1\0\0\0", 12), "E57"},
      {ptx, "a scan in PTX"}};
  for (const auto& [content, what] : unread) {
    for (const char* name : {"a.txt", "a.pts", "a.asc", "-"}) {
      FaultyFileSystem files;
      files.files[name] = content;
      try {
        open_point_reader(files, name, {});
        ADD_FAILURE() << what;
      } catch (const Failure& error) {
        EXPECT_THAT(error.what(),
                    ::testing::HasSubstr(what + ", which is not read; convert it to"));
      }
    }
  }
}

TEST(InputKindTest, AMissingFileIsAnError) {
  FaultyFileSystem files;
  ProbedInput input(files, "missing");
  EXPECT_THROW(kind_of_content(input), Failure);
}

}  // namespace
}  // namespace spillway::test
