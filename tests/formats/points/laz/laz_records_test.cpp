#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/chunk_encoder.h"
#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"
#include "tests/formats/points/laz/laz_encoder/decoded_records.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"

// Whole records, with all their attributes, through the encoders of chunks and back.

namespace spillway::test {
namespace {

using ::testing::Combine;
using ::testing::Range;
using ::testing::Values;

std::string joined(const std::vector<std::string>& records) {
  std::string all;
  for (const std::string& record : records) all += record;
  return all;
}

/// Decoders and encoders of items of one version.
class Codec {
 public:
  Codec(int point_format, std::size_t extra_bytes, int version)
      : format_{.items = laz_items(point_format, extra_bytes, version),
                .layered = point_format >= 6},
        decoder_(format_, LazDetail::kRecords) {}

  void expect_back(const std::vector<std::string>& records, const LazChunkOptions& options = {},
                   std::uint64_t at_a_time = 777) {
    const std::string chunk = encode_laz_chunk(format_.items, records, options);
    const std::size_t length = record_length_of(format_);
    const std::string back =
        decode_laz_records(decoder_, length, as_bytes_of(chunk), records.size(), at_a_time);
    ASSERT_EQ(back.size(), records.size() * length);
    for (std::size_t i = 0; i < records.size(); ++i) {
      ASSERT_EQ(back.substr(i * length, length), records[i]) << "record " << i;
    }
  }

 private:
  LazChunkFormat format_;
  LazChunkDecoder decoder_;
};

/// By point format and by version: 1 and 2 pointwise, 3 and 4 layered.
class LazRecords : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  [[nodiscard]] static int point_format() { return std::get<0>(GetParam()); }
  [[nodiscard]] static int version() { return std::get<1>(GetParam()); }

  [[nodiscard]] static std::vector<std::string> records(std::size_t count, std::size_t extra_bytes,
                                                        unsigned seed) {
    return RandomRecords{point_format(), extra_bytes, count, seed}.make();
  }
};

std::string name_of(const ::testing::TestParamInfo<std::tuple<int, int>>& tested) {
  return "Format" + std::to_string(std::get<0>(tested.param)) + "Version" +
         std::to_string(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Pointwise, LazRecords, Combine(Range(0, 6), Values(1, 2)), name_of);
INSTANTIATE_TEST_SUITE_P(Layered, LazRecords, Combine(Range(6, 11), Values(2, 3, 4)), name_of);

TEST_P(LazRecords, ComeBackFromChunksOfAnySizeWithADecoderThatIsUsedAgain) {
  for (const std::size_t extra_bytes : {0, 3}) {
    Codec codec(point_format(), extra_bytes, version());
    for (const std::size_t count : {1, 2, 20'000, 300, 1}) {
      codec.expect_back(records(count, extra_bytes, 5));
    }
  }
}

TEST_P(LazRecords, ComeBackOneAtATime) {
  Codec codec(point_format(), 1, version());
  codec.expect_back(records(400, 1, 9), {}, 1);
}

TEST_P(LazRecords, ComeBackWhereOnlyCoordinatesChange) {
  Codec codec(point_format(), 2, version());
  codec.expect_back(RandomRecords{point_format(), 2, 500, 8, true, true}.make());
}

TEST_P(LazRecords, ComeBackWhereNothingChanges) {
  Codec codec(point_format(), 2, version());
  codec.expect_back(std::vector<std::string>(1000, records(30, 2, 3).back()));
}

TEST_P(LazRecords, ComeBackAfterAChunkWithErrors) {
  const LazChunkFormat format{.items = laz_items(point_format(), 2, version()),
                              .layered = point_format() >= 6};
  LazChunkDecoder decoder(format, LazDetail::kRecords);
  const std::vector<std::string> some = records(200, 2, 4);
  const std::string chunk = encode_laz_chunk(format.items, some);
  const std::size_t length = record_length_of(format);
  EXPECT_THROW(
      decode_laz_records(decoder, length, as_bytes_of(chunk).first(chunk.size() - 20), 200),
      Failure);
  EXPECT_EQ(decode_laz_records(decoder, length, as_bytes_of(chunk), 200), joined(some));
}

class LayeredLazRecords : public LazRecords {};

INSTANTIATE_TEST_SUITE_P(Layered, LayeredLazRecords, Combine(Range(6, 11), Values(2, 3, 4)),
                         name_of);

TEST_P(LayeredLazRecords, ComeBackFromLayersOfWhichNoneIsEmpty) {
  Codec codec(point_format(), 2, version());
  codec.expect_back(RandomRecords{point_format(), 2, 500, 8, true, true}.make(),
                    {.all_layers = true});
}

TEST_P(LayeredLazRecords, ComeBackFromAnEmptyLayerOfHeights) {
  Codec codec(point_format(), 2, version());
  codec.expect_back(RandomRecords{point_format(), 2, 500, 8, true, true}.make(),
                    {.empty_z_layer = true});
}

class WrittenLazRecords : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(PointFormats, WrittenLazRecords, Range(0, 11),
                         [](const auto& tested) { return std::to_string(tested.param); });

TEST_P(WrittenLazRecords, ComeBackFromChunksOfAnySizeWithAnEncoderThatIsUsedAgain) {
  const LazChunkFormat format = laz_format_to_write(GetParam(), 3);
  LazChunkEncoder encoder(format);
  for (const std::size_t count : {1, 20'000, 300}) {
    const std::string all = joined(RandomRecords{GetParam(), 3, count, 5}.make());
    std::vector<std::byte> chunk;
    encoder.encode(as_bytes_of(all), chunk);
    EXPECT_TRUE(decode_laz_records(format, chunk, count) == all) << count;
  }
}

TEST_P(WrittenLazRecords, AreTheSameBytesFromAnEncoderThatIsUsedAgain) {
  const LazChunkFormat format = laz_format_to_write(GetParam(), 1);
  LazChunkEncoder encoder(format);
  const auto encoded = [&](std::size_t count, unsigned seed) {
    std::vector<std::byte> chunk;
    encoder.encode(as_bytes_of(joined(RandomRecords{GetParam(), 1, count, seed}.make())), chunk);
    return chunk;
  };
  const std::vector<std::byte> first = encoded(1000, 1);
  encoded(3000, 2);
  EXPECT_EQ(encoded(1000, 1), first);
}

TEST_P(WrittenLazRecords, AreTheSameBytesFromParts) {
  const LazChunkFormat format = laz_format_to_write(GetParam(), 2);
  const std::string all = joined(RandomRecords{GetParam(), 2, 5000, 3}.make());
  const std::size_t length = all.size() / 5000;
  LazChunkEncoder encoder(format);
  std::vector<std::byte> whole;
  encoder.encode(as_bytes_of(all), whole);
  for (const std::size_t part : {1, 7, 4999}) {
    std::vector<std::byte> chunk;
    encoder.add({});
    for (std::size_t at = 0; at < all.size(); at += part * length) {
      encoder.add(as_bytes_of(all).subspan(at, std::min(part * length, all.size() - at)));
    }
    encoder.finish(chunk);
    EXPECT_TRUE(chunk == whole) << part;
  }
}

TEST(LazChunkEncoderVersions, AreThoseThatItWrites) {
  for (const int version : {1, 3}) {
    const LazChunkFormat format{.items = laz_items(0, 0, version), .layered = false};
    EXPECT_THROW(LazChunkEncoder{format}, Failure) << version;
  }
}

}  // namespace
}  // namespace spillway::test
