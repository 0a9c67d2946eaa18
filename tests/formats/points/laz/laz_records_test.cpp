#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_encoder.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"
#include "tests/formats/points/laz/laz_encoder/record_decoder.h"

// Whole records, with all their attributes, through the encoder of chunks and back.

namespace spillway::detail::testing {
namespace {

std::vector<std::byte> encoded(LazChunkEncoder& encoder, const std::vector<std::string>& records) {
  std::string all;
  for (const std::string& record : records) all += record;
  std::vector<std::byte> chunk;
  encoder.encode(as_bytes_of(all), chunk);
  return chunk;
}

void expect_back(const LazChunkFormat& format, LazChunkEncoder& encoder,
                 const std::vector<std::string>& all) {
  const std::vector<std::byte> chunk = encoded(encoder, all);
  const std::vector<std::string> back = decode_laz_records(format, chunk, all.size());
  ASSERT_EQ(back.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(back[i], all[i]) << "record " << i;
}

class LazRecords : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static std::vector<std::string> records(std::size_t count, std::size_t extra_bytes,
                                                        unsigned seed) {
    return RandomRecords{GetParam(), extra_bytes, count, seed}.make();
  }
};

INSTANTIATE_TEST_SUITE_P(PointFormats, LazRecords, ::testing::Range(0, 11),
                         [](const auto& tested) { return std::to_string(tested.param); });

TEST_P(LazRecords, ComeBackFromChunksOfAnySizeWithAnEncoderThatIsUsedAgain) {
  for (const std::size_t extra_bytes : {0, 3}) {
    const LazChunkFormat format = laz_format_to_write(GetParam(), extra_bytes);
    LazChunkEncoder encoder(format);
    for (const std::size_t count : {1, 2, 20'000, 300}) {
      expect_back(format, encoder, records(count, extra_bytes, 5));
    }
  }
}

TEST_P(LazRecords, ComeBackWhereOnlyCoordinatesChange) {
  const LazChunkFormat format = laz_format_to_write(GetParam(), 2);
  LazChunkEncoder encoder(format);
  expect_back(format, encoder, RandomRecords{GetParam(), 2, 500, 8, true, true}.make());
}

TEST_P(LazRecords, AnEncoderThatIsUsedAgainWritesTheSameBytes) {
  const LazChunkFormat format = laz_format_to_write(GetParam(), 1);
  LazChunkEncoder encoder(format);
  const std::vector<std::string> some = records(1000, 1, 1);
  const std::vector<std::byte> first = encoded(encoder, some);
  encoded(encoder, records(3000, 1, 2));
  EXPECT_EQ(encoded(encoder, some), first);
}

TEST(LazChunkEncoderVersions, LayersOfTheNextOneComeBackToo) {
  for (int point_format = 6; point_format <= 10; ++point_format) {
    const LazChunkFormat format{.items = laz_items(point_format, 3, 4), .layered = true};
    LazChunkEncoder encoder(format);
    expect_back(format, encoder, RandomRecords{point_format, 3, 5000, 6}.make());
  }
}

TEST(LazChunkEncoderVersions, AreThoseThatItWrites) {
  for (const int version : {1, 3}) {
    const LazChunkFormat format{.items = laz_items(0, 0, version), .layered = false};
    EXPECT_THROW(LazChunkEncoder{format}, Error) << version;
  }
}

}  // namespace
}  // namespace spillway::detail::testing
