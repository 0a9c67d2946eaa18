#include "formats/blocks/block.h"

#include <random>

#include "formats/bytes/bytes.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Bytes = std::vector<std::byte>;

Bytes random_bytes(std::size_t count) {
  std::mt19937 random(1);
  Bytes bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

Bytes runs(std::size_t count) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i / 100);
  return bytes;
}

/// Decodes a block that must end with the bytes; returns its kind.
std::uint32_t decode(const Bytes& block, Bytes& content) {
  if (block.size() < kBlockHeadSize) throw Failure("block: ends within the head");
  const BlockHead head =
      decode_block_head(std::span(block).first<kBlockHeadSize>(), {"a.spp", at_byte(8)});
  decode_block(head, std::span(block).subspan(kBlockHeadSize), content, {"a.spp", at_byte(8)});
  return head.kind;
}

TEST(Block, RoundTrip) {
  for (const Bytes& content : {Bytes{}, Bytes{std::byte{7}}, runs(2), runs(100000),
                               random_bytes(12), random_bytes(100000)}) {
    Bytes block;
    append_block(block, 0xfedcba98, content);
    EXPECT_LE(block.size(), kBlockHeadSize + content.size());
    Bytes back = {std::byte{1}};
    EXPECT_EQ(decode(block, back), 0xfedcba98);
    EXPECT_EQ(back, content);
  }
}

TEST(Block, CompressesWhatCanBe) {
  Bytes block;
  append_block(block, 1, runs(100000));
  EXPECT_LT(block.size(), 10000U);
}

TEST(Block, IsAppendedBehindOthers) {
  Bytes blocks;
  append_block(blocks, 1, runs(1000));
  const std::size_t first = blocks.size();
  append_block(blocks, 2, random_bytes(1000));
  Bytes content;
  EXPECT_EQ(decode({blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(first)}, content),
            1U);
  EXPECT_EQ(content, runs(1000));
  EXPECT_EQ(decode({blocks.begin() + static_cast<std::ptrdiff_t>(first), blocks.end()}, content),
            2U);
  EXPECT_EQ(content, random_bytes(1000));
}

TEST(Block, EveryFlippedBitIsSeen) {
  for (const Bytes& content : {runs(500), random_bytes(50), Bytes{}}) {
    Bytes block;
    append_block(block, 3, content);
    for (std::size_t bit = 0; bit < 8 * block.size(); ++bit) {
      Bytes flipped = block;
      flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      Bytes back;
      EXPECT_THAT(error_of([&] { decode(flipped, back); }),
                  AllOf(StartsWith("a.spp, byte 8: "), HasSubstr("corrupt")))
          << bit;
    }
  }
}

TEST(Block, Truncated) {
  Bytes block;
  append_block(block, 3, runs(500));
  for (std::size_t size = 0; size < block.size(); ++size) {
    const Bytes cut(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
    Bytes back;
    error_of([&] { decode(cut, back); });
  }
}

TEST(Block, ASizeThatNoCompressionReachesIsNotAllocated) {
  Bytes block;
  append_block(block, 3, runs(500));
  store(block.data() + 4, std::uint32_t{200U << 20U});
  Bytes back;
  EXPECT_THAT(error_of([&] { decode(block, back); }), HasSubstr("the head of a block is invalid"));
  EXPECT_EQ(back.capacity(), 0U);
}

}  // namespace
}  // namespace spillway::test
