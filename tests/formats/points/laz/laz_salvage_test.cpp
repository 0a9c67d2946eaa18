// What is read of LAZ files that end early, are damaged or hold more than their header counts, when
// they are to be salvaged. No point may come that the whole file does not have.

#include <fmt/format.h>

#include <random>

#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kPoints = 950;

LazFormat format_of(int compressor, std::uint32_t chunk_size = 100) {
  LazFormat format;
  format.point_format = compressor == 3 ? 7 : 3;
  format.compressor = compressor;
  format.version = compressor == 3 ? 3 : 2;
  format.chunk_size = chunk_size;
  return format;
}

std::vector<std::string> records_of(const LazFormat& format, std::size_t count = kPoints) {
  return RandomRecords{format.point_format, format.extra_bytes, count, 3}.make();
}

LazFile file_of(const LazFormat& format, std::size_t count = kPoints) {
  return make_laz_file(format, records_of(format, count));
}

std::vector<LatticePoint> points_of(const LazFormat& format, std::size_t count = kPoints) {
  std::vector<LatticePoint> points;
  for (const std::string& record : records_of(format, count)) {
    points.push_back(point_of_record(record));
  }
  return points;
}

AllPoints read(const std::string& bytes, bool seekable = true, PointReaderOptions options = {}) {
  options.keep_withheld = true;
  options.salvage = true;
  FaultyFileSystem files;
  files.seekable = seekable;
  files.files["a.laz"] = bytes;
  return read_all_points(files, "a.laz", options);
}

std::vector<LatticePoint> first_of(const std::vector<LatticePoint>& points, std::size_t count) {
  return {points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)};
}

std::uint64_t lost(const AllPoints& all) { return all.lost + all.header.lost; }

/// Whole chunks that end before a byte.
std::size_t whole_chunks(const LazFile& file, std::size_t size) {
  std::size_t chunks = 0;
  while (chunks < file.chunks.size() && file.offset_to_chunk(chunks + 1) <= size) ++chunks;
  return chunks;
}

TEST(LazSalvage, AWholeFileIsReadAsEver) {
  for (const int compressor : {1, 2, 3}) {
    const LazFormat format = format_of(compressor);
    for (const bool seekable : {true, false}) {
      const AllPoints all = read(file_of(format).bytes(), seekable);
      EXPECT_EQ(all.points, points_of(format)) << compressor << seekable;
      EXPECT_EQ(lost(all), 0U);
      EXPECT_EQ(all.index.back(), kPoints - 1);
      EXPECT_THAT(all.notices, IsEmpty());
      EXPECT_THAT(all.header.notices, IsEmpty());
    }
  }
}

TEST(LazSalvage, AFileThatIsCutOffGivesWholeLayeredChunks) {
  const LazFormat format = format_of(3);
  const LazFile file = file_of(format);
  const std::string bytes = file.bytes();
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const std::size_t size =
        i == 0 ? file.offset_to_table()
               : file.offset_to_chunk(0) +
                     random() % (file.offset_to_table() - file.offset_to_chunk(0));
    const std::size_t whole = std::min(kPoints, 100 * whole_chunks(file, size));
    for (const bool seekable : {true, false}) {
      SCOPED_TRACE(fmt::format("{} bytes, seekable {}", size, seekable));
      const AllPoints all = read(bytes.substr(0, size), seekable);
      EXPECT_EQ(all.points, first_of(points_of(format), whole));
      EXPECT_EQ(lost(all), kPoints - whole);
      EXPECT_EQ(all.header.count, seekable ? std::optional<std::uint64_t>(whole) : std::nullopt);
    }
  }
}

