#include <fmt/format.h>

#include <random>

#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::detail::testing {
namespace {

using ::testing::HasSubstr;

/// Points enough for several blocks of every format.
constexpr std::size_t kPoints = 200000;

void write_points(FaultyFileSystem& files, const std::string& path) {
  PointWriterOptions options;
  options.count = kPoints;
  options.lattice = Lattice{};
  const auto writer = open_point_writer(files, path, options);
  std::mt19937 random(1);
  std::vector<LatticePoint> points(kPoints);
  for (LatticePoint& p : points) p = {double(random() >> 1U), double(random() >> 1U), 3};
  writer->write(points, {});
  writer->finish();
}

/// The name of a file of each format.
class PointFaults : public ::testing::TestWithParam<std::string> {};

TEST_P(PointFaults, EveryFailingReadIsReported) {
  FaultyFileSystem files;
  write_points(files, GetParam());
  read_all_points(files, GetParam());
  const int reads = files.count(Call::kRead);
  ASSERT_GT(reads, 2);
  for (int n = 1; n <= reads; ++n) {
    files.fail(Call::kRead, n, "the cable was pulled");
    EXPECT_EQ(error_of([&] { read_all_points(files, GetParam()); }), "the cable was pulled") << n;
  }
}

TEST_P(PointFaults, AFailingOpenIsReported) {
  FaultyFileSystem files;
  files.fail(Call::kOpen, 1, "not today");
  EXPECT_EQ(error_of([&] { read_all_points(files, GetParam()); }), "not today");
}

TEST_P(PointFaults, EveryFailingWriteLeavesNothingBehind) {
  FaultyFileSystem good;
  write_points(good, GetParam());
  for (const Call call : {Call::kCreate, Call::kWrite, Call::kRewrite, Call::kCommit}) {
    for (int n = 1; n <= good.count(call); ++n) {
      FaultyFileSystem files;
      files.fail(call, n, "the cable was pulled");
      EXPECT_EQ(error_of([&] { write_points(files, GetParam()); }), "the cable was pulled");
      EXPECT_TRUE(files.files.empty());
      EXPECT_TRUE(files.parts.empty());
    }
  }
}

TEST_P(PointFaults, AFullDiskLeavesNothingBehind) {
  FaultyFileSystem good;
  write_points(good, GetParam());
  const std::size_t size = good.files.at(GetParam()).size();
  for (const std::size_t capacity : {std::size_t{0}, size / 2, size - 1}) {
    FaultyFileSystem files;
    files.capacity = capacity;
    EXPECT_THAT(error_of([&] { write_points(files, GetParam()); }),
                HasSubstr("No space left on device"));
    EXPECT_TRUE(files.files.empty());
    EXPECT_TRUE(files.parts.empty());
  }
}

TEST_P(PointFaults, AClosedPipeIsToldApart) {
  FaultyFileSystem files;
  files.seekable = false;
  files.capacity = 100000;
  files.capacity_closes_pipe = true;
  EXPECT_THROW(write_points(files, GetParam()), ClosedPipe);
}

TEST_P(PointFaults, AnUnfinishedFileIsDropped) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.count = kPoints;
  options.lattice = Lattice{};
  open_point_writer(files, GetParam(), options).reset();
  EXPECT_TRUE(files.files.empty());
  EXPECT_TRUE(files.parts.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, PointFaults, ::testing::Values("a.las", "a.laz", "a.copc.laz", "a.xyz", "a.npy", "a.spp"),
    [](const auto& tested) { return tested.param.substr(2, tested.param.find('.', 2) - 2); });

TEST(ShrinkingFile, LasEndsWithinAPoint) {
  FaultyFileSystem files;
  write_points(files, "a.las");
  files.reads_end_at = 227 + 20 * 150000 + 7;
  EXPECT_THAT(error_of([&] { read_all_points(files, "a.las"); }),
              HasSubstr("ends at byte 3000234, within point 150000 of 200000"));
}

TEST(ShrinkingFile, NpyEndsWithinAPoint) {
  FaultyFileSystem files;
  write_points(files, "a.npy");
  files.reads_end_at = 128 + 24 * 150000 + 7;
  EXPECT_THAT(error_of([&] { read_all_points(files, "a.npy"); }),
              HasSubstr("within point 150000 of 200000"));
}

/// Reads bytes that may be anything: points or an Error are right, anything else is a fault that
/// ends the test (a crash, another exception, a sanitizer's finding).
void read_anything(const std::string& path, const std::string& bytes) {
  for (const bool seekable : {true, false}) {
    FaultyFileSystem files;
    files.seekable = seekable;
    files.files[path] = bytes;
    try {
      read_all_points(files, path);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
    }
  }
}

/// Cuts the file at every byte, and sets every byte to several values.
void read_every_corruption(const std::string& path, const std::string& good) {
  read_content(path, good);
  for (std::size_t at = 0; at < good.size(); ++at) {
    read_anything(path, good.substr(0, at));
    for (const char mask : {'\x01', '\x80', '\xff'}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ mask);
      read_anything(path, bad);
    }
  }
}

TEST(AnyCorruption, LasGivesPointsOrAnError) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  file.vlrs = {{"LASF_Projection", 2112, "GEOGCS[]"},
               {"LASF_Projection", 34735, std::string(24, '\1')}};
  read_every_corruption("a.las", file.bytes());
}

TEST(AnyCorruption, NpyGivesPointsOrAnError) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.count = 2;
  const auto writer = open_point_writer(files, "a.npy", options);
  writer->write(std::vector<LatticePoint>(2, LatticePoint{1, 2, 3}), {});
  writer->finish();
  read_every_corruption("a.npy", files.files.at("a.npy"));
}

TEST(AnyCorruption, TextGivesPointsOrAnError) {
  read_every_corruption("a.xyz", "id,x,y,z\n# c\n\"a\",1.5,-2e3,+3\r\n\"b\",4,5,6");
}

}  // namespace
}  // namespace spillway::detail::testing
