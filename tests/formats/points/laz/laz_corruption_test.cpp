#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "tests/formats/points/laz/laz_encoder/laz_damage.h"
#include "tests/formats/points/laz/laz_encoder/laz_excerpt.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"
#include "tests/test_paths.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::size_t kPoints = 120;
constexpr std::size_t kLayerSizes = 4 * std::size_t{11};  // bytes, in the layered format below

LazFormat pointwise_format(int version = 2) {
  LazFormat format;
  format.point_format = 3;
  format.extra_bytes = 1;
  format.version = version;
  format.chunk_size = 50;
  return format;
}

LazFormat layered_format(int version = 3) {
  LazFormat format;
  format.point_format = 7;
  format.extra_bytes = 1;
  format.compressor = 3;
  format.version = version;
  format.chunk_size = 50;
  return format;
}

std::vector<std::string> records_for(const LazFormat& format) {
  return RandomRecords{format.point_format, format.extra_bytes, kPoints, 11}.make();
}

LazFile make_file(const LazFormat& format) { return make_laz_file(format, records_for(format)); }

LazFormat variable(LazFormat format) {
  format.counts = {50, 50, 20};
  return format;
}

std::string error_of_file(const std::string& bytes, bool seekable = true) {
  std::string message = error_of([&] { read_laz(bytes, seekable); });
  EXPECT_THAT(message, StartsWith("a.laz: "));
  return message;
}

void expect_error_from_everywhere(const std::string& bytes, const char* what) {
  for (const bool seekable : {true, false}) {
    EXPECT_THAT(error_of_file(bytes, seekable), HasSubstr(what)) << (seekable ? "file" : "pipe");
  }
}

TEST(LazCorruption, CompressedFlagWithoutVlr) {
  LazFile file = make_file(pointwise_format());
  file.laz_records = 0;
  expect_error_from_everywhere(file.bytes(), "LAZ");
  file.compressed = 0x40;
  expect_error_from_everywhere(file.bytes(), "LAZ");
}

TEST(LazCorruption, TwoLazVlrs) {
  LazFile file = make_file(pointwise_format());
  file.laz_records = 2;
  expect_error_from_everywhere(file.bytes(), "LAZ");
}

TEST(LazCorruption, OldCompression) {
  LazFile file = make_file(pointwise_format());
  file.compressed = 0xc0;
  expect_error_from_everywhere(file.bytes(), "way before LAZ");
}

TEST(LazCorruption, LazVlrTooShort) {
  const LazFile file = make_file(pointwise_format());
  const std::size_t record = file.las.header_size();
  for (const std::uint16_t size : {0, 33, 34, 34 + 6 * 4 - 1}) {
    // The rest becomes a gap before the points.
    std::string bytes = file.bytes();
    put(bytes, record + 20, size);
    expect_error_from_everywhere(bytes, "LAZ");
  }
}

TEST(LazCorruption, UnknownCompressor) {
  for (const std::uint16_t compressor : {4, 65535}) {
    LazFile file = make_file(pointwise_format());
    file.compressor = compressor;
    expect_error_from_everywhere(file.bytes(), "compressor");
  }
}

TEST(LazCorruption, CompressorDoesNotMatchFormat) {
  for (const std::uint16_t compressor : {1, 2}) {
    LazFile file = make_file(layered_format());
    file.compressor = compressor;
    expect_error_from_everywhere(file.bytes(), "compressor");
  }
  LazFile file = make_file(pointwise_format());
  file.compressor = 3;
  expect_error_from_everywhere(file.bytes(), "compressor");
}

TEST(LazCorruption, UnknownCoder) {
  LazFile file = make_file(pointwise_format());
  file.coder = 1;
  expect_error_from_everywhere(file.bytes(), "coder");
}

TEST(LazCorruption, ItemVersionUnknown) {
  for (const LazFormat& format : {pointwise_format(), layered_format()}) {
    for (std::size_t item = 0; item < 3; ++item) {
      for (const std::uint16_t version : {0, 5, 65535}) {
        LazFile file = make_file(format);
        file.items[item].version = version;
        expect_error_from_everywhere(file.bytes(), "version");
      }
    }
  }
  LazFile file = make_file(pointwise_format());
  file.items[0].version = 3;
  expect_error_from_everywhere(file.bytes(), "version 3");
  file = make_file(layered_format());
  file.items[0].version = 1;
  expect_error_from_everywhere(file.bytes(), "version 1");
}

