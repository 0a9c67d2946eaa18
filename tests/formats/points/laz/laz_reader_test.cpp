#include <limits>
#include <thread>

#include "formats/inputs/open_points.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

LazFormat format_of(int compressor, std::uint32_t chunk_size = 100) {
  LazFormat format;
  format.point_format = compressor == 3 ? 7 : 3;
  format.compressor = compressor;
  format.version = compressor == 3 ? 3 : 2;
  format.chunk_size = chunk_size;
  return format;
}

std::vector<std::string> records_of(const LazFormat& format, std::size_t count) {
  return RandomRecords{format.point_format, format.extra_bytes, count, 3}.make();
}

std::string file_of(const LazFormat& format, std::size_t count) {
  return make_laz_file(format, records_of(format, count)).bytes();
}

std::vector<LatticePoint> points_of(const std::vector<std::string>& records) {
  std::vector<LatticePoint> points;
  points.reserve(records.size());
  for (const std::string& record : records) points.push_back(point_of_record(record));
  return points;
}

PointReaderOptions all_points() { return {"", true}; }

/// A file system with one file.
struct OneFile {
  explicit OneFile(std::string content, bool seekable = true) {
    files.files["a.laz"] = std::move(content);
    files.seekable = seekable;
  }
  FaultyFileSystem files;
};

TEST(LazReader, TellsWhatTheHeaderSays) {
  const PointHeader header = read_content("a.laz", file_of(format_of(2), 250)).header;
  EXPECT_EQ(header.format, "laz");
  EXPECT_EQ(header.version, "1.2");
  EXPECT_EQ(header.point_format, 3);
  EXPECT_EQ(header.count, 250U);
  EXPECT_EQ(header.software, "by hand");
}

TEST(LazReader, ChunksThatTheHeaderDoesNotCountAreLeftOutAndSaid) {
  for (const int compressor : {2, 3}) {
    std::string bytes = file_of(format_of(compressor), 950);
    EXPECT_THAT(read_content("a.laz", bytes).header.notices, IsEmpty());
    put(bytes, 107, std::uint32_t{700});
    if (compressor == 3) put(bytes, 247, std::uint64_t{700});
    const AllPoints all = read_content("a.laz", bytes, all_points());
    EXPECT_EQ(all.points.size(), 700U);
    EXPECT_THAT(all.header.notices,
                ElementsAre(HasSubstr("the header counts 700 points, but 3 more chunks of them "
                                      "follow, which are not read")));
  }
}

TEST(LazReader, ChunksOfAHeaderThatCountsNoPointsAreSaid) {
  for (const int compressor : {2, 3}) {
    std::string bytes = file_of(format_of(compressor), 950);
    put(bytes, 107, std::uint32_t{0});
    if (compressor == 3) put(bytes, 247, std::uint64_t{0});
    const AllPoints all = read_content("a.laz", bytes, all_points());
    EXPECT_EQ(all.points.size(), 0U);
    EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("counts 0 points, but 10 more chunks")));
    bytes.resize(make_laz_file(format_of(compressor), {}).offset_to_points());
    EXPECT_THAT(read_content("a.laz", bytes).header.notices, IsEmpty());
  }
}

TEST(LazReader, ChunksThatTheHeaderDoesNotCountAreSaidAtTheEndOfAPipe) {
  for (const int compressor : {2, 3}) {
    std::string bytes = file_of(format_of(compressor), 950);
    OneFile whole(bytes, false);
    EXPECT_THAT(read_all_points(whole.files, "a.laz").notices, IsEmpty());
    for (const std::uint32_t told : {0, 700}) {
      put(bytes, 107, told);
      if (compressor == 3) put(bytes, 247, std::uint64_t{told});
      OneFile pipe(bytes, false);
      const AllPoints all = read_all_points(pipe.files, "a.laz", all_points());
      EXPECT_EQ(all.points.size(), told);
      EXPECT_THAT(all.notices, ElementsAre(HasSubstr("but more chunks of them follow")));
    }
  }
}

