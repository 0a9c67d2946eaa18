// Points as blocks of a file, and back; corrupt blocks are refused.

#include "stream/points/encoded_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formats/blocks/block.h"
#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kPiece = PointBuffer::kChunk;

PointBlock random_points(std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  PointBlock block;
  for (std::size_t i = 0; i < count; ++i) {
    block.points.push_back({unit(random), 1e9 * unit(random), std::floor(100 * unit(random))});
    block.index.push_back(random());
    for (int b = 0; b < 3; ++b) block.attributes.push_back(static_cast<std::byte>(random()));
  }
  return block;
}

std::string error_of(std::span<const std::byte> block) {
  PointBlock points;
  try {
    decode_points(block, {"tile 7", at_byte(0)}, points);
  } catch (const Failure& error) {
    return error.what();
  }
  return "no error";
}

TEST(EncodedBlock, OneBlockComesBack) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kPiece}) {
    const PointBlock points = random_points(count);
    std::vector<std::byte> bytes;
    append_points(bytes, PointsView::of(points));
    PointBlock back = random_points(5);  // to be replaced
    decode_points(bytes, {"here"}, back);
    EXPECT_EQ(back.points, points.points);
    EXPECT_EQ(back.index, points.index);
    EXPECT_EQ(back.attributes, points.attributes);
  }
}

TEST(EncodedBlock, WithoutIndicesAndAttributesNoneComeBack) {
  const PointBlock points = random_points(100);
  std::vector<std::byte> bytes;
  append_points(bytes, {points.points});
  PointBlock back = random_points(5);
  decode_points(bytes, {"here"}, back);
  EXPECT_EQ(back.points, points.points);
  EXPECT_TRUE(back.index.empty());
  EXPECT_TRUE(back.attributes.empty());
}

TEST(EncodedBlock, ABufferBecomesABlockForEachPiece) {
  const PointBlock points = random_points(2 * kPiece + 3);
  PointBuffer buffer;
  buffer.append(PointsView::of(points));
  std::vector<std::byte> bytes(11);  // what stands there already stays
  const std::vector<EncodedBlock> blocks = encode_points(buffer, bytes);
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(blocks.front().offset, 11U);
  EXPECT_EQ(blocks.back().offset + blocks.back().size, bytes.size());
  PointBlock all;
  for (const EncodedBlock& block : blocks) {
    PointBlock some;
    decode_points(std::span(bytes).subspan(block.offset, block.size), {"here"}, some);
    EXPECT_EQ(some.size(), block.points);
    PointsView::of(some).append_to(all);
  }
  EXPECT_EQ(all.points, points.points);
  EXPECT_EQ(all.index, points.index);
  EXPECT_EQ(all.attributes, points.attributes);
}

TEST(EncodedBlock, AnyNumberOfPointsComesBackAsOne) {
  for (const std::size_t count : {std::size_t{0}, kPiece, 2 * kPiece + 1}) {
    const PointBlock points = random_points(count);
    std::vector<std::byte> bytes;
    append_all_points(bytes, PointsView::of(points));
    PointBlock back = random_points(5);
    decode_all_points(bytes, {"here"}, back);
    EXPECT_EQ(back.points, points.points);
    EXPECT_EQ(back.index, points.index);
  }
}

TEST(EncodedBlock, RecordsThatNoPageHoldsAreRefused) {
  EXPECT_NO_THROW(refuse_large_records(PointBuffer::kMostRecord));
  try {
    refuse_large_records(5000);
    FAIL() << "5000 bytes were accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(),
                 "the attributes of a point take 5000 bytes, and 4064 are the most: choose fewer");
  }
}

TEST(EncodedBlock, TruncatedIsRefused) {
  const PointBlock points = random_points(100);
  std::vector<std::byte> bytes;
  append_points(bytes, PointsView::of(points));
  EXPECT_EQ(error_of(std::span(bytes).first(kBlockHeadSize - 1)),
            "tile 7, byte 0: the block is cut short");
  EXPECT_EQ(error_of(std::span(bytes).first(bytes.size() - 1)),
            "tile 7, byte 0: the block has another size than its head says");
}

TEST(EncodedBlock, ChecksumMismatchIsRefused) {
  const PointBlock points = random_points(100);
  std::vector<std::byte> bytes;
  append_points(bytes, PointsView::of(points));
  bytes.back() ^= std::byte{1};
  EXPECT_THAT(error_of(bytes), HasSubstr("tile 7, byte 0"));
}

TEST(EncodedBlock, TooManyPointsAreRefused) {
  std::vector<std::byte> bytes;
  append_block(bytes, 4 * (kPiece + 1), {});
  EXPECT_EQ(error_of(bytes), "tile 7, byte 0: the block has too many points");
}

}  // namespace
}  // namespace spillway::test
