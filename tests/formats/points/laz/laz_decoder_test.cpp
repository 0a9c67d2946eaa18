// The parts of the LAZ decoder against vectors of a reference encoder, and chunks that are damaged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/return_tables.h"
#include "formats/points/laz/coding/streaming_median.h"
#include "src/error.h"

namespace spillway::test {
namespace {

using laz::ArithmeticDecoder;
using laz::BitModel;
using laz::IntegerDecoder;
using laz::StreamingMedian;
using laz::SymbolModel;
using ::testing::HasSubstr;
using Bytes = std::vector<std::byte>;

Bytes bytes_of(std::string_view hex) {
  Bytes bytes;
  std::string digits;
  for (const char digit : hex) {
    if (digit != ' ') digits += digit;
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::byte>(std::stoul(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

/// Gives bytes in spans of one size.
class SplitBytes : public LazBytes {
 public:
  explicit SplitBytes(std::span<const std::byte> bytes, std::size_t span_size = SIZE_MAX)
      : left_(bytes), span_size_(span_size) {}

  std::span<const std::byte> more() override {
    const auto given = left_.first(std::min(span_size_, left_.size()));
    left_ = left_.subspan(given.size());
    return given;
  }

  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::byte> left_;
  std::size_t span_size_;
};

template <unsigned N>
std::vector<std::uint32_t> distribution(const SymbolModel<N>& model) {
  std::vector<std::uint32_t> below;
  for (unsigned s = 0; s < N; ++s) below.push_back(model.below(s));
  return below;
}

TEST(LazSymbolModel, LearnsAsTheEncoderDoes) {
  SymbolModel<5> model(5);
  EXPECT_EQ(distribution(model), (std::vector<std::uint32_t>{0, 6553, 13107, 19660, 26214}));
  EXPECT_EQ(model.cycle().total, 5);
  EXPECT_EQ(model.cycle().until_update, 5);
  std::uint64_t i = 0;
  for (; i < 100; ++i) model.count(i * i % 5);
  EXPECT_EQ(distribution(model), (std::vector<std::uint32_t>{0, 6858, 19432, 19813, 20194}));
  EXPECT_EQ(model.cycle().total, 86);
  EXPECT_EQ(model.cycle().cycle, 22);
  EXPECT_EQ(model.cycle().until_update, 3);
  for (; i < 100000; ++i) model.count(i * i % 5);
  EXPECT_EQ(distribution(model), (std::vector<std::uint32_t>{0, 6553, 19657, 19659, 19661}));
  EXPECT_EQ(model.cycle().total, 17896);
  EXPECT_EQ(model.cycle().cycle, 88);
  EXPECT_EQ(model.cycle().until_update, 12);
}

/// Expects that every number is found where a walk over the distribution finds it.
template <unsigned Most>
void expect_finds_all(const SymbolModel<Most>& model) {
  constexpr std::uint32_t kLargestNumber = 32831;
  unsigned symbol = 0;
  for (std::uint32_t number = 0; number <= kLargestNumber; ++number) {
    while (symbol + 1 < model.symbols() && model.below(symbol + 1) <= number) ++symbol;
    const laz::SymbolFound found = model.find(number);
    ASSERT_EQ(found.symbol, symbol) << number;
    ASSERT_EQ(found.low, model.below(symbol));
    if (symbol + 1 < model.symbols()) {
      ASSERT_EQ(found.high, model.below(symbol + 1));
    }
  }
}

template <typename T>
class LazSearch : public ::testing::Test {};
using Sizes =
    ::testing::Types<std::integral_constant<unsigned, 2>, std::integral_constant<unsigned, 3>,
                     std::integral_constant<unsigned, 16>, std::integral_constant<unsigned, 17>,
                     std::integral_constant<unsigned, 33>, std::integral_constant<unsigned, 64>,
                     std::integral_constant<unsigned, 128>, std::integral_constant<unsigned, 256>,
                     std::integral_constant<unsigned, 516>>;
TYPED_TEST_SUITE(LazSearch, Sizes);

TYPED_TEST(LazSearch, FindsEverySymbolHoweverRare) {
  constexpr unsigned kMost = TypeParam::value;
  std::mt19937 random(kMost);
  for (const unsigned symbols : {kMost, std::max(2U, kMost / 3)}) {
    SymbolModel<kMost> model(symbols);
    expect_finds_all(model);
    for (const unsigned favourite : {0U, symbols / 2, symbols - 1}) {
      for (int i = 0; i < 60000; ++i) {
        model.count(random() % 50 == 0 ? random() % symbols : favourite);
      }
      expect_finds_all(model);
    }
  }
}

TEST(LazBitModel, LearnsAsTheEncoderDoes) {
  BitModel model;
  EXPECT_EQ(model.zero(), 4096);
  int i = 0;
  for (; i < 100; ++i) model.count(i % 3 == 0);
  EXPECT_EQ(model.zero(), 5367);
  for (; i < 20000; ++i) model.count(i % 3 == 0);
  EXPECT_EQ(model.zero(), 5461);
}

TEST(LazStreamingMedian, FollowsTheLastValues) {
  StreamingMedian median;
  std::vector<std::int32_t> medians;
  for (const int value : {10, 5, -3, 40, 7, 7, 0, 100, -50, 6}) {
    median.add(value);
    medians.push_back(median.get());
  }
  EXPECT_EQ(medians, (std::vector<std::int32_t>{0, 0, 0, 0, 5, 7, 7, 7, 7, 6}));
}

TEST(LazReturnTables, AreSymmetricWhereTheyShouldBe) {
  for (unsigned n = 0; n < 8; ++n) {
    for (unsigned r = 0; r < 8; ++r) {
      EXPECT_EQ(laz::kReturnMap8[n][r], laz::kReturnMap8[r][n]) << n << ' ' << r;
    }
  }
  EXPECT_EQ(laz::return_level(15, 1), 7);
  EXPECT_EQ(laz::return_level(1, 3), 2);
}

TEST(LazArithmeticDecoder, DecodesAReferenceStreamFromSpansOfAnySize) {
  const Bytes stream = bytes_of("A3D0DF38921A486504D3DC9CBA72E43C000000");
  for (std::size_t span_size = 1; span_size <= stream.size(); ++span_size) {
    SplitBytes split(stream, span_size);
    ArithmeticDecoder decoder({}, &split);
    SymbolModel<4> four(4);
    SymbolModel<100> hundred(100);
    BitModel bit;
    for (const unsigned expected : {2, 2, 0, 3, 3, 1, 2, 2, 2, 0}) {
      EXPECT_EQ(decoder.symbol(four), expected);
    }
    for (const unsigned expected : {57, 99, 0}) EXPECT_EQ(decoder.symbol(hundred), expected);
    for (const bool expected : {true, false, false, true, true, true}) {
      EXPECT_EQ(decoder.bit(bit), expected);
    }
    EXPECT_EQ(decoder.raw(5), 19);
    EXPECT_EQ(decoder.raw(16), 0xBEEF);
    EXPECT_EQ(decoder.raw(24), 0xABCDEF);
    EXPECT_EQ(decoder.raw(32), 0xDEADBEEF);
    EXPECT_EQ(decoder.symbol(four), 1);
    EXPECT_TRUE(decoder.rest().empty());
    EXPECT_EQ(split.left(), 0);
  }
}

TEST(LazArithmeticDecoder, RefusesWhatNoEncoderWrites) {
  EXPECT_THROW(ArithmeticDecoder(bytes_of("FFFFFFFF0000")), Failure);
  EXPECT_THROW(ArithmeticDecoder(bytes_of("000000")), Failure);
  // Just below the length, so that the number is 2^19 or more: shifting has cut the length.
  const Bytes stream = bytes_of("FFFFFFFE00000000");
  ArithmeticDecoder decoder(stream);
  EXPECT_THROW(decoder.raw(19), Failure);
}

TEST(LazArithmeticDecoder, NeverReadsBehindTheEnd) {
  const Bytes stream = bytes_of("0102030405");
  ArithmeticDecoder decoder(stream);
  decoder.raw(8);
  EXPECT_THROW(decoder.raw(8), Failure);
}

struct IntegerCase {
  std::int64_t prediction;
  std::size_t context;
  std::int64_t result;
  unsigned width;
};

TEST(LazIntegerDecoder, DecodesAReferenceStreamOf32Bits) {
  const Bytes stream = bytes_of("000F7912 8C49EA0C 864498F2 FE7CF8E3 B6983F00 0000");
  ArithmeticDecoder decoder(stream);
  IntegerDecoder<32> integers(2);
  for (const IntegerCase& c : {IntegerCase{0, 0, 0, 0},
                               {0, 0, 1, 0},
                               {0, 1, -1, 1},
                               {0, 1, 2, 1},
                               {100, 0, 97, 2},
                               {1000, 0, 1256, 8},
                               {-5, 1, 70000, 17},
                               {-2000000000, 0, 2000000000, 29},
                               {0, 0, -2147483648, 32},
                               {0, 1, 2147483647, 31},
                               {12345, 1, 12345, 0}}) {
    const auto prediction = static_cast<std::uint32_t>(c.prediction);
    EXPECT_EQ(static_cast<std::int32_t>(integers.decode(decoder, prediction, c.context)), c.result);
    EXPECT_EQ(integers.width(), c.width);
  }
  EXPECT_TRUE(decoder.rest().empty());
}

TEST(LazIntegerDecoder, DecodesAReferenceStreamOf16BitsTwiceWhenReset) {
  const Bytes stream = bytes_of("0F7948EE C0756834 84680000 00");
  IntegerDecoder<16> integers(1);
  for (int chunk = 0; chunk < 2; ++chunk) {
    integers.reset();
    ArithmeticDecoder decoder(stream);
    for (const IntegerCase& c : {IntegerCase{0, 0, 65535, 1},
                                 {65535, 0, 0, 0},
                                 {1000, 0, 40000, 15},
                                 {40000, 0, 1000, 15},
                                 {500, 0, 500, 0},
                                 {0, 0, 32768, 16}}) {
      EXPECT_EQ(integers.decode(decoder, static_cast<std::uint32_t>(c.prediction), 0), c.result);
      EXPECT_EQ(integers.width(), c.width);
    }
    EXPECT_TRUE(decoder.rest().empty());
  }
}

/// A chunk of a reference encoder, and its records.
struct ChunkCase {
  std::string name;
  LazChunkFormat format;
  std::vector<std::string_view> records;
  std::string_view chunk;
};

ChunkCase make_case(std::vector<LazItem> items, std::uint16_t version,
                    const std::vector<std::string_view>& records, std::string_view chunk) {
  ChunkCase c;
  c.name = "version " + std::to_string(version);
  c.format.items = std::move(items);
  c.format.layered = version > 2;
  for (LazItem& item : c.format.items) item.version = version;
  c.records = records;
  c.chunk = chunk;
  return c;
}

std::vector<ChunkCase> reference_chunks() {
  const std::vector<std::string_view> pointwise = {
      "2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d006400640001",
      "5abb050096d9090066ebffff831421020000010018451600c0bfd4407f006400720001",
      "07bb0500cfd909006eebffff791422020000010018451600c0bfd4407f0064007d0003",
      "baba0500c5d909007eebffff791423030000010018451600c0bfd4407b0064007d0003"};
  const std::vector<std::string_view> layered = {
      "4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d",
      "6bf9f3ff0bc10c00b8eeffffa8a642200200000001000000000060b1ef406400640064006d",
      "36e70c00cb45f9ff5b040000e6084310050000000100142700006085ee40760076006aec6d",
      "55e70c00ec45f9ff66040000e5084410050000000100142700006085ee40760076005fec6d",
      "bef9f3ff14c10c00aeeeffffa8a62120050000000100f02b3b0060b1ef406400640064006b",
      "ccf9f3ff22c10c009eeeffffa8a6222005f200000100f02b3b0060b1ef406e006e006e0069",
      "6af9f3ff37c10c009aeeffffaaa6212005f20000010005533b0060b1ef406e007a006e0069"};
  const std::vector<LazItem> pointwise_items = {{LazItemType::kPoint10, 20},
                                                {LazItemType::kGpsTime11, 8},
                                                {LazItemType::kRgb12, 6},
                                                {LazItemType::kByte, 1}};
  const std::vector<LazItem> layered_items = {
      {LazItemType::kPoint14, 30}, {LazItemType::kRgb14, 6}, {LazItemType::kByte14, 1}};
  std::vector<ChunkCase> cases;
  cases.push_back(make_case(
      pointwise_items, 1, pointwise,
      "2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d00640064000133a53e3c1764af6d6a90"
      "827042ebcfbe0c3cf7c0968200ae21ad81967e71ec1cdab60000"));
  cases.push_back(make_case(
      pointwise_items, 2, pointwise,
      "2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d006400640001c086c4be23a3dfc4461d"
      "481bb243721d3c790e14054a332015a3dfb1f6ec4d4fea72b21d54acc80681be75000000"));
  cases.push_back(make_case(
      layered_items, 3, layered,
      "4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d070000001e000000"
      "0e0000000a000000000000000d000000000000000a0000000000000012000000160000000a000000a26d50d422"
      "e7bcff4387abb4b8f10774fccdb32986c82d590c2386000000675bcebd19480f1908d41c000000020504028282"
      "7e000000e55fc7824e2fa71a0d1900000000000000f2f1870000004e7aab308000001b92dd4a530bd979000000"
      "63dd2bd2f1d2beb3ad79c3940f05657d329db1000000000000fefc7e82000000"));
  cases.push_back(make_case(
      layered_items, 4, layered,
      "4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d070000001e000000"
      "0e0000000a000000000000000d000000000000000a0000000000000012000000100000000a000000a26d50d422"
      "e7bcff4387abb4b8f10774fccdb32986c82d590c2386000000675bcebd19480f1908d41c000000020504028282"
      "7e000000e55fc7824e2fa71a0d1900000000000000f2f1870000004e7aab308000001b92dd4a530bd979000000"
      "63dd27d6e8d7a20618a0a8aec0000000000000fefd8082000000"));
  return cases;
}

LasFlags attributes_of(const Bytes& record, bool layered) {
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(record[i]); };
  const auto make = [](unsigned classification, unsigned number, unsigned count, unsigned flags) {
    return LasFlags{static_cast<std::uint8_t>(classification), static_cast<std::uint8_t>(number),
                    static_cast<std::uint8_t>(count), static_cast<std::uint8_t>(flags)};
  };
  if (layered) return make(byte(16), byte(14) % 16, byte(14) / 16, byte(15) % 16);
  return make(byte(15) % 32, byte(14) % 8, byte(14) / 8 % 8, byte(15) / 32);
}

/// Decodes the chunk in calls for two points at a time.
void decode_chunk(LazChunkDecoder& decoder, std::vector<LatticePoint>& points,
                  std::vector<LasFlags>& attributes) {
  for (std::size_t done = 0; done < points.size(); done += 2) {
    const std::size_t count = std::min<std::size_t>(2, points.size() - done);
    decoder.decode(
        std::span(points).subspan(done, count),
        attributes.empty() ? std::span<LasFlags>() : std::span(attributes).subspan(done, count));
  }
}

TEST(LazChunk, ReferenceChunksGiveTheirRecordsFromSpansOfAnySize) {
  for (const ChunkCase& c : reference_chunks()) {
    const Bytes chunk = bytes_of(c.chunk);
    for (const bool wants_attributes : {false, true}) {
      LazChunkDecoder decoder(c.format,
                              wants_attributes ? LazDetail::kFlags : LazDetail::kCoordinates);
      for (const std::size_t span_size :
           {std::size_t{1}, std::size_t{3}, std::size_t{40}, SIZE_MAX}) {
        SCOPED_TRACE(c.name + ", pieces of " + std::to_string(span_size));
        SplitBytes split(chunk, span_size);
        std::vector<LatticePoint> points(c.records.size());
        std::vector<LasFlags> attributes(wants_attributes ? c.records.size() : 0);
        decoder.begin(split, c.records.size());
        decode_chunk(decoder, points, attributes);
        EXPECT_EQ(decoder.end(), 0);
        EXPECT_EQ(split.left(), 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Bytes record = bytes_of(c.records[i]);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(points[i][axis], load<std::int32_t>(record.data() + 4 * axis)) << i;
          }
          if (wants_attributes) {
            EXPECT_EQ(attributes[i], attributes_of(record, c.format.layered)) << i;
          }
        }
      }
    }
  }
}

TEST(LazChunk, ReferenceChunksGiveTheirWholeRecordsFromSpansOfAnySize) {
  for (const ChunkCase& c : reference_chunks()) {
    const Bytes chunk = bytes_of(c.chunk);
    Bytes sound;
    for (const std::string_view record : c.records) {
      const Bytes bytes = bytes_of(record);
      sound.insert(sound.end(), bytes.begin(), bytes.end());
    }
    LazChunkDecoder decoder(c.format, LazDetail::kRecords);
    for (const std::size_t span_size :
         {std::size_t{1}, std::size_t{3}, std::size_t{40}, SIZE_MAX}) {
      SCOPED_TRACE(c.name + ", pieces of " + std::to_string(span_size));
      SplitBytes split(chunk, span_size);
      Bytes records(sound.size());
      decoder.begin(split, c.records.size());
      decoder.decode_records(records);
      EXPECT_EQ(decoder.end(), 0);
      EXPECT_EQ(split.left(), 0);
      EXPECT_EQ(records, sound);
    }
  }
}

TEST(LazDetail, TellsWhichLayersAreWanted) {
  const LazChunkFormat layered{.items = {{LazItemType::kPoint14, 30, 3},
                                         {LazItemType::kRgbNir14, 8, 3},
                                         {LazItemType::kByte14, 5, 3}},
                               .layered = true};
  EXPECT_EQ(laz_wanted_layers(layered, LazDetail::kCoordinates), 2U);
  EXPECT_EQ(laz_wanted_layers(layered, LazDetail::kFlags), 4U);
  EXPECT_EQ(laz_wanted_layers(layered, LazDetail::kRecords), 9U + 2 + 5);
}

TEST(LazChunk, TellsHowManyBytesLieBehindIt) {
  for (const ChunkCase& c : reference_chunks()) {
    SCOPED_TRACE(c.name);
    Bytes chunk = bytes_of(c.chunk);
    chunk.resize(chunk.size() + 5);
    SplitBytes split(chunk);
    LazChunkDecoder decoder(c.format, LazDetail::kFlags);
    std::vector<LatticePoint> points(c.records.size());
    std::vector<LasFlags> attributes(points.size());
    decoder.begin(split, points.size());
    decode_chunk(decoder, points, attributes);
    EXPECT_EQ(decoder.end(), 5);
  }
}

/// Decodes `chunk`, whatever it is: points or an Failure. The message is returned.
std::string outcome(LazChunkDecoder& decoder, std::span<const std::byte> chunk, std::size_t count) {
  SplitBytes split(chunk, 16);
  std::vector<LatticePoint> points(count);
  std::vector<LasFlags> attributes(count);
  try {
    decoder.begin(split, count);
    decode_chunk(decoder, points, attributes);
    decoder.end();
  } catch (const Failure& error) {
    return error.what();
  }
  return {};
}

TEST(LazChunk, TruncatedAnywhereIsAnError) {
  for (const ChunkCase& c : reference_chunks()) {
    const Bytes chunk = bytes_of(c.chunk);
    LazChunkDecoder decoder(c.format, LazDetail::kFlags);
    for (std::size_t size = 0; size < chunk.size(); ++size) {
      EXPECT_THAT(outcome(decoder, std::span(chunk).first(size), c.records.size()),
                  HasSubstr("ends too early"))
          << c.name << " cut to " << size;
    }
    EXPECT_EQ(outcome(decoder, chunk, c.records.size()), "") << "after errors";
  }
}

TEST(LazChunk, WrongCountInALayeredChunkIsAnError) {
  const ChunkCase c = reference_chunks().back();
  LazChunkDecoder decoder(c.format, LazDetail::kFlags);
  EXPECT_THAT(outcome(decoder, bytes_of(c.chunk), c.records.size() + 1),
              HasSubstr("another number of points"));
}

TEST(LazChunk, HugeLayerIsAnErrorAndTakesNoMemory) {
  const ChunkCase c = reference_chunks().back();
  LazChunkDecoder decoder(c.format, LazDetail::kFlags);
  Bytes chunk = bytes_of(c.chunk);
  store(chunk.data() + 37 + 4, std::uint32_t{0xFFFFFFFF});
  EXPECT_THAT(outcome(decoder, chunk, c.records.size()), HasSubstr("ends too early"));
}

TEST(LazChunk, FlippedBitsGivePointsOrAnError) {
  for (const ChunkCase& c : reference_chunks()) {
    const Bytes sound = bytes_of(c.chunk);
    LazChunkDecoder decoder(c.format, LazDetail::kFlags);
    for (std::size_t bit = 0; bit < 8 * sound.size(); ++bit) {
      Bytes chunk = sound;
      chunk[bit / 8] ^= std::byte{1} << bit % 8;
      outcome(decoder, chunk, c.records.size());
    }
    EXPECT_EQ(outcome(decoder, sound, c.records.size()), "");
  }
}

TEST(LazChunk, RandomBytesGivePointsOrAnError) {
  constexpr std::size_t kPoints = 2000;
  constexpr std::size_t kLayerSize = 3000;
  std::mt19937 random(7);
  const auto noise = [&] { return static_cast<std::byte>(random() & 255U); };
  std::vector<ChunkCase> cases = reference_chunks();
  for (const std::uint16_t version : {1, 2}) {
    cases.push_back(make_case({{LazItemType::kPoint10, 20},
                               {LazItemType::kGpsTime11, 8},
                               {LazItemType::kWavePacket13, 29},
                               {LazItemType::kByte, 40}},
                              version, {}, {}));
  }
  for (const ChunkCase& c : cases) {
    LazChunkDecoder decoder(c.format, LazDetail::kFlags);
    for (int round = 0; round < 20; ++round) {
      Bytes chunk(c.format.layered ? 37 + 4 + 12 * 4 + 4 * kLayerSize : 50000);
      std::generate(chunk.begin(), chunk.end(), noise);
      if (c.format.layered) {
        store(chunk.data() + 37, static_cast<std::uint32_t>(kPoints));
        for (std::size_t layer = 0; layer < 12; ++layer) {
          store(chunk.data() + 41 + 4 * layer,
                static_cast<std::uint32_t>(layer < 4 ? kLayerSize : 0));
        }
      }
      outcome(decoder, chunk, kPoints);
    }
  }
}

}  // namespace
}  // namespace spillway::test