TEST(LazSalvage, AFileThatIsCutOffGivesPointwisePointsOfWhichAllBytesAreThere) {
  for (const int compressor : {1, 2}) {
    const LazFormat format = format_of(compressor);
    const LazFile file = file_of(format);
    const std::string bytes = file.bytes();
    std::mt19937 random(6);
    for (int i = 0; i < 60; ++i) {
      const std::size_t size =
          file.offset_to_chunk(0) + random() % (file.offset_to_table() - file.offset_to_chunk(0));
      for (const bool seekable : {true, false}) {
        SCOPED_TRACE(fmt::format("{} bytes, seekable {}", size, seekable));
        const AllPoints all = read(bytes.substr(0, size), seekable);
        EXPECT_EQ(all.points, first_of(points_of(format), all.points.size()));
        EXPECT_EQ(all.points.size() + lost(all), kPoints);
        EXPECT_EQ(all.header.count, std::nullopt);
        EXPECT_GE(all.points.size(), 100 * whole_chunks(file, size));
        if (compressor == 1) {
          const double share = static_cast<double>(size) / static_cast<double>(bytes.size());
          EXPECT_GE(static_cast<double>(all.points.size()), 0.8 * share * kPoints - 30);
        }
        EXPECT_THAT(all.notices, Contains(HasSubstr("lost")));
      }
    }
  }
}

TEST(LazSalvage, ATableThatIsMissingOrCutLosesNothing) {
  for (const int compressor : {2, 3}) {
    const LazFormat format = format_of(compressor);
    LazFile file = file_of(format);
    const std::size_t table = file.offset_to_table();
    const std::string whole = file.bytes();
    file.table_place = LazFile::Table::kMissing;
    for (const std::string& bytes : {whole.substr(0, table), whole.substr(0, table + 7),
                                     whole.substr(0, whole.size() - 1), file.bytes()}) {
      const AllPoints all = read(bytes);
      EXPECT_EQ(all.points, points_of(format)) << compressor;
      EXPECT_EQ(lost(all), 0U);
    }
  }
}

TEST(LazSalvage, ADamagedChunkIsLeftOutWholeAndItsPointsAreCounted) {
  for (const int compressor : {2, 3}) {
    const LazFormat format = format_of(compressor);
    LazFile file = file_of(format);
    std::string& chunk = file.chunks[4].bytes;
    std::fill(chunk.begin() + static_cast<std::ptrdiff_t>(compressor == 3 ? 80 : 40), chunk.end(),
              '\xff');
    std::vector<LatticePoint> expected = points_of(format);
    expected.erase(expected.begin() + 400, expected.begin() + 500);
    const AllPoints all = read(file.bytes());
    EXPECT_EQ(all.points, expected) << compressor;
    EXPECT_EQ(all.lost, 100U);
    EXPECT_EQ(all.header.count, kPoints);
    EXPECT_EQ(all.index[400], 500U);
    EXPECT_THAT(all.notices,
                ElementsAre(HasSubstr(fmt::format("100 points are lost: the chunk at byte {}",
                                                  file.offset_to_chunk(4)))));
  }
}

TEST(LazSalvage, OfADamagedLargeChunkNoPointComes) {
  for (const int compressor : {2, 3}) {
    LazFormat format = format_of(compressor, 263000);
    format.point_format = compressor == 3 ? 6 : 0;
    const std::vector<std::string> records = records_of(format, 300000);
    LazFile file = make_laz_file(format, records);
    EXPECT_EQ(read(file.bytes()).points.size(), 300000U);
    std::string& chunk = file.chunks[0].bytes;
    const auto damage = compressor == 3 ? chunk.begin() + 1000 : chunk.end() - 100000;
    std::fill(damage, damage + 100000, '\xff');
    const AllPoints all = read(file.bytes());
    ASSERT_EQ(all.points.size(), 37000U) << compressor;
    EXPECT_EQ(all.points.front(), point_of_record(records[263000]));
    EXPECT_EQ(all.points.back(), point_of_record(records.back()));
    EXPECT_EQ(all.lost, 263000U);
  }
}

TEST(LazSalvage, OfADamagedLargeChunkInAPipeNoPointComes) {
  LazFormat format = format_of(3, 263000);
  format.point_format = 6;
  LazFile file = make_laz_file(format, records_of(format, 300000));
  EXPECT_EQ(read(file.bytes(), false).points.size(), 300000U);
  std::string& chunk = file.chunks[0].bytes;
  std::fill_n(chunk.begin() + 1000, 100000, '\xff');
  const AllPoints all = read(file.bytes(), false);
  EXPECT_EQ(all.points.size(), 0U);
  EXPECT_EQ(all.lost, 300000U);
}