TEST(LazReader, ReadsWholePointsThoughTheHeaderCountsRecordsThatAreNotThere) {
  for (const int compressor : {2, 3}) {
    const std::string good = file_of(format_of(compressor), 250);
    std::string bytes = good;
    put(bytes, 100, std::uint32_t{0xffffffff});
    const AllPoints all = read_content("a.laz", bytes, all_points());
    EXPECT_EQ(all.points, read_content("a.laz", good, all_points()).points);
    EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("4294967295 variable length records")));
  }
}

TEST(LazReader, AllThreeNamesOfTheFormatWillDo) {
  const std::string bytes = file_of(format_of(2), 9);
  for (const char* name : {"las", "laz", "copc"}) {
    EXPECT_EQ(read_content("points", bytes, {name, true}).points.size(), 9U);
    EXPECT_EQ(read_content("points", LasFile().bytes(), {name, true}).header.format, "las");
  }
}

TEST(LazReader, PiecesAreChunksThatAnyThreadDecodes) {
  for (const int compressor : {2, 3}) {
    const LazFormat format = format_of(compressor);
    const std::vector<std::string> records = records_of(format, 950);
    OneFile file(make_laz_file(format, records).bytes());
    const auto reader = open_point_reader(file.files, "a.laz", all_points());
    std::vector<RawPoints> pieces(10);
    for (RawPoints& piece : pieces) ASSERT_TRUE(reader->fetch(piece));
    RawPoints none;
    EXPECT_FALSE(reader->fetch(none));
    std::vector<PointBlock> blocks(pieces.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 0; t < 3; ++t) {
        threads.emplace_back([&, t] {
          for (std::size_t i = t; i < pieces.size(); i += 3) {
            reader->decode(pieces[pieces.size() - 1 - i], blocks[pieces.size() - 1 - i]);
          }
        });
      }
    }
    std::vector<LatticePoint> points;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      EXPECT_EQ(blocks[i].index.front(), 100 * i);
      points.insert(points.end(), blocks[i].points.begin(), blocks[i].points.end());
    }
    EXPECT_EQ(points, points_of(records));
  }
}

TEST(LazReader, LargeChunksComeInBlocksThatAreDecodedInOrder) {
  for (const int compressor : {1, 2, 3}) {
    LazFormat format = format_of(compressor, 263000);
    format.point_format = compressor == 3 ? 6 : 0;
    const std::vector<std::string> records = records_of(format, compressor == 1 ? 70000 : 264000);
    const std::string bytes = make_laz_file(format, records).bytes();
    for (const bool seekable : {true, false}) {
      OneFile file(bytes, seekable);
      const auto reader = open_point_reader(file.files, "a.laz", all_points());
      std::vector<LatticePoint> points;
      RawPoints raw;
      PointBlock block;
      while (reader->fetch(raw)) {
        EXPECT_LE(raw.records(), 65536U);
        reader->decode(raw, block);
        points.insert(points.end(), block.points.begin(), block.points.end());
      }
      EXPECT_TRUE(points == points_of(records)) << compressor << seekable;
    }
  }
}

TEST(LazReader, LayersThatNobodyWantsAreNotLookedAt) {
  const LazFormat format = format_of(3);
  const std::vector<std::string> records = records_of(format, 90);
  LazFile file = make_laz_file(format, records);
  std::string& chunk = file.chunks[0].bytes;
  std::size_t wanted = 36 + 4 + 10 * 4;
  for (std::size_t layer = 0; layer < 2; ++layer) {
    std::uint32_t size = 0;
    std::memcpy(&size, &chunk[36 + 4 + 4 * layer], 4);
    wanted += size;
  }
  std::fill(chunk.begin() + static_cast<std::ptrdiff_t>(wanted), chunk.end(), '\xff');
  for (const bool seekable : {true, false}) {
    OneFile damaged(file.bytes(), seekable);
    EXPECT_EQ(read_all_points(damaged.files, "a.laz", all_points()).points, points_of(records));
    EXPECT_THAT(error_of([&] { read_all_points(damaged.files, "a.laz"); }),
                StartsWith("a.laz: the chunk at byte "));
  }
}

