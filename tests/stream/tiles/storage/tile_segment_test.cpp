// Where spilled points lie, also where stretches of a file become one before they are written.

#include "stream/tiles/storage/tile_segment.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/stream/tiles/scratch_bytes.h"

namespace spillway::test {
namespace {

/// Stretches of one file, to be written one after the other.
struct Stretches {
  std::shared_ptr<ScratchBytes> file = std::make_shared<ScratchBytes>();
  std::mutex mutex;
  std::vector<std::shared_ptr<FileStretch>> all;

  explicit Stretches(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) all.push_back(std::make_shared<FileStretch>(file));
  }
  void write(std::size_t number, std::size_t bytes) {
    all[number]->append(std::vector<std::byte>(bytes), mutex);
  }
};

TEST(FileStretch, KnowsWhereItsBytesLie) {
  Stretches stretches(2);
  stretches.file->append(std::vector<std::byte>(5));
  stretches.write(0, 10);
  stretches.write(1, 20);
  EXPECT_EQ(stretches.all[0]->offset(), 5U);
  EXPECT_EQ(stretches.all[0]->size(), 10U);
  EXPECT_EQ(stretches.all[1]->offset(), 15U);
  EXPECT_EQ(stretches.all[1]->size(), 20U);
}

TEST(FileStretch, JoinedBeforeOrAfterTheWriteHasAllBytes) {
  for (int written = 0; written <= 3; ++written) {  // when the joins are made
    for (const bool last_first : {false, true}) {
      SCOPED_TRACE(::testing::Message() << written << " written, last first " << last_first);
      Stretches stretches(3);
      stretches.file->append(std::vector<std::byte>(7));
      for (int i = 0; i < written; ++i) stretches.write(i, 10 + i);
      if (last_first) {
        stretches.all[2]->join(stretches.all[1]);
        stretches.all[1]->join(stretches.all[0]);
      } else {
        stretches.all[1]->join(stretches.all[0]);
        stretches.all[2]->join(stretches.all[0]);
      }
      for (int i = written; i < 3; ++i) stretches.write(i, 10 + i);
      EXPECT_EQ(stretches.all[0]->offset(), 7U);
      EXPECT_EQ(stretches.all[0]->size(), 33U);
    }
  }
}

/// The `spill`-th segment of a file, with points between `lo` and `hi` on x.
TileSegment segment_of(const std::shared_ptr<ScratchFile>& file, std::uint32_t spill, double lo,
                       double hi, std::uint64_t points = 100) {
  return {.stretch = std::make_shared<FileStretch>(file),
          .first_spill = spill,
          .end_spill = spill + 1,
          .points = points,
          .arrival = spill,
          .box = {{lo, 0, 0}, {hi, 1, 0}}};
}

TEST(JoinSegments, LeavesThemIfThereAreFew) {
  const auto file = std::make_shared<ScratchBytes>();
  std::vector<TileSegment> segments = {segment_of(file, 0, 0, 1), segment_of(file, 1, 0, 1)};
  join_segments(segments, 2, 2);
  EXPECT_EQ(segments.size(), 2U);
}

TEST(JoinSegments, NeverJoinsWhatDoesNotLieSideBySide) {
  const auto file = std::make_shared<ScratchBytes>();
  const auto other = std::make_shared<ScratchBytes>();
  std::vector<TileSegment> segments = {segment_of(file, 0, 0, 1), segment_of(file, 2, 0, 1),
                                       segment_of(other, 3, 0, 1)};
  join_segments(segments, 1, 2);
  EXPECT_EQ(segments.size(), 3U);
}

TEST(JoinSegments, PrefersTheClose) {
  const auto file = std::make_shared<ScratchBytes>();
  std::vector<TileSegment> segments = {segment_of(file, 0, 0, 1), segment_of(file, 1, 8, 9),
                                       segment_of(file, 2, 9, 10), segment_of(file, 3, 3, 4)};
  join_segments(segments, 3, 2);
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[1].first_spill, 1U);
  EXPECT_EQ(segments[1].end_spill, 3U);
  EXPECT_EQ(segments[1].points, 200U);
  EXPECT_EQ(segments[1].arrival, 1U);
  EXPECT_EQ(segments[1].box, (Box<3>{{8, 0, 0}, {10, 1, 0}}));
}

TEST(JoinSegments, PrefersTheSmall) {
  const auto file = std::make_shared<ScratchBytes>();
  std::vector<TileSegment> segments = {
      segment_of(file, 0, 0, 1, 500), segment_of(file, 1, 0, 1, 500), segment_of(file, 2, 0, 1, 20),
      segment_of(file, 3, 0, 1, 30)};
  join_segments(segments, 3, 2);
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[2].points, 50U);
}

TEST(JoinAllSegments, LeavesThoseThatAreApart) {
  const auto file = std::make_shared<ScratchBytes>();
  const auto other = std::make_shared<ScratchBytes>();
  std::vector<TileSegment> segments = {segment_of(file, 0, 0, 1), segment_of(file, 1, 3, 4),
                                       segment_of(file, 2, 8, 9), segment_of(file, 3, 8, 9),
                                       segment_of(file, 5, 8, 9), segment_of(other, 6, 8, 9)};
  join_all_segments(segments, [](std::uint64_t before, std::uint64_t after) {
    return before < 2 && after >= 2;  // something waits that came between
  });
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_EQ(segments[0].end_spill, 2U);
  EXPECT_EQ(segments[0].points, 200U);
  EXPECT_EQ(segments[0].box, (Box<3>{{0, 0, 0}, {4, 1, 0}}));
  EXPECT_EQ(segments[1].first_spill, 2U);
  EXPECT_EQ(segments[1].end_spill, 4U);
  EXPECT_EQ(segments[2].first_spill, 5U);
  EXPECT_EQ(&segments[3].stretch->file(), other.get());
}

TEST(JoinSegments, KeepsPointsBoxesAndBytesOfRandomOnes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 20; ++round) {
    const auto file = std::make_shared<ScratchBytes>();
    std::mutex mutex;
    std::vector<TileSegment> segments;
    std::vector<std::shared_ptr<FileStretch>> stretches;
    std::vector<TileSegment> expected;
    for (std::uint32_t spill = 0; spill < 60; ++spill) {
      const double lo = unit(random);
      segments.push_back(segment_of(file, spill, lo, lo + unit(random), 1 + random() % 99));
      stretches.push_back(segments.back().stretch);
      expected.push_back(segments.back());
      // Each point takes a byte. The last ones are on their way.
      if (spill >= 5)
        stretches[spill - 5]->append(std::vector<std::byte>(expected[spill - 5].points), mutex);
      join_segments(segments, 6, 2);
      EXPECT_LE(segments.size(), 6U);
    }
    for (std::size_t i = 55; i < 60; ++i) {
      stretches[i]->append(std::vector<std::byte>(expected[i].points), mutex);
    }
    std::uint32_t next = 0;
    std::uint64_t offset = 0;
    for (const TileSegment& segment : segments) {
      EXPECT_EQ(segment.first_spill, next);
      EXPECT_EQ(segment.arrival, next);
      Box<3> box;
      std::uint64_t points = 0;
      for (; next < segment.end_spill; ++next) {
        box.expand(expected[next].box);
        points += expected[next].points;
      }
      EXPECT_EQ(segment.box, box);
      EXPECT_EQ(segment.points, points);
      EXPECT_EQ(segment.stretch->offset(), offset);
      EXPECT_EQ(segment.stretch->size(), points);
      offset += points;
    }
    EXPECT_EQ(next, 60U);
  }
}

}  // namespace
}  // namespace spillway::test
