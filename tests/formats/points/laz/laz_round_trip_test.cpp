#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/formats/points/laz/laz_encoder/laz_damage.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

namespace spillway::test {
namespace {

constexpr std::size_t kPoints = 300;

/// Expects the points and attributes of `records` from the file.
void expect_records(const std::string& file, bool seekable, int point_format,
                    std::span<const std::string> records) {
  PointBlock got;
  try {
    got = read_laz(file, seekable);
  } catch (const Failure& error) {
    FAIL() << error.what();
  }
  ASSERT_EQ(got.points.size(), records.size());
  const std::vector<LasFlags> attributes = flags_of(got.attributes);
  ASSERT_EQ(attributes.size(), records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    ASSERT_EQ(got.points[i], point_of_record(records[i])) << "point " << i;
    ASSERT_EQ(attributes[i], attributes_of_record(point_format, records[i])) << "point " << i;
    ASSERT_EQ(got.index[i], i);
  }
}

struct Coding {
  int point_format;
  int compressor;
  int version;
};

std::ostream& operator<<(std::ostream& out, const Coding& coding) {
  return out << "format " << coding.point_format << ", compressor " << coding.compressor
             << ", version " << coding.version;
}

std::vector<Coding> all_codings() {
  std::vector<Coding> codings;
  for (int point_format = 0; point_format <= 5; ++point_format) {
    for (const int compressor : {1, 2}) {
      for (const int version : {1, 2}) codings.push_back({point_format, compressor, version});
    }
  }
  for (int point_format = 6; point_format <= 10; ++point_format) {
    for (const int version : {2, 3, 4}) codings.push_back({point_format, 3, version});
  }
  return codings;
}

class LazRoundTrip : public ::testing::TestWithParam<Coding> {
 protected:
  [[nodiscard]] LazFormat format(std::size_t extra_bytes = 0) const {
    LazFormat format;
    format.point_format = GetParam().point_format;
    format.compressor = GetParam().compressor;
    format.version = GetParam().version;
    format.extra_bytes = extra_bytes;
    return format;
  }
  [[nodiscard]] bool chunked() const { return GetParam().compressor >= 2; }

  [[nodiscard]] std::vector<std::string> records(std::size_t count,
                                                 std::size_t extra_bytes = 0) const {
    const auto form = static_cast<unsigned>(100 * GetParam().point_format + GetParam().version);
    const unsigned seed = form + 10 * static_cast<unsigned>(extra_bytes);
    return RandomRecords{GetParam().point_format, extra_bytes, count, seed}.make();
  }

