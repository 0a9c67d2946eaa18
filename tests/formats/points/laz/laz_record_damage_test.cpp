#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/encoding/arithmetic_encoder.h"
#include "formats/points/laz/encoding/point14_encoder.h"
#include "src/error.h"
#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"
#include "tests/formats/points/laz/laz_encoder/decoded_records.h"
#include "tests/formats/points/laz/laz_encoder/laz_excerpt.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"
#include "tests/formats/shared_data.h"

// Damaged chunks where whole records are wanted: an Error or records, whatever the damage.

namespace spillway::test {
namespace {

using ::testing::Combine;
using ::testing::HasSubstr;
using ::testing::Range;
using ::testing::Values;

constexpr std::size_t kRecords = 60;
constexpr std::size_t kExtraBytes = 2;

LazChunkFormat format_of(int point_format, int version) {
  return {.items = laz_items(point_format, kExtraBytes, version), .layered = point_format >= 6};
}

std::string bytes_of_size(std::size_t size) {
  std::string bytes(sizeof(std::uint32_t), '\0');
  store(std::as_writable_bytes(std::span(bytes)).data(), static_cast<std::uint32_t>(size));
  return bytes;
}

/// Decodes chunks, whatever they are, with one decoder.
class Trial {
 public:
  explicit Trial(const LazChunkFormat& format)
      : length_(record_length_of(format)), decoder_(format, LazDetail::kRecords) {}

  /// The records, or nothing if there was an Failure.
  std::optional<std::string> records(const std::string& chunk, std::size_t count = kRecords) {
    try {
      return decode_laz_records(decoder_, length_, as_bytes_of(chunk), count);
    } catch (const Failure& error) {
      message_ = error.what();
      return std::nullopt;
    }
  }

  [[nodiscard]] const std::string& message() const { return message_; }

 private:
  std::size_t length_;
  LazChunkDecoder decoder_;
  std::string message_;
};

/// By point format and by version: 1 and 2 pointwise, 3 and 4 layered.
class LazRecordDamage : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  void SetUp() override {
    const auto [point_format, version] = GetParam();
    const std::vector<std::string> records =
        RandomRecords{point_format, kExtraBytes, kRecords, 21}.make();
    format_ = format_of(point_format, version);
    chunk_ = encode_laz_chunk(format_.items, records);
    for (const std::string& record : records) sound_ += record;
  }

