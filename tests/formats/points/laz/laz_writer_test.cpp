#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/create_points.h"
#include "formats/points/las/las_header.h"
#include "formats/points/las/laz_record.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/random_attributes.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kChunk = 50'000;
/// Of the header of LAS 1.2; the record of the compression of point format 0 follows.
constexpr std::size_t kHeader = 227;
constexpr std::size_t kLazRecord = 54 + 34 + 6;

std::vector<LatticePoint> scan_lines(std::size_t count) {
  std::mt19937 random(11);
  std::vector<LatticePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i] = {double(i % 1000), double(i / 1000) + double(random() % 3), double(random() % 50)};
  }
  return points;
}

PointWriterOptions options_of(const std::string& version) {
  PointWriterOptions options;
  options.lattice = IntegerLattice{};
  options.version = version;
  return options;
}

/// The file of these points, which come in blocks of all sizes.
std::string written(const std::string& name, std::span<const LatticePoint> points,
                    std::span<const LasFlags> attributes, PointWriterOptions options,
                    bool seekable = true) {
  FaultyFileSystem files;
  files.seekable = seekable;
  if (attributes.empty()) {
    options.count = points.size();
  } else {
    options.attributes = flags_layout();
  }
  const auto writer = open_point_writer(files, name, options);
  for (std::size_t size = 1; !points.empty(); size = 3 * size + 1) {
    const std::size_t some = std::min(size, points.size());
    writer->write(points.first(some),
                  records_of(attributes.first(std::min(some, attributes.size()))));
    points = points.subspan(some);
    attributes = attributes.subspan(std::min(some, attributes.size()));
  }
  EXPECT_TRUE(files.files.empty());
  writer->finish();
  EXPECT_TRUE(files.parts.empty());
  return files.files.at(name);
}

AllPoints read_back(const std::string& laz, bool seekable) {
  FaultyFileSystem files;
  files.seekable = seekable;
  files.files["a.laz"] = laz;
  PointReaderOptions options;
  options.keep_withheld = true;
  return read_all_points(files, "a.laz", options, true);
}

class LazWriter : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static bool version14() { return GetParam() == "1.4"; }
};

INSTANTIATE_TEST_SUITE_P(Versions, LazWriter, ::testing::Values("1.2", "1.4"),
                         [](const auto& tested) { return "1_" + tested.param.substr(2); });

TEST_P(LazWriter, GivesBackPointsOfAnyNumberOfChunks) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, kChunk - 1,
                                  kChunk, kChunk + 1, 2 * kChunk, 2 * kChunk + 777}) {
    const std::vector<LatticePoint> points = scan_lines(count);
    const std::string laz = written("a.laz", points, {}, options_of(GetParam()));
    for (const bool seekable : {true, false}) {
      const AllPoints back = read_back(laz, seekable);
      EXPECT_TRUE(back.points == points) << count;
      EXPECT_EQ(back.header.format, "laz");
      EXPECT_EQ(back.header.version, GetParam());
      EXPECT_EQ(back.header.point_format, version14() ? 6 : 0);
      EXPECT_EQ(back.header.count, count);
    }
  }
}

TEST_P(LazWriter, KeepsAttributes) {
  const std::vector<LatticePoint> points = scan_lines(kChunk + 10);
  const auto attributes = random_attributes(points.size(), version14(), 12);
  const std::string laz = written("a.laz", points, attributes, options_of(GetParam()));
  const AllPoints back = read_back(laz, true);
  EXPECT_TRUE(back.points == points);
  EXPECT_TRUE(back.attributes == attributes);
}

TEST_P(LazWriter, HasTheHeaderOfTheSameLasButForItsCompression) {
  const std::vector<LatticePoint> points = scan_lines(1000);
  const auto attributes = random_attributes(points.size(), version14(), 12);
  const std::string las = written("a.las", points, attributes, options_of(GetParam()));
  std::string laz = written("a.laz", points, attributes, options_of(GetParam()));
  const auto begin_of_points =
      static_cast<std::uint32_t>(las.size() - (version14() ? 30000 : 20000));
  EXPECT_EQ(laz[104], static_cast<char>(las[104] | 0x80));
  put(laz, 96, begin_of_points);
  put(laz, 100, std::uint32_t{0});
  laz[104] = las[104];
  EXPECT_EQ(laz.substr(0, begin_of_points), las.substr(0, begin_of_points));
}

TEST_P(LazWriter, ThePipeTellsTheTableInItsLastBytes) {
  const std::vector<LatticePoint> points = scan_lines(2 * kChunk + 5);
  const std::string file = written("a.laz", points, {}, options_of(GetParam()));
  const std::string pipe = written("a.laz", points, {}, options_of(GetParam()), false);
  ASSERT_EQ(pipe.size(), file.size() + 8);
  const std::size_t pointer = (version14() ? 375 : kHeader) + kLazRecord;
  EXPECT_EQ(pipe.substr(pointer, 8), std::string(8, '\xff'));
  EXPECT_EQ(pipe.substr(file.size()), file.substr(pointer, 8));
  EXPECT_EQ(pipe.substr(pointer + 8, file.size() - pointer - 8), file.substr(pointer + 8));
  for (const bool seekable : {true, false}) {
    EXPECT_TRUE(read_back(pipe, seekable).points == points);
  }
}