TEST(LazSalvage, PiecesOfADamagedFileAreReadInAnyOrder) {
  LazFile file = file_of(format_of(2));
  file.chunks[4].bytes.replace(40, 60, 60, '\xff');
  FaultyFileSystem files;
  files.files["a.laz"] = file.bytes();
  PointReaderOptions options;
  options.keep_withheld = options.salvage = true;
  const auto reader = open_point_reader(files, "a.laz", options);
  ASSERT_EQ(reader->pieces(), 10U);
  PointBlock block;
  reader->begin_piece(4);
  EXPECT_FALSE(reader->read(block));
  EXPECT_EQ(block.lost, 100U);
  reader->begin_piece(3);
  EXPECT_TRUE(reader->read(block));
  EXPECT_EQ(block.size(), 100U);
  EXPECT_EQ(block.index.front(), 300U);
}

TEST(LazSalvage, PointsThatTheHeaderDoesNotCountAreReadWhereTheyAreWhole) {
  for (const std::uint64_t told : {0, 650, 700, 930}) {
    LazFile layered = file_of(format_of(3));
    layered.count = told;
    for (const bool seekable : {true, false}) {
      const AllPoints all = read(layered.bytes(), seekable);
      EXPECT_EQ(all.points, points_of(format_of(3))) << told << seekable;
      EXPECT_FALSE(seekable && all.header.extent) << "it may be of the counted points";
      EXPECT_THAT(seekable ? all.header.notices : all.notices,
                  ElementsAre(HasSubstr(fmt::format("the header counts {} points, but", told))));
    }
    LazFile pointwise = file_of(format_of(2));
    pointwise.count = told;
    const AllPoints all = read(pointwise.bytes());
    EXPECT_EQ(all.points, first_of(points_of(format_of(2)), 900)) << told;
    EXPECT_EQ(lost(all), told == 930 ? 30U : 0U) << "the last chunk has others, too";
  }
  LazFormat format = format_of(2);
  format.counts = {300, 250, 400};
  LazFile variable = file_of(format);
  variable.count = 310;
  EXPECT_EQ(read(variable.bytes()).points, points_of(format));
}

TEST(LazSalvage, ACopcFileWithoutItsOctreeIsReadByItsChunks) {
  CopcFile file;
  file.nodes = {{{0, 0, 0, 0}, 40}, {{1, 0, 0, 0}, 30}, {{1, 1, 0, 0}, 20}};
  file.build();
  const std::string whole = file.bytes();
  PointReaderOptions bounds;
  bounds.bounds = Box<3>{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
  for (const PointReaderOptions& options : {PointReaderOptions(), bounds}) {
    EXPECT_EQ(read(whole, true, options).points.size(), 90U);
    EXPECT_EQ(read(whole.substr(0, file.pages_at), true, options).points.size(), 90U);
    const AllPoints all = read(whole.substr(0, file.laz.offset_to_chunk(2) + 5), true, options);
    EXPECT_EQ(all.points.size(), 70U);
    EXPECT_EQ(lost(all), 20U);
  }
}

TEST(LazSalvage, RandomDamageNeverEndsTheReading) {
  for (const int compressor : {1, 2, 3}) {
    const LazFormat format = format_of(compressor);
    const LazFile file = file_of(format);
    const std::string good = file.bytes();
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i) {
      std::string bytes = good;
      const std::size_t begin = file.offset_to_chunk(0);
      for (int k = 0; k < 3; ++k) {
        bytes[begin + random() % (bytes.size() - begin)] = static_cast<char>(random());
      }
      if (i % 2 == 0) bytes.resize(begin + random() % (bytes.size() - begin));
      for (const bool seekable : {true, false}) EXPECT_NO_THROW(read(bytes, seekable));
    }
  }
}

}  // namespace
}  // namespace spillway::test