  LazChunkFormat format_;
  std::string chunk_;
  std::string sound_;
};

std::string name_of(const ::testing::TestParamInfo<std::tuple<int, int>>& tested) {
  return "Format" + std::to_string(std::get<0>(tested.param)) + "Version" +
         std::to_string(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Pointwise, LazRecordDamage, Combine(Range(0, 6), Values(1, 2)), name_of);
INSTANTIATE_TEST_SUITE_P(Layered, LazRecordDamage, Combine(Range(6, 11), Values(3, 4)), name_of);

TEST_P(LazRecordDamage, CutOffAtAnyByteIsAnError) {
  Trial trial(format_);
  for (std::size_t size = 0; size < chunk_.size(); ++size) {
    ASSERT_FALSE(trial.records(chunk_.substr(0, size))) << size;
    ASSERT_THAT(trial.message(), HasSubstr("ends too early")) << size;
  }
  EXPECT_EQ(trial.records(chunk_), sound_);
}

TEST_P(LazRecordDamage, AnyByteFlippedGivesRecordsOrAnError) {
  Trial trial(format_);
  for (std::size_t at = 0; at < chunk_.size(); ++at) {
    for (const int mask : {0xff, 1 << at % 8}) {
      std::string damaged = chunk_;
      damaged[at] = static_cast<char>(damaged[at] ^ mask);
      ASSERT_NO_THROW(trial.records(damaged)) << at;
    }
  }
  EXPECT_EQ(trial.records(chunk_), sound_);
}

TEST_P(LazRecordDamage, NoiseGivesRecordsOrAnError) {
  Trial trial(format_);
  std::mt19937 random(17);
  const std::size_t head = record_length_of(format_);
  const std::size_t layers = format_.layered ? laz_layers(format_) : 0;
  for (int round = 0; round < 40; ++round) {
    constexpr std::size_t kLayerSize = 900;
    std::string noise = chunk_.substr(0, head);
    if (format_.layered) {
      noise += chunk_.substr(head, sizeof(std::uint32_t));
      for (std::size_t i = 0; i < layers; ++i) noise += bytes_of_size(kLayerSize);
    }
    const std::size_t size = noise.size() + kLayerSize * std::max<std::size_t>(layers, 40);
    while (noise.size() < size) noise += static_cast<char>(random());
    ASSERT_NO_THROW(trial.records(noise)) << round;
  }
  EXPECT_EQ(trial.records(chunk_), sound_);
}

TEST(LazRecordDamageOfLayers, EndsBehindTheLastPointAreErrorsInEachLayer) {
  const LazChunkFormat format = format_of(10, 3);
  const std::vector<std::string> records = RandomRecords{10, kExtraBytes, kRecords, 22}.make();
  const std::string chunk = encode_laz_chunk(format.items, records, {.all_layers = true});
  const std::size_t sizes_at = record_length_of(format) + 4;
  const std::size_t layers = laz_layers(format);
  std::size_t end = sizes_at + 4 * layers;
  Trial trial(format);
  for (std::size_t i = 0; i < layers; ++i) {
    const std::size_t size_at = sizes_at + 4 * i;
    const auto size = load<std::uint32_t>(as_bytes_of(chunk).data() + size_at);
    end += size;
    std::string damaged = chunk;
    damaged.insert(end, 1, '\0');
    damaged.replace(size_at, 4, bytes_of_size(size + 1));
    EXPECT_FALSE(trial.records(damaged)) << i;
    EXPECT_THAT(trial.message(), HasSubstr("longer than its points")) << i;
  }
}

TEST(LazRecordDamageOfLayers, TimesThatNeverSettleInASequenceAreAnError) {
  const LazChunkFormat format = format_of(6, 3);
  std::vector<std::string> records(2, RandomRecords{6, kExtraBytes, 1, 23}.make().front());
  records[1][22] ^= 1;  // the time
  std::string chunk = encode_laz_chunk(format.items, records);
  laz::ArithmeticEncoder encoder;
  laz::SymbolModel<5> without_step(5);
  for (int i = 0; i < 10; ++i) encoder.symbol(2, without_step);
  std::vector<std::byte> times;
  encoder.finish(times);
  const std::size_t size_at = record_length_of(format) + 4 + 4 * laz::Point14Encoder::kGpsTimeLayer;
  const auto size = load<std::uint32_t>(as_bytes_of(chunk).data() + size_at);
  chunk.replace(chunk.size() - size, size, as_text(times));
  chunk.replace(size_at, 4, bytes_of_size(times.size()));
  Trial trial(format);
  EXPECT_FALSE(trial.records(chunk, 2));
  EXPECT_THAT(trial.message(), HasSubstr("times are corrupt"));
}

/// Chunks of real files: a few places each.
class SharedLazRecordDamage : public ::testing::TestWithParam<std::string> {};

TEST_P(SharedLazRecordDamage, IsAnErrorOrRecords) {
  const std::filesystem::path path = shared_file(GetParam().c_str());
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const LazExcerpts excerpts(content_of(path));
  ASSERT_GT(excerpts.size(), 0U);
  const LazChunk& place = excerpts.chunk(0);
  const std::string chunk = excerpts.file(0).substr(excerpts.offset_to_chunk(), place.bytes);
  Trial trial(excerpts.format());
  for (std::size_t i = 0; i < 25; ++i) {
    const std::size_t at = i * chunk.size() / 25;
    std::string damaged = chunk;
    damaged[at] = static_cast<char>(~damaged[at]);
    EXPECT_NO_THROW(trial.records(damaged, place.count)) << at;
    EXPECT_FALSE(trial.records(chunk.substr(0, at), place.count)) << at;
  }
  EXPECT_TRUE(trial.records(chunk, place.count));
}

INSTANTIATE_TEST_SUITE_P(Files, SharedLazRecordDamage,
                         Values("1.2-with-color.copc.laz", "autzen_trim.laz", "crop_1.laz",
                                "las_with_several_extra_byte_bloc.laz", "lone-star.laz"),
                         [](const ::testing::TestParamInfo<std::string>& tested) {
                           std::string name = tested.param;
                           std::erase_if(name,
                                         [](unsigned char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

}  // namespace
}  // namespace spillway::test