TEST(LazCorruption, VlrItemsDoNotMatchFormat) {
  const LazFile sound = make_file(pointwise_format());
  LazFile missing = sound;
  missing.items.pop_back();
  LazFile none = sound;
  none.items.clear();
  LazFile swapped = sound;
  std::swap(swapped.items[1], swapped.items[2]);
  LazFile wrong_size = sound;
  wrong_size.items[3].size = 2;
  LazFile unknown = sound;
  unknown.items[2].type = static_cast<LazItemType>(4);
  LazFile too_many = sound;
  too_many.items.push_back({LazItemType::kByte, 1, 2});
  for (const LazFile& file : {missing, none, swapped, wrong_size, unknown, too_many}) {
    expect_error_from_everywhere(file.bytes(), "LAZ record");
  }
}

TEST(LazCorruption, BadChunkCount) {
  for (const LazFormat& format : {pointwise_format(), variable(pointwise_format()),
                                  layered_format(), variable(layered_format())}) {
    const LazFile file = make_file(format);
    for (const std::uint32_t chunks : {0U, 2U, 100000U, 0xffffffffU}) {
      std::string bytes = file.bytes();
      put(bytes, file.offset_to_table() + 4, chunks);
      EXPECT_THAT(error_of_file(bytes), HasSubstr("chunk table")) << chunks;
    }
  }
}

TEST(LazCorruption, ChunkTableVersionUnknown) {
  LazFile file = make_file(pointwise_format());
  file.table_version = 1;
  EXPECT_THAT(error_of_file(file.bytes()), HasSubstr("version 1"));
}

TEST(LazCorruption, ChunkTablePointsOutside) {
  for (const LazFormat& format : {pointwise_format(), layered_format()}) {
    LazFile file = make_file(format);
    const auto table = static_cast<std::int64_t>(file.offset_to_table());
    const auto size = static_cast<std::int64_t>(file.bytes().size());
    for (const std::int64_t at :
         {std::int64_t{0}, std::int64_t{-2}, std::numeric_limits<std::int64_t>::min(),
          std::numeric_limits<std::int64_t>::max(), table + 1, table - 1, size - 7, size,
          static_cast<std::int64_t>(file.offset_to_points()) + 7}) {
      std::string bytes = file.bytes();
      put(bytes, file.offset_to_points(), at);
      // Through a pipe the table is not looked at, but the chunks must end there.
      expect_error_from_everywhere(bytes, "a.laz: ");
    }
    file.table_place = LazFile::Table::kStreamed;
    for (const std::int64_t at : {std::int64_t{-1}, std::int64_t{0}, size, table + 1}) {
      std::string bytes = file.bytes();
      put(bytes, bytes.size() - 8, at);
      error_of_file(bytes);
    }
  }
}

TEST(LazCorruption, ChunkSizesInTheTableAreWrong) {
  for (const LazFormat& format : {pointwise_format(), layered_format()}) {
    const LazFile sound = make_file(format);
    const std::uint32_t right = sound.table[1].bytes;
    for (const std::uint32_t bytes : {0U, 1U, right - 1, right + 1, 0x7fffffffU, 0xffffffffU}) {
      LazFile file = sound;
      file.table[1].bytes = bytes;
      SCOPED_TRACE(bytes);
      error_of_file(file.bytes());
    }
  }
}

TEST(LazCorruption, ChunkCountMismatch) {
  for (const LazFormat& format : {variable(pointwise_format()), variable(layered_format())}) {
    const LazFile sound = make_file(format);
    for (const std::array<std::uint32_t, 3>& counts : {std::array<std::uint32_t, 3>{49, 51, 20},
                                                       {51, 49, 20},
                                                       {50, 50, 19},
                                                       {50, 50, 21},
                                                       {0, 100, 20},
                                                       {50, 70, 0},
                                                       {0xffffffff, 51, 20},
                                                       {120, 0xffffffff, 1}}) {
      LazFile file = sound;
      for (std::size_t i = 0; i < 3; ++i) file.table[i].count = counts[i];
      SCOPED_TRACE(counts[0]);
      error_of_file(file.bytes());
    }
  }
}

TEST(LazCorruption, CountOfALayeredChunkIsNotThatOfTheTable) {
  const LazFile sound = make_file(layered_format());
  for (const std::uint32_t count : {0U, 49U, 51U, 0xffffffffU}) {
    LazFile file = sound;
    put(file.chunks[1].bytes, file.las.record_length(), count);
    SCOPED_TRACE(count);
    error_of_file(file.bytes(), true);
    error_of_file(file.bytes(), false);
  }
}

