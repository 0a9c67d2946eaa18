// Points come out of a buffer as they went in.

#include "stream/points/point_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace spillway::test {
namespace {

constexpr std::size_t kPiece = PointBuffer::kChunk;

/// Points (i, 0, -i) from `begin` on.
std::vector<LatticePoint> points_from(std::size_t begin, std::size_t count) {
  std::vector<LatticePoint> points;
  for (std::size_t i = begin; i < begin + count; ++i) {
    points.push_back({static_cast<double>(i), 0, -static_cast<double>(i)});
  }
  return points;
}

/// What point number `i` carries.
std::byte byte_of(std::size_t i, std::size_t b) { return static_cast<std::byte>(i * 7 + b); }

/// With records of so many bytes, point i has the index 2 i.
void expect_all_come_back(bool indexed, std::size_t record_size, bool in_chunks) {
  PointBuffer buffer;
  std::size_t begin = 0;
  for (const std::size_t count : std::array<std::size_t, 5>{1, 0, kPiece, 3 * kPiece, 7}) {
    PointBlock block;
    block.points = points_from(begin, count);
    for (std::size_t i = begin; i < begin + count; ++i) {
      if (indexed) block.index.push_back(2 * i);
      for (std::size_t b = 0; b < record_size; ++b) block.attributes.push_back(byte_of(i, b));
    }
    buffer.append(PointsView::of(block));
    begin += count;
  }
  EXPECT_EQ(buffer.size(), begin);
  std::size_t next = 0;
  const auto take = [&](const PointsView& some) {
    ASSERT_EQ(some.index.size(), indexed ? some.size() : 0);
    ASSERT_EQ(some.attributes.size(), some.size() * record_size);
    EXPECT_LE(some.size(), in_chunks ? kPiece : PointBuffer::kPagePoints);
    for (std::size_t i = 0; i < some.size(); ++i, ++next) {
      ASSERT_EQ(some.points[i][0], static_cast<double>(next));
      if (indexed) {
        ASSERT_EQ(some.index[i], 2 * next);
      }
      for (std::size_t b = 0; b < record_size; ++b) {
        ASSERT_EQ(some.attributes[i * record_size + b], byte_of(next, b));
      }
    }
  };
  if (in_chunks) {
    buffer.drain_in_chunks([&](const PointBlock& chunk) { take(PointsView::of(chunk)); });
  } else {
    buffer.drain(take);
  }
  EXPECT_EQ(next, begin);
}

TEST(PointBuffer, GivesBackPointsIndicesAndAttributesInTheirOrder) {
  for (const bool in_chunks : {false, true}) {
    for (const bool indexed : {false, true}) {
      for (const std::size_t record_size : {0, 1, 5, 40}) {
        expect_all_come_back(indexed, record_size, in_chunks);
      }
    }
  }
  expect_all_come_back(true, PointBuffer::kMostRecord, true);
}

TEST(PointBuffer, HasMemoryForLessThanAPageMore) {
  constexpr std::size_t kPageOfPoints = PagePool::kPageBytes / sizeof(LatticePoint);
  PointBuffer buffer;
  EXPECT_EQ(buffer.room(), 0U);
  std::size_t points = 0;
  for (const std::size_t count : std::array<std::size_t, 4>{1, 200, kPiece, 5 * kPiece}) {
    buffer.append({points_from(points, count)});
    points += count;
    EXPECT_EQ(buffer.size(), points);
    EXPECT_GE(buffer.room(), points);
    EXPECT_LT(buffer.room(), points + kPageOfPoints);
  }
}

TEST(PointBuffer, ShowsAllItsPointsInTheirOrder) {
  for (const bool indexed : {false, true}) {
    const std::vector<LatticePoint> points = points_from(0, kPiece + 9);
    PointBuffer buffer;
    const std::vector<std::uint64_t> index(indexed ? points.size() : 0);
    buffer.append({points, index});
    std::vector<LatticePoint> seen;
    buffer.visit([&](std::span<const LatticePoint> some) {
      seen.insert(seen.end(), some.begin(), some.end());
    });
    EXPECT_EQ(seen, points);
    EXPECT_EQ(buffer.size(), points.size());
  }
}

TEST(PointBuffer, GivesAsManyAtATimeAsAChunkHas) {
  PointBuffer buffer;
  buffer.append({points_from(0, 2 * kPiece + 3)});
  std::vector<std::size_t> counts;
  buffer.drain_in_chunks([&](const PointBlock& chunk) { counts.push_back(chunk.size()); });
  EXPECT_EQ(counts, (std::vector<std::size_t>{kPiece, kPiece, 3}));
}

TEST(PointBuffer, IsEmptyAfterItIsDrainedAndCanBeUsedAgain) {
  PointBuffer buffer;
  buffer.append({points_from(0, kPiece + 1)});
  std::size_t taken = 0;
  const auto take = [&](const PointsView& points) {
    taken += points.size();
    EXPECT_TRUE(points.index.empty());
  };
  buffer.drain(take);
  EXPECT_EQ(taken, kPiece + 1);
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(buffer.room(), 0U);
  buffer.drain(take);
  buffer.append({points_from(0, 2)});
  buffer.drain(take);
  EXPECT_EQ(taken, kPiece + 3);
}

}  // namespace
}  // namespace spillway::test
