// Points come out of a buffer as they went in.

#include "stream/tiles/storage/point_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace spillway::detail {
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

TEST(PointBuffer, GivesBackPointsAndIndicesInTheirOrder) {
  for (const bool in_chunks : {false, true}) {
    PointBuffer buffer;
    std::size_t begin = 0;
    for (const std::size_t count : std::array<std::size_t, 5>{1, 0, kPiece, 3 * kPiece, 7}) {
      std::vector<std::uint64_t> index(count);
      for (std::size_t i = 0; i < count; ++i) index[i] = 2 * (begin + i);
      buffer.append(points_from(begin, count), index);
      begin += count;
    }
    EXPECT_EQ(buffer.size(), begin);
    std::size_t next = 0;
    const auto take = [&](std::span<const LatticePoint> points,
                          std::span<const std::uint64_t> index) {
      ASSERT_EQ(points.size(), index.size());
      EXPECT_LE(points.size(), in_chunks ? kPiece : PointBuffer::kPagePoints);
      for (std::size_t i = 0; i < points.size(); ++i, ++next) {
        ASSERT_EQ(points[i][0], static_cast<double>(next));
        ASSERT_EQ(index[i], 2 * next);
      }
    };
    if (in_chunks) {
      buffer.drain_in_chunks(take);
    } else {
      buffer.drain(take);
    }
    EXPECT_EQ(next, begin);
  }
}

TEST(PointBuffer, HasMemoryForLessThanAPageMore) {
  constexpr std::size_t kPageOfPoints = PagePool::kPageBytes / sizeof(LatticePoint);
  PointBuffer buffer;
  EXPECT_EQ(buffer.room(), 0U);
  std::size_t points = 0;
  for (const std::size_t count : std::array<std::size_t, 4>{1, 200, kPiece, 5 * kPiece}) {
    buffer.append(points_from(points, count), {});
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
    buffer.append(
        points, indexed ? std::vector<std::uint64_t>(points.size()) : std::vector<std::uint64_t>());
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
  buffer.append(points_from(0, 2 * kPiece + 3), {});
  std::vector<std::size_t> counts;
  buffer.drain_in_chunks([&](std::span<const LatticePoint> points, std::span<const std::uint64_t>) {
    counts.push_back(points.size());
  });
  EXPECT_EQ(counts, (std::vector<std::size_t>{kPiece, kPiece, 3}));
}

TEST(PointBuffer, IsEmptyAfterItIsDrainedAndCanBeUsedAgain) {
  PointBuffer buffer;
  buffer.append(points_from(0, kPiece + 1), {});
  std::size_t taken = 0;
  const auto take = [&](std::span<const LatticePoint> points,
                        std::span<const std::uint64_t> index) {
    taken += points.size();
    EXPECT_TRUE(index.empty());
  };
  buffer.drain(take);
  EXPECT_EQ(taken, kPiece + 1);
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(buffer.room(), 0U);
  buffer.drain(take);
  buffer.append(points_from(0, 2), {});
  buffer.drain(take);
  EXPECT_EQ(taken, kPiece + 3);
}

}  // namespace
}  // namespace spillway::detail