TEST(LazCorruption, LayerSizesBeyondChunk) {
  const LazFile sound = make_file(layered_format());
  const std::size_t sizes = sound.las.record_length() + 4;
  for (std::size_t layer = 0; layer < 11; ++layer) {
    const std::size_t at = sizes + 4 * layer;
    std::uint32_t right = 0;
    std::memcpy(&right, &sound.chunks[0].bytes[at], 4);
    for (const std::uint32_t size : {right + 1, right - 1, 0x10000000U, 0xffffffffU}) {
      LazFile file = sound;
      put(file.chunks[0].bytes, at, size);
      SCOPED_TRACE(::testing::Message() << "layer " << layer << " of " << size << " bytes");
      EXPECT_THAT(error_of_file(file.bytes()), HasSubstr("and its layers take"));
      EXPECT_THAT(error_of_file(file.bytes(), false), HasSubstr("the chunk at byte"));
    }
  }
}

TEST(LazCorruption, EmptyFirstLayer) {
  LazFile file = make_file(layered_format());
  std::string& chunk = file.chunks[0].bytes;
  const std::size_t sizes = file.las.record_length() + 4;
  std::uint32_t first = 0;
  std::memcpy(&first, &chunk[sizes], 4);
  put(chunk, sizes, std::uint32_t{0});
  chunk.erase(sizes + kLayerSizes, first);
  file.table[0].bytes -= first;
  expect_error_from_everywhere(file.bytes(), "no coordinates");
}

TEST(LazCorruption, StreamBeginsWithAnImpossibleValue) {
  LazFile pointwise = make_file(pointwise_format());
  put(pointwise.chunks[1].bytes, pointwise.las.record_length(), std::uint32_t{0xffffffff});
  expect_error_from_everywhere(pointwise.bytes(), "a.laz");
  LazFile layered = make_file(layered_format());
  put(layered.chunks[1].bytes, layered.las.record_length() + 4 + kLayerSizes,
      std::uint32_t{0xffffffff});
  expect_error_from_everywhere(layered.bytes(), "a.laz");
}

TEST(LazCorruption, HeaderSaysMorePointsThanThereAre) {
  for (const LazFormat& format :
       {pointwise_format(), pointwise_format(1), layered_format(), variable(layered_format())}) {
    LazFile file = make_file(format);
    for (const std::uint64_t count :
         {std::uint64_t{kPoints + 1}, std::uint64_t{151}, std::uint64_t{0xfffffffe}}) {
      file.count = count;
      SCOPED_TRACE(::testing::Message() << "format " << format.point_format << " version "
                                        << format.version << ", " << count << " points");
      expect_error_from_everywhere(file.bytes(), "a.laz: ");
    }
    if (file.las.minor < 4) continue;
    file.count = std::numeric_limits<std::uint64_t>::max();
    error_of_file(file.bytes(), true);
    error_of_file(file.bytes(), false);
  }
}

TEST(LazCorruption, HeaderSaysFewerPointsThanTheLastChunkHas) {
  for (const LazFormat& format : {pointwise_format(), layered_format()}) {
    LazFile file = make_file(format);
    file.count = kPoints - 1;
    expect_error_from_everywhere(file.bytes(), "the chunk at byte");
  }
}

TEST(LazCorruption, ChunksBeyondTheHeadersPointsAreIgnored) {
  for (const LazFormat& format :
       {pointwise_format(), layered_format(), variable(layered_format())}) {
    LazFile file = make_file(format);
    file.count = 100;
    for (const bool seekable : {true, false}) {
      EXPECT_EQ(read_laz(file.bytes(), seekable).size(), 100U) << seekable;
    }
  }
}

LazFormat unchunked_format() {
  LazFormat format = pointwise_format(1);
  format.compressor = 1;
  return format;
}

TEST(LazCorruption, OneStreamDoesNotEndWithTheFile) {
  const LazFile sound = make_file(unchunked_format());
  expect_error_from_everywhere(sound.bytes() + 'x', "its points end before it does");
  for (const std::uint64_t count : {kPoints - 1, kPoints + 1}) {
    LazFile file = sound;
    file.count = count;
    expect_error_from_everywhere(file.bytes(), "the chunk at byte");
  }
}