TEST(LazReader, TellsHowFarItIs) {
  for (const int compressor : {1, 2, 3}) {
    OneFile file(file_of(format_of(compressor, 50000), 100000));
    const auto reader = open_point_reader(file.files, "a.laz", {});
    EXPECT_EQ(reader->fraction_read(), 0.0);
    PointBlock block;
    reader->read(block);
    EXPECT_NEAR(*reader->fraction_read(), 0.6, 0.2);
    reader->read(block);
    EXPECT_EQ(reader->fraction_read(), 1.0);
  }
}

TEST(LazReader, LeavesOutTheAttributesThatNobodyAskedFor) {
  const AllPoints all = read_content("a.laz", file_of(format_of(3), 100));
  EXPECT_TRUE(all.attributes.empty());
  EXPECT_GT(all.withheld, 0U);
  EXPECT_EQ(all.points.size() + all.withheld, 100U);
}

TEST(LazFaults, EveryFailingReadIsReportedAsItIs) {
  for (const int compressor : {1, 2, 3}) {
    for (const bool seekable : {true, false}) {
      OneFile file(file_of(format_of(compressor), 1000), seekable);
      read_all_points(file.files, "a.laz");
      const int reads = file.files.count(Call::kRead);
      ASSERT_GE(reads, 2);
      for (int n = 1; n <= reads; ++n) {
        file.files.fail(Call::kRead, n, "the cable was pulled");
        EXPECT_EQ(error_of([&] { read_all_points(file.files, "a.laz"); }), "the cable was pulled")
            << compressor << seekable << n;
      }
    }
  }
}

TEST(LazFaults, AFileThatShrinksIsAnError) {
  for (const int compressor : {1, 2, 3}) {
    OneFile file(file_of(format_of(compressor), 1000));
    const auto reader = open_point_reader(file.files, "a.laz", {});
    file.files.reads_end_at = 2000;
    EXPECT_THAT(error_of([&] {
                  PointBlock block;
                  while (reader->read(block)) {
                  }
                }),
                HasSubstr("get a complete copy"));
  }
}

TEST(LazFaults, LayersOfEnormousSizeOnAPipeUseNoMemory) {
  LazFile file = make_laz_file(format_of(3), records_of(format_of(3), 90));
  put(file.chunks[0].bytes, 36 + 4, std::uint32_t{0xfffffff0});
  file.table_place = LazFile::Table::kStreamed;
  OneFile pipe(file.bytes(), false);
  EXPECT_THAT(error_of([&] { read_all_points(pipe.files, "a.laz"); }),
              HasSubstr("after 0 of 90 points; get a complete copy"));
}

TEST(LazFaults, EnormousCountsUseNoMemory) {
  for (const int compressor : {1, 2, 3}) {
    for (const bool seekable : {true, false}) {
      LazFormat format = format_of(compressor, 4000000000);
      LazFile file = make_laz_file(format, records_of(format, 90));
      file.count = 4000000000;
      if (compressor == 3) put(file.chunks[0].bytes, 36, std::uint32_t{4000000000});
      OneFile damaged(file.bytes(), seekable);
      EXPECT_THAT(error_of([&] { read_all_points(damaged.files, "a.laz"); }),
                  StartsWith("a.laz: the chunk at byte "));
    }
  }
}

/// Records behind the points tell the coordinate system.
LazFile file_with_evlrs(std::vector<LasFile::Vlr> evlrs) {
  LazFile file = make_laz_file(format_of(3), records_of(format_of(3), 90));
  file.evlrs = std::move(evlrs);
  return file;
}

