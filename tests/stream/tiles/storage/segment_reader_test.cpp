// Segments come back from their files block by block; corrupt ones are refused.

#include "stream/tiles/storage/segment_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/stream/tiles/scratch_bytes.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Random points, as blocks; they are appended to `all`.
std::vector<std::byte> random_blocks(std::size_t count, unsigned seed, PointBlock& all) {
  std::mt19937_64 random(seed);
  PointBlock block;
  for (std::size_t i = 0; i < count; ++i) {
    block.points.push_back({std::ldexp(static_cast<double>(random()), -64), 0, 0});
    block.index.push_back(i);
  }
  std::vector<std::byte> bytes;
  append_all_points(bytes, PointsView::of(block));
  all.points.insert(all.points.end(), block.points.begin(), block.points.end());
  all.index.insert(all.index.end(), block.index.begin(), block.index.end());
  return bytes;
}

std::string error_of(const std::vector<TileSegment>& segments) {
  SegmentReader reader(segments);
  StoredBlocks blocks;
  PointBlock points;
  try {
    while (reader.fetch(blocks)) decode_all_points(blocks.bytes, blocks.where, points);
  } catch (const Failure& error) {
    return error.what();
  }
  return "no error";
}

TEST(SegmentReader, OfNoSegmentsIsAtItsEnd) {
  SegmentReader reader{std::vector<TileSegment>()};
  StoredBlocks blocks;
  EXPECT_FALSE(reader.fetch(blocks));
  EXPECT_EQ(reader.points(), 0U);
}

TEST(SegmentReader, GivesAllBlocksOfAllSegmentsInTheirOrder) {
  const auto file = std::make_shared<ScratchBytes>();
  const auto other = std::make_shared<ScratchBytes>();
  PointBlock expected;
  std::vector<TileSegment> segments;
  file->append(std::vector<std::byte>(100));  // of no segment
  segments.push_back(written_segment(file, 0, random_blocks(50'000, 1, expected)));
  segments.push_back(written_segment(file, 1, random_blocks(1, 2, expected)));
  segments.push_back(written_segment(other, 0, random_blocks(5'000, 3, expected)));
  segments[0].arrival = 1000;
  segments[1].arrival = 70'000;
  segments[2].arrival = 0;
  SegmentReader reader(segments, 7);
  StoredBlocks blocks;
  PointBlock found;
  PointBlock some;
  std::vector<std::uint64_t> firsts;  // of each run
  std::uint64_t last_run = 0;
  while (reader.fetch(blocks)) {
    decode_all_points(blocks.bytes, blocks.where, some);
    if (blocks.run == 8) {
      EXPECT_EQ(blocks.arrival, 1000 + found.size());
    }
    if (std::exchange(last_run, blocks.run) != blocks.run) firsts.push_back(blocks.arrival);
    EXPECT_GT(some.size(), 0U);
    found.points.insert(found.points.end(), some.points.begin(), some.points.end());
    found.index.insert(found.index.end(), some.index.begin(), some.index.end());
    EXPECT_EQ(reader.points(), found.size());
  }
  EXPECT_THAT(firsts, ElementsAre(1000, 70'000, 0));
  EXPECT_EQ(reader.last_run(), 10U);
  EXPECT_TRUE(found.points == expected.points);
  EXPECT_TRUE(found.index == expected.index);
}

TEST(SegmentReader, GoesOnWithARunWhereASegmentFollows) {
  const auto file = std::make_shared<ScratchBytes>();
  PointBlock all;
  std::vector<TileSegment> segments;
  for (std::uint32_t i = 0; i < 4; ++i) {
    segments.push_back(written_segment(file, i, random_blocks(10, i, all)));
    segments.back().follows = i == 1 || i == 3;
  }
  SegmentReader reader(segments);
  StoredBlocks blocks;
  std::vector<std::uint64_t> runs;
  while (reader.fetch(blocks)) runs.push_back(blocks.run);
  EXPECT_THAT(runs, ElementsAre(1, 1, 2, 2));
}

TEST(SegmentReader, LetsGoOfASegmentOnceItIsRead) {
  auto file = std::make_shared<ScratchBytes>();
  const auto other = std::make_shared<ScratchBytes>();
  PointBlock all;
  std::vector<TileSegment> segments = {written_segment(file, 0, random_blocks(9, 1, all)),
                                       written_segment(other, 0, random_blocks(9, 2, all))};
  const std::weak_ptr<ScratchBytes> watched = file;
  file = nullptr;
  SegmentReader reader(std::move(segments));
  StoredBlocks blocks;
  EXPECT_TRUE(reader.fetch(blocks));
  EXPECT_TRUE(reader.fetch(blocks));
  EXPECT_TRUE(watched.expired());
}

TEST(SegmentReader, TruncatedIsRefusedByFileAndByte) {
  PointBlock all;
  const std::vector<std::byte> bytes = random_blocks(100, 1, all);
  const auto file = std::make_shared<ScratchBytes>("tile 7");
  file->append(std::vector<std::byte>(40));
  const TileSegment segment = written_segment(file, 0, std::span(bytes).first(bytes.size() - 1));
  EXPECT_EQ(error_of({segment}), "tile 7, byte 40: the block is cut short");
}

TEST(SegmentReader, ChecksumMismatchIsRefusedByFileAndByte) {
  PointBlock all;
  const std::vector<std::byte> bytes = random_blocks(100, 1, all);
  const auto file = std::make_shared<ScratchBytes>("tile 7");
  file->append(std::vector<std::byte>(40));
  const TileSegment segment = written_segment(file, 0, bytes);
  file->bytes.back() ^= std::byte{1};
  EXPECT_THAT(error_of({segment}), StartsWith("tile 7, byte 40: "));
}

TEST(SegmentReader, ShorterFileThanItsSegmentIsRefused) {
  PointBlock all;
  const auto file = std::make_shared<ScratchBytes>("tile 7");
  const TileSegment segment = written_segment(file, 0, random_blocks(100, 1, all));
  file->bytes.pop_back();
  EXPECT_THAT(error_of({segment}), HasSubstr("tile 7"));
}

}  // namespace
}  // namespace spillway::test