TEST(LazCorruption, OneStreamEndsWhereTheHeaderSaysThatRecordsBegin) {
  LazFile file = make_file(unchunked_format());
  file.las.minor = 4;
  file.evlrs = {{"x", 1, "?"}};
  const std::size_t end = file.offset_to_table();
  const std::string sound = file.bytes();
  for (const bool seekable : {true, false}) EXPECT_EQ(read_laz(sound, seekable).size(), kPoints);
  for (const std::size_t start : {end - 1, end + 1, sound.size()}) {
    std::string bytes = sound;
    put(bytes, 235, std::uint64_t{start});
    expect_error_from_everywhere(bytes, "the chunk at byte");
  }
  // Damaged beyond doubt, it stops nobody who wants points.
  std::string bytes = sound.substr(0, end);
  for (const std::uint64_t start : {std::uint64_t{0}, std::uint64_t{100}, ~std::uint64_t{0}}) {
    put(bytes, 235, start);
    for (const bool seekable : {true, false}) EXPECT_EQ(read_laz(bytes, seekable).size(), kPoints);
  }
}

TEST(LazCorruption, OneStreamEndsWhereTheHeaderSaysThatWaveformsBegin) {
  LazFormat format = unchunked_format();
  format.point_format = 4;
  LazFile file = make_file(format);
  std::string bytes = file.bytes() + "waves";
  expect_error_from_everywhere(bytes, "its points end before it does");
  put(bytes, 227, std::uint64_t{file.offset_to_table()});
  for (const bool seekable : {true, false}) EXPECT_EQ(read_laz(bytes, seekable).size(), kPoints);
}

TEST(LazCorruption, VariablePointwiseChunksWithoutATable) {
  LazFile file = make_file(variable(pointwise_format()));
  file.table_place = LazFile::Table::kMissing;
  expect_error_from_everywhere(file.bytes(), "table");
}

TEST(LazCorruption, FileEndsBeforeThePointer) {
  const LazFile file = make_file(pointwise_format());
  expect_error_from_everywhere(file.bytes().substr(0, file.offset_to_points() + 7),
                               "get a complete copy");
}

/// Small files of every kind, each with a name.
struct Small {
  const char* name;
  LazFormat format;
  LazFile::Table table = LazFile::Table::kSeekable;
};

void PrintTo(const Small& small, std::ostream* out) { *out << small.name; }

std::vector<Small> small_files() {
  LazFormat unchunked = pointwise_format(1);
  unchunked.point_format = 5;
  unchunked.compressor = 1;
  LazFormat waves = layered_format(4);
  waves.point_format = 10;
  return {{"PointwiseVersion1", unchunked},
          {"PointwiseVersion2", pointwise_format(), LazFile::Table::kStreamed},
          {"PointwiseVariable", variable(pointwise_format())},
          {"PointwiseNoTable", pointwise_format(), LazFile::Table::kMissing},
          {"LayeredVersion3", layered_format()},
          {"LayeredVersion4", variable(waves), LazFile::Table::kStreamed},
          {"LayeredNoTable", layered_format(4), LazFile::Table::kMissing}};
}

class LazDamage : public ::testing::TestWithParam<Small> {
 protected:
  void SetUp() override {
    const LazFormat& format = GetParam().format;
    LazFile file = make_laz_file(format, records_for(format));
    file.table_place = GetParam().table;
    bytes_ = file.bytes();
    end_of_chunks_ = file.offset_to_table();
    needs_table_ = file.chunk_size == LazFile::kVariable && file.compressor == 2;
    is_table_there_ = file.compressor >= 2 && file.table_place != LazFile::Table::kMissing;
    sound_ = read_laz(bytes_);
    ASSERT_EQ(sound_.size(), kPoints);
  }

  std::string bytes_;
  std::size_t end_of_chunks_ = 0;
  bool needs_table_ = false;
  bool is_table_there_ = false;
  PointBlock sound_;
};

TEST_P(LazDamage, CutOffAtAnyByte) {
  for (const bool seekable : {true, false}) {
    for (std::size_t size = 0; size < bytes_.size(); ++size) {
      const DamageOutcome outcome = read_damaged_laz(bytes_.substr(0, size), seekable, sound_);
      // All points of a pipe are there with its last chunk, if it can be read at all.
      const bool complete = !seekable && size >= end_of_chunks_ && !needs_table_;
      ASSERT_EQ(outcome == DamageOutcome::kError, !complete) << size;
    }
  }
}