TEST_P(LazWriter, ThreadsChangeNoByte) {
  const std::vector<LatticePoint> points = scan_lines(7 * kChunk + 3);
  const std::string alone = written("a.laz", points, {}, options_of(GetParam()));
  PointWriterOptions shared = options_of(GetParam());
  shared.sharing = {.at_once = 3, .run = [](std::size_t count, const WorkSharing::Body& body) {
                      EXPECT_LE(count, 3U);
                      std::vector<std::jthread> threads;
                      for (std::size_t i = count; i-- > 0;) threads.emplace_back(body, i);
                    }};
  EXPECT_EQ(written("a.laz", points, {}, shared), alone);
}

TEST(LazWriterRecord, IsThatOfItsCompression) {
  for (const std::string version : {"1.2", "1.4"}) {
    const bool layered = version == "1.4";
    const std::string laz = written("a.laz", scan_lines(9), {}, options_of(version));
    const std::string record = laz.substr(layered ? 375 : kHeader, kLazRecord);
    EXPECT_THAT(record.substr(2), ::testing::StartsWith(std::string("laszip encoded\0\0", 16)));
    const std::string content = record.substr(54);
    EXPECT_EQ(record.substr(18, 2), bytes_of(std::uint16_t{22204}));
    EXPECT_EQ(record.substr(20, 2), bytes_of(std::uint16_t{40}));
    EXPECT_EQ(content.substr(0, 2), bytes_of(std::uint16_t(layered ? 3 : 2)));
    EXPECT_EQ(content.substr(2, 2), bytes_of(std::uint16_t{0})) << "the arithmetic coder";
    EXPECT_EQ(content.substr(12, 4), bytes_of(std::uint32_t{50000}));
    EXPECT_EQ(content.substr(16, 16), std::string(16, '\xff')) << "no special records";
    EXPECT_EQ(content.substr(32, 2), bytes_of(std::uint16_t{1})) << "items";
    EXPECT_EQ(content.substr(34, 2), bytes_of(std::uint16_t(layered ? 10 : 6)));
    EXPECT_EQ(content.substr(36, 2), bytes_of(std::uint16_t(layered ? 30 : 20)));
    EXPECT_EQ(content.substr(38, 2), bytes_of(std::uint16_t(layered ? 3 : 2)));
  }
}

TEST(LazWriterRecord, OfEveryPointFormatIsWhatTheReaderTakes) {
  for (int point_format = 0; point_format <= 10; ++point_format) {
    for (const std::size_t extra_bytes : {0, 3}) {
      LazRecord record;
      record.format = laz_format_to_write(point_format, extra_bytes);
      record.compressor =
          record.format.layered ? LazCompressor::kLayeredChunked : LazCompressor::kPointwiseChunked;
      record.chunk_points = 777;
      const LazRecord back =
          parse_laz_record(laz_record_bytes(record), point_format,
                           kLasRecordLengths.at(point_format) + extra_bytes, {"a.laz", {}});
      EXPECT_EQ(back.compressor, record.compressor);
      EXPECT_EQ(back.chunk_points, 777U);
      ASSERT_EQ(back.format.items.size(), record.format.items.size());
      for (std::size_t i = 0; i < back.format.items.size(); ++i) {
        EXPECT_EQ(back.format.items[i].version, record.format.items[i].version);
      }
    }
  }
}

TEST(LazWriterFaults, AnErrorOfAWorkerLeavesNothingBehind) {
  FaultyFileSystem files;
  PointWriterOptions options = options_of("1.2");
  options.sharing.run = [](std::size_t, const WorkSharing::Body&) {
    throw Failure("a worker fell");
  };
  EXPECT_EQ(error_of([&] {
              const auto writer = open_point_writer(files, "a.laz", options);
              writer->write(scan_lines(kChunk), {});
            }),
            "a worker fell");
  EXPECT_TRUE(files.files.empty());
  EXPECT_TRUE(files.parts.empty());
}

TEST(LazWriterFaults, RefusesWhatIsNoInt32) {
  FaultyFileSystem files;
  const auto writer = open_point_writer(files, "a.laz", options_of("1.2"));
  EXPECT_THAT(error_of([&] {
                writer->write(std::vector<LatticePoint>{{0.5, 0, 0}}, {});
              }),
              HasSubstr("cannot write a.laz: point 0 (0.5, 0, 0) is not on the 32-bit integers"));
}

}  // namespace
}  // namespace spillway::test
