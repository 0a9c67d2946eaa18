#include <fmt/format.h>

#include <random>

#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// Points enough for several blocks of every format.
constexpr std::size_t kPoints = 200000;

void write_points(FaultyFileSystem& files, const std::string& path) {
  PointWriterOptions options;
  options.count = kPoints;
  options.lattice = IntegerLattice{};
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
  options.lattice = IntegerLattice{};
  open_point_writer(files, GetParam(), options).reset();
  EXPECT_TRUE(files.files.empty());
  EXPECT_TRUE(files.parts.empty());
}

INSTANTIATE_TEST_SUITE_P(All, PointFaults,
                         ::testing::Values("a.las", "a.laz", "a.copc.laz", "a.xyz", "a.npy",
                                           "a.ply", "a.spp"),
                         [](const auto& tested) {
                           return tested.param.substr(2, tested.param.find('.', 2) - 2);
                         });

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

/// Reads bytes that may be anything: points or an Failure are right, anything else is a fault that
/// ends the test (a crash, another exception, a sanitizer's finding).
void read_anything(const std::string& path, const std::string& bytes) {
  for (const bool seekable : {true, false}) {
    FaultyFileSystem files;
    files.seekable = seekable;
    files.files[path] = bytes;
    try {
      read_all_points(files, path);
    } catch (const Failure& error) {
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

/// A file of two points with those attributes.
std::string file_of_two(const std::string& path, const AttributeLayout& attributes) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.count = 2;
  options.attributes = attributes;
  const auto writer = open_point_writer(files, path, options);
  writer->write(std::vector<LatticePoint>(2, LatticePoint{1, 2, 3}),
                std::vector<std::byte>(2 * attributes.record_size()));
  writer->finish();
  return files.files.at(path);
}

const AttributeLayout kSomeAttributes({{.name = "class", .type = NumberType::kUint8},
                                       {.name = "v", .type = NumberType::kInt16, .elements = 2}});

TEST(AnyCorruption, NpyGivesPointsOrAnError) {
  read_every_corruption("a.npy", file_of_two("a.npy", {}));
}

TEST(AnyCorruption, StructuredNpyGivesPointsOrAnError) {
  read_every_corruption("a.npy", file_of_two("a.npy", kSomeAttributes));
}

TEST(AnyCorruption, FortranOrderedNpyGivesPointsOrAnError) {
  const std::string dictionary = "{'descr': '>i2', 'fortran_order': True, 'shape': (4, 2), }";
  const std::string length = bytes_of(static_cast<std::uint16_t>(dictionary.size()));
  read_every_corruption(
      "a.npy", "\x93NUMPY" + std::string("\1\0", 2) + length + dictionary + std::string(16, '\1'));
}

TEST(AnyCorruption, PlyGivesPointsOrAnError) {
  read_every_corruption("a.ply", file_of_two("a.ply", kSomeAttributes));
  for (const std::string encoding : {"ascii", "binary_big_endian"}) {
    const std::string head = "ply\nformat " + encoding +
                             " 1.0\nelement a 1\nproperty char b\nelement vertex 2\nproperty char "
                             "x\nproperty list char char l\nproperty char y\nend_header\n";
    read_every_corruption("a.ply",
                          head + (encoding == "ascii" ? std::string("7\n1 0 2\n3 2 8 8 4\n")
                                                      : std::string("\7\1\0\2\3\2\x8\x8\4", 9)));
  }
}

TEST(AnyCorruption, TextGivesPointsOrAnError) {
  read_every_corruption("a.xyz", "id,x,y,z\n# c\n\"a\",1.5,-2e3,+3\r\n\"b\",4,5,6");
}

}  // namespace
}  // namespace spillway::test