  /// From a file that can be read anywhere and from a pipe, with each kind of table.
  void expect_from_everywhere(LazFile file, std::span<const std::string> records) const {
    for (const LazFile::Table place :
         {LazFile::Table::kSeekable, LazFile::Table::kStreamed, LazFile::Table::kMissing}) {
      file.table_place = place;
      const std::string bytes = file.bytes();
      // Only the table says where one pointwise chunk of variable size ends.
      const bool needs_table =
          file.compressor == 2 && (file.chunk_size == LazFile::kVariable || file.chunk_size == 0);
      for (const bool seekable : {true, false}) {
        SCOPED_TRACE(::testing::Message()
                     << "table " << static_cast<int>(place) << (seekable ? ", file" : ", pipe")
                     << ", chunk size " << file.chunk_size);
        if (needs_table && (place == LazFile::Table::kMissing || !seekable)) {
          EXPECT_THROW(read_laz(bytes, seekable), Failure);
        } else {
          expect_records(bytes, seekable, GetParam().point_format, records);
        }
      }
      if (!chunked()) return;
    }
  }
};

TEST_P(LazRoundTrip, ChunksOfOneSize) {
  for (const std::size_t extra_bytes : {0, 3}) {
    const std::vector<std::string> all = records(kPoints, extra_bytes);
    LazFormat chunks = format(extra_bytes);
    chunks.chunk_size = 97;
    expect_from_everywhere(make_laz_file(chunks, all), all);
  }
}

TEST_P(LazRoundTrip, OneChunkThatIsTheFile) {
  const std::vector<std::string> all = records(kPoints, 3);
  for (const std::uint32_t chunk_size : {300, 301, 50000}) {
    LazFormat chunks = format(3);
    chunks.chunk_size = chunk_size;
    expect_from_everywhere(make_laz_file(chunks, all), all);
  }
}

TEST_P(LazRoundTrip, ChunksOfVariousSizes) {
  if (!chunked()) return;
  for (const std::size_t extra_bytes : {0, 3}) {
    const std::vector<std::string> all = records(kPoints, extra_bytes);
    LazFormat chunks = format(extra_bytes);
    chunks.counts = {1, 100, 2, 1, 150, 45, 1};
    LazFile file = make_laz_file(chunks, all);
    expect_from_everywhere(file, all);
    file.chunk_size = 0;  // means the same
    expect_from_everywhere(file, all);
  }
}

TEST_P(LazRoundTrip, ChunksOfOnePoint) {
  const std::vector<std::string> all = records(20, 1);
  LazFormat chunks = format(1);
  chunks.chunk_size = 1;
  expect_from_everywhere(make_laz_file(chunks, all), all);
}

TEST_P(LazRoundTrip, OnePoint) {
  const std::vector<std::string> all = records(1);
  expect_from_everywhere(make_laz_file(format(), all), all);
}

TEST_P(LazRoundTrip, NoPoints) { expect_from_everywhere(make_laz_file(format(), {}), {}); }

TEST_P(LazRoundTrip, NoPointsAndNeitherPointerNorTable) {
  const LazFile file = make_laz_file(format(), {});
  const std::string bytes = file.bytes().substr(0, file.offset_to_points());
  expect_records(bytes, true, GetParam().point_format, {});
  expect_records(bytes, false, GetParam().point_format, {});
}

TEST_P(LazRoundTrip, OnlyCoordinatesChange) {
  for (const bool flat : {false, true}) {
    const std::vector<std::string> all =
        RandomRecords{GetParam().point_format, 3, kPoints, 7, true, flat}.make();
    for (const bool all_layers : {false, true}) {
      LazFormat chunks = format(3);
      chunks.chunk_size = 100;
      chunks.chunk = {all_layers, flat};
      expect_from_everywhere(make_laz_file(chunks, all), all);
    }
  }
}

TEST_P(LazRoundTrip, RecordsBehindTheTable) {
  const std::vector<std::string> all = records(kPoints);
  LazFormat chunks = format();
  chunks.chunk_size = 100;
  LazFile file = make_laz_file(chunks, all);
  file.las.minor = 4;
  file.evlrs = {{"somebody", 1, std::string(1000, 'e')}, {"somebody", 2, ""}};
  expect_from_everywhere(file, all);
}

TEST_P(LazRoundTrip, ManyPointsInAChunk) {
  // So many that every model halves its counts.
  const std::vector<std::string> all = records(70000);
  const LazFile file = make_laz_file(format(), all);
  expect_records(file.bytes(), true, GetParam().point_format, all);
  expect_records(file.bytes(), false, GetParam().point_format, all);
}

INSTANTIATE_TEST_SUITE_P(All, LazRoundTrip, ::testing::ValuesIn(all_codings()),
                         [](const ::testing::TestParamInfo<Coding>& tested) {
                           return "Format" + std::to_string(tested.param.point_format) +
                                  "Compressor" + std::to_string(tested.param.compressor) +
                                  "Version" + std::to_string(tested.param.version);
                         });

TEST(LazRoundTripOthers, PointwiseItemsOfDifferentVersions) {
  const std::vector<std::string> all = RandomRecords{5, 3, kPoints, 5}.make();
  for (unsigned versions = 0; versions < 16; ++versions) {
    LazFile file = make_laz_file({5, 3}, all);
    const auto version_of = [&](unsigned item) {
      return static_cast<std::uint16_t>(1 + (versions >> item & 1));
    };
    file.items[0].version = version_of(0);
    file.items[1].version = version_of(1);
    file.items[2].version = version_of(2);
    file.items[4].version = version_of(3);
    file.chunks[0].bytes = encode_laz_chunk(file.items, all);
    file.table[0].bytes = static_cast<std::uint32_t>(file.chunks[0].bytes.size());
    expect_records(file.bytes(), true, 5, all);
  }
}

TEST(LazRoundTripOthers, LayeredItemsOfDifferentVersions) {
  const std::vector<std::string> all = RandomRecords{10, 3, kPoints, 5}.make();
  LazFile file = make_laz_file({10, 3, 3, 3}, all);
  file.items[0].version = 4;
  file.items[2].version = 4;
  file.chunks[0].bytes = encode_laz_chunk(file.items, all);
  file.table[0].bytes = static_cast<std::uint32_t>(file.chunks[0].bytes.size());
  expect_records(file.bytes(), true, 10, all);
}

TEST(LazRoundTripOthers, EveryLasVersion) {
  const std::vector<std::string> all = RandomRecords{3, 0, kPoints, 5}.make();
  LazFile file = make_laz_file({3}, all);
  for (int minor = 0; minor <= 4; ++minor) {
    file.las.minor = minor;
    expect_records(file.bytes(), true, 3, all);
    expect_records(file.bytes(), false, 3, all);
  }
}

TEST(LazRoundTripOthers, MoreChunksInTheTableThanTheHeaderHasPoints) {
  for (const int point_format : {3, 7}) {
    const std::vector<std::string> all = RandomRecords{point_format, 0, kPoints, 5}.make();
    LazFormat format;
    format.point_format = point_format;
    format.compressor = point_format < 6 ? 2 : 3;
    format.version = format.compressor;
    for (const bool variable : {false, true}) {
      if (variable) format.counts = {100, 100, 100};
      format.chunk_size = 100;
      LazFile file = make_laz_file(format, all);
      file.count = 200;
      expect_records(file.bytes(), true, point_format, std::span(all).first(200));
    }
  }
}

TEST(LazRoundTripOthers, LazRecordWithoutTheFlagInThePointFormat) {
  const std::vector<std::string> all = RandomRecords{1, 0, kPoints, 5}.make();
  LazFile file = make_laz_file({1}, all);
  for (const int flag : {0, 0x40}) {
    file.compressed = static_cast<std::uint8_t>(flag);
    expect_records(file.bytes(), true, 1, all);
    expect_records(file.bytes(), false, 1, all);
  }
}

TEST(LazRoundTripOthers, PlainRecordsUnderALazRecord) {
  for (const int point_format : {1, 8}) {
    const std::vector<std::string> all = RandomRecords{point_format, 3, kPoints, 5}.make();
    LazFile file = make_laz_file({point_format, 3, 0, 0}, all);
    for (const int flag : {0, 0x80}) {
      file.compressed = static_cast<std::uint8_t>(flag);
      expect_records(file.bytes(), true, point_format, all);
      expect_records(file.bytes(), false, point_format, all);
    }
  }
}

TEST(LazRoundTripOthers, CoordinatesAloneAndWithheldPointsLeftOut) {
  for (const int point_format : {3, 7}) {
    const std::vector<std::string> all = RandomRecords{point_format, 1, kPoints, 5}.make();
    const int compressor = point_format < 6 ? 2 : 3;
    LazFormat format{point_format, 1, compressor, compressor};
    format.chunk_size = 64;
    const std::string bytes = make_laz_file(format, all).bytes();
    for (const bool keep : {true, false}) {
      std::vector<LatticePoint> points;
      std::vector<std::uint64_t> index;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const unsigned flags = attributes_of_record(point_format, all[i]).flags;
        if (!keep && (flags & LasFlags::kWithheld) != 0) continue;
        points.push_back(point_of_record(all[i]));
        index.push_back(i);
      }
      PointReaderOptions options;
      options.keep_withheld = keep;
      const AllPoints got = read_content("a.laz", bytes, options);
      EXPECT_EQ(got.points, points);
      EXPECT_EQ(got.index, index);
      EXPECT_TRUE(got.attributes.empty());
      EXPECT_EQ(got.withheld, all.size() - points.size());
      EXPECT_EQ(got.header.count, all.size());
    }
  }
}

TEST(LazRoundTripOthers, RecognisedByItsFirstBytes) {
  const std::vector<std::string> all = RandomRecords{1, 0, 10, 5}.make();
  const AllPoints got = read_content("a.something", make_laz_file({1}, all).bytes());
  EXPECT_EQ(got.header.point_format, 1);
  EXPECT_EQ(got.header.count, 10U);
}

}  // namespace
}  // namespace spillway::test