TEST(LasExtendedRecords, TellTheCoordinateSystemOfFilesButNotOfPipes) {
  const std::string bytes =
      file_with_evlrs({{"x", 1, "?"}, {"LASF_Projection", 2112, "PROJCS[]"}}).bytes();
  OneFile file(bytes);
  const AllPoints all = read_all_points(file.files, "a.laz", all_points());
  EXPECT_EQ(all.header.crs, "PROJCS[]");
  EXPECT_EQ(all.points.size(), 90U);
  file.files.seekable = false;
  EXPECT_EQ(read_all_points(file.files, "a.laz").header.crs, "");
}

TEST(LasExtendedRecords, AreNotAskedWhereTheOthersTell) {
  LazFile file = file_with_evlrs({{"LASF_Projection", 2112, "PROJCS[behind]"}});
  file.las.vlrs = {{"LASF_Projection", 2112, "PROJCS[before]"}};
  EXPECT_EQ(read_content("a.laz", file.bytes()).header.crs, "PROJCS[before]");
}

TEST(LasExtendedRecords, DamageIsPassedOver) {
  const std::string bytes = file_with_evlrs({{"LASF_Projection", 2112, "PROJCS[]"}}).bytes();
  std::uint64_t at = 0;
  std::memcpy(&at, &bytes[235], sizeof(at));
  const auto crs_with = [&](std::size_t place, auto value) {
    std::string damaged = bytes;
    put(damaged, place, value);
    const AllPoints all = read_content("a.laz", damaged, all_points());
    EXPECT_EQ(all.points.size(), 90U);
    return all.header.crs;
  };
  constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(crs_with(243, std::uint32_t{0xffffffff}), "PROJCS[]");
  for (const std::uint64_t start : {std::uint64_t{0}, std::uint64_t{100}, at + 60, kMost}) {
    EXPECT_EQ(crs_with(235, start), "");
  }
  for (const std::uint64_t length : {std::uint64_t{9}, kMost - 59, kMost}) {
    EXPECT_EQ(crs_with(at + 20, length), "");
  }
}

TEST(LasVersions, Version5IsReadAsVersion4) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  std::string bytes = file.bytes();
  put(bytes, 25, std::uint8_t{5});
  const AllPoints all = read_content("a.las", bytes, all_points());
  EXPECT_EQ(all.header.version, "1.5");
  EXPECT_EQ(all.points.size(), 3U);
}

/// A LAS 1.0 file with two bytes more before the points, to which its header does not point.
std::string file_with_start_signature(const std::string& signature) {
  LasFile file;
  file.minor = 0;
  std::string bytes = file.bytes();
  bytes.insert(file.offset_to_points(), signature);
  return bytes;
}

TEST(LasVersions, TheTwoBytesBeforeThePointsOfVersion0AreSteppedOver) {
  for (const char* signature : {"\xDD\xCC", "\xCC\xDD"}) {
    std::string bytes = file_with_start_signature(signature);
    EXPECT_EQ(read_content("a.las", bytes, all_points()).points[0], (LatticePoint{1, 2, 3}));
    FaultyFileSystem pipe;
    pipe.seekable = false;
    pipe.files["-"] = bytes;
    EXPECT_THAT(error_of([&] { read_all_points(pipe, "-"); }), HasSubstr("give it by its name"));
    put(bytes, 25, std::uint8_t{1});  // other versions have no such bytes
    EXPECT_NE(read_content("a.las", bytes, all_points()).points[0], (LatticePoint{1, 2, 3}));
  }
}

TEST(LasVersions, TheyArePartOfThePointsWhereThereIsNoRoomForThem) {
  LasFile file;
  file.minor = 0;
  file.records = {{0xCCDD, 2, 3}};
  EXPECT_THAT(read_content("a.las", file.bytes()).points, ElementsAre(LatticePoint{0xCCDD, 2, 3}));
}

}  // namespace
}  // namespace spillway::test