TEST_P(LazDamage, AnyByteFlipped) {
  for (const bool seekable : {true, false}) {
    for (std::size_t at = 0; at < bytes_.size(); ++at) {
      for (const int mask : {0xff, 1 << at % 8}) {
        std::string damaged = bytes_;
        damaged[at] = static_cast<char>(damaged[at] ^ mask);
        ASSERT_NO_THROW(read_damaged_laz(damaged, seekable, sound_)) << at;
      }
    }
  }
}

TEST_P(LazDamage, AnyByteFlippedGivesAnErrorOrPointsWithAllTheirAttributes) {
  const PointBlock sound = read_laz(bytes_, true, LazCarried::kAll);
  ASSERT_GT(sound.record_size(), sound_.record_size());
  for (std::size_t at = 0; at < bytes_.size(); ++at) {
    for (const int mask : {0xff, 1 << at % 8}) {
      std::string damaged = bytes_;
      damaged[at] = static_cast<char>(damaged[at] ^ mask);
      ASSERT_NO_THROW(read_damaged_laz(damaged, true, sound, LazCarried::kAll)) << at;
    }
  }
  EXPECT_EQ(read_damaged_laz(bytes_, true, sound, LazCarried::kAll), DamageOutcome::kRight);
}

TEST_P(LazDamage, CutOffAtAnyByteIsAnErrorWithAllAttributesToo) {
  const PointBlock sound = read_laz(bytes_, true, LazCarried::kAll);
  for (std::size_t size = 0; size < bytes_.size(); ++size) {
    ASSERT_EQ(read_damaged_laz(bytes_.substr(0, size), true, sound, LazCarried::kAll),
              DamageOutcome::kError)
        << size;
  }
}

TEST_P(LazDamage, ExcerptsHaveTheBytesAndThePointsOfTheirChunk) {
  const LazExcerpts excerpts(bytes_);
  EXPECT_EQ(excerpts.size(), is_table_there_ ? 3U : 0U);
  for (std::size_t i = 0; i < excerpts.size(); ++i) {
    const LazChunk& chunk = excerpts.chunk(i);
    const std::string file = excerpts.file(i);
    EXPECT_EQ(file.substr(excerpts.offset_to_chunk(), chunk.bytes),
              bytes_.substr(chunk.offset, chunk.bytes));
    const PointBlock part = excerpts.points(sound_, i);
    EXPECT_EQ(part.size(), chunk.count);
    EXPECT_EQ(part.index.front(), 50 * i);
    EXPECT_EQ(read_damaged_laz(file, true, part), DamageOutcome::kRight);
    EXPECT_EQ(read_damaged_laz(file, false, part),
              needs_table_ ? DamageOutcome::kError : DamageOutcome::kRight);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LazDamage, ::testing::ValuesIn(small_files()),
                         [](const ::testing::TestParamInfo<Small>& tested) {
                           return tested.param.name;
                         });

/// The real files: a few places each; the laz_sweep driver goes through all.
class SharedLazDamage : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedLazDamage, IsAnErrorOrPoints) {
  const std::filesystem::path path = shared_data_folder() / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  const PointBlock sound = read_laz(bytes);

  std::vector<std::size_t> places;
  for (std::size_t at = 94; at < 700; at += 23) places.push_back(at);
  for (std::size_t i = 1; i <= 40; ++i) places.push_back(bytes.size() * i / 41);
  for (std::size_t back = 1; back < 40; back += 13) places.push_back(bytes.size() - back);
  for (const std::size_t at : places) {
    SCOPED_TRACE(at);
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    EXPECT_NO_THROW(read_damaged_laz(damaged, true, sound));
    // Nothing is missing if the end of the records behind the chunk table is.
    EXPECT_NE(read_damaged_laz(bytes.substr(0, at), true, sound), DamageOutcome::kOther);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SharedLazDamage,
                         ::testing::Values("1.2-with-color.copc.laz", "autzen_trim.laz",
                                           "crop_1.laz", "las_with_several_extra_byte_bloc.laz",
                                           "lone-star.laz",
                                           "simple-laszip-compressor-version-1.2r0.laz"),
                         [](const ::testing::TestParamInfo<const char*>& tested) {
                           std::string name = tested.param;
                           std::erase_if(name,
                                         [](unsigned char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

}  // namespace
}  // namespace spillway::test
