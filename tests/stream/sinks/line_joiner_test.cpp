#include "stream/sinks/line_joiner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Line = std::vector<Point<2>>;
using Lines = std::multiset<std::pair<std::int64_t, Line>>;

constexpr std::uint64_t kMuch = 1 << 20;  ///< bytes

/// A joiner, and the lines that it has given out.
struct Joined {
  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  Lines lines;
  LineJoiner joiner;

  explicit Joined(std::uint64_t memory = kMuch)
      : joiner(
            [this](std::span<const Point<2>> points, std::int64_t level) {
              lines.emplace(level, Line(points.begin(), points.end()));
            },
            memory, *scratch) {}

  Joined& add(const std::vector<IsoSegment>& segments) {
    for (const IsoSegment& segment : segments) joiner.add(segment);
    return *this;
  }
  Lines& finish() {
    joiner.finish();
    EXPECT_EQ(joiner.lines(), lines.size());
    return lines;
  }
};

/// Where a line crosses the edge of that number.
Crossing crossing(std::uint64_t number, std::int64_t level = 0) {
  return {{number, 1'000'000}, level};
}

/// The segments of a line that crosses edges of numbers from `first` on. A ring comes back to the
/// first one.
std::vector<IsoSegment> segments_of(const Line& line, std::uint64_t first, bool is_ring = false,
                                    std::int64_t level = 0) {
  std::vector<IsoSegment> segments;
  for (std::size_t i = 0; i + (is_ring ? 0 : 1) < line.size(); ++i) {
    const std::size_t next = (i + 1) % line.size();
    segments.push_back({crossing(first + i, level),
                        crossing(first + next, level),
                        {.at = line[i]},
                        {.at = line[next]}});
  }
  return segments;
}

/// Of all beginnings of a ring the one whose points come first; with the first point once more.
Line least_rotation(Line ring) {
  Line least = ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    least = std::min(least, ring);
  }
  least.push_back(least.front());
  return least;
}

Line random_line(std::size_t count, std::mt19937_64& random) {
  Line line(count);
  for (Point<2>& p : line) p = {static_cast<double>(random() % 9000), 0.5};
  for (std::size_t i = 1; i < count; ++i) line[i][1] = line[i - 1][1] + 1;  // no two are equal
  return line;
}

/// Some long and short lines and rings of two levels in one, in stretches of so many segments.
struct Drawing {
  std::vector<IsoSegment> segments;
  Lines lines;

  explicit Drawing(std::uint64_t seed, std::size_t stretch = 1) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<IsoSegment>> stretches;
    for (const std::int64_t level : {-3, 7}) {
      std::uint64_t first = 0;  // the same edges are crossed at both levels
      for (const std::size_t count : {2, 3, 40, 200}) {
        for (const bool is_ring : {false, true}) {
          const Line line = random_line(count, random);
          const std::vector<IsoSegment> all = segments_of(line, first, is_ring, level);
          for (std::size_t begin = 0; begin < all.size(); begin += stretch) {
            const auto some = std::span(all).subspan(begin, std::min(stretch, all.size() - begin));
            stretches.emplace_back(some.begin(), some.end());
          }
          lines.emplace(level, is_ring ? least_rotation(line) : line);
          first += count;
        }
      }
    }
    std::ranges::shuffle(stretches, random);
    for (const auto& some : stretches) segments.insert(segments.end(), some.begin(), some.end());
  }
};

TEST(LineJoiner, JoinsSegmentsInAnyOrderToWholeLines) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Drawing drawing(seed);
    EXPECT_EQ(Joined().add(drawing.segments).finish(), drawing.lines) << seed;
  }
}

TEST(LineJoiner, LinesOnTheDiskAreWholeAndInOrder) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const std::uint64_t memory : {0, 300, 2000}) {
      const Drawing drawing(seed, 30);
      Joined joined(memory);
      joined.add(drawing.segments);
      EXPECT_GT(joined.joiner.spilled_bytes(), 0U);
      EXPECT_EQ(joined.finish(), drawing.lines) << seed << ", " << memory;
    }
  }
}

TEST(LineJoiner, PartsOfOthersJoinLikeSegments) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Drawing drawing(seed);
    std::mt19937_64 random(seed);
    for (const std::uint64_t memory : {std::uint64_t{0}, kMuch}) {
      std::deque<Joined> joined;
      for (int j = 0; j < 3; ++j) joined.emplace_back(memory);
      for (const IsoSegment& segment : drawing.segments) {
        joined[random() % joined.size()].joiner.add(segment);
      }
      Lines lines;
      for (int j = 0; j < 2; ++j) {
        joined[j].joiner.hand_over([&](const LineJoiner::OpenLine& part) {
          joined[j + 1].joiner.add(LineJoiner::OpenLine(part));
        });
        lines.merge(joined[j].finish());  // that closed here
      }
      lines.merge(joined[2].finish());
      EXPECT_EQ(lines, drawing.lines) << seed;
    }
  }
}

TEST(LineJoiner, APointThatIsRepeatedIsGivenOnceAndOneAloneNotAtAll) {
  Joined joined;
  joined.add(segments_of({{0, 0}, {1, 1}, {1, 1}, {1, 1}, {2, 0}}, 0));
  joined.add(segments_of({{5, 5}, {5, 5}, {5, 5}}, 10));
  joined.add(segments_of({{7, 7}, {7, 7}}, 20, true));
  EXPECT_THAT(joined.finish(), ElementsAre(std::pair(0, Line{{0, 0}, {1, 1}, {2, 0}})));
}

TEST(LineJoiner, ReleasesALineOnceBothEndsAreFinal) {
  Joined joined;
  const Line line{{0, 0}, {1, 0}, {2, 0}, {3, 0}};
  joined.add(segments_of(line, 0)).add(segments_of(line, 100)).add(segments_of(line, 200));
  std::set<std::uint64_t> final_edges{0, 3, 100, 203};
  const auto is_final = [&](const Crossing& end) { return final_edges.contains(end.edge[0]); };
  joined.joiner.release(is_final);
  EXPECT_THAT(joined.lines, ElementsAre(std::pair(0, line)));
  joined.add({{crossing(103), crossing(104), {3, 0}, {4, 0}}});  // the second one goes on
  joined.add({{crossing(199), crossing(200), {-1, 0}, {0, 0}}});
  final_edges = {100, 104, 203};
  joined.joiner.release(is_final);
  EXPECT_EQ(joined.lines.size(), 2U);
  EXPECT_THAT(
      joined.finish(),
      ElementsAre(std::pair(0, Line{{-1, 0}, {0, 0}, {1, 0}, {2, 0}, {3, 0}}), std::pair(0, line),
                  std::pair(0, Line{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}})));
}

TEST(LineJoiner, ARingIsGivenAtOnce) {
  Joined joined;
  joined.add(segments_of({{2, 0}, {0, 1}, {1, 2}}, 0, true));
  EXPECT_THAT(joined.lines, ElementsAre(std::pair(0, Line{{0, 1}, {1, 2}, {2, 0}, {0, 1}})));
  joined.lines.clear();
  joined.joiner.finish();
  EXPECT_THAT(joined.lines, IsEmpty());
}

TEST(LineJoiner, FitsToOthersOnceItsVerticesAreRenamed) {
  Joined joined;
  const Line line{{0, 0}, {1, 0}, {2, 0}};
  joined.add(segments_of(line, 5));
  joined.joiner.number_from(50);
  const auto renamed = [](std::uint64_t number) {
    Crossing place = crossing(number);
    for (std::uint64_t& vertex : place.edge) vertex += 50;
    return place;
  };
  joined.add({{renamed(7), renamed(8), {2, 0}, {3, 0}}});
  joined.add({{renamed(4), renamed(5), {-1, 0}, {0, 0}}});
  EXPECT_THAT(joined.finish(),
              ElementsAre(std::pair(0, Line{{-1, 0}, {0, 0}, {1, 0}, {2, 0}, {3, 0}})));
}

TEST(LineJoiner, AFigureEightThroughItsLeastPointBeginsAlikeInEveryOrder) {
  // Two loops from (0, 0); also one in which both loops are alike for some points.
  for (const Line& ring : {Line{{0, 0}, {2, 1}, {2, 2}, {0, 0}, {2, -2}, {2, -1}},
                           Line{{0, 0}, {1, 0}, {2, 5}, {0, 0}, {1, 0}, {2, 4}},
                           Line{{0, 0}, {1, 0}, {0, 0}, {1, 0}}, Line{{0, 0}, {1, 0}}}) {
    std::vector<IsoSegment> segments = segments_of(ring, 0, true);
    std::mt19937 random(4);
    for (int turn = 0; turn < 50; ++turn) {
      std::shuffle(segments.begin(), segments.end(), random);
      EXPECT_THAT(Joined().add(segments).finish(), ElementsAre(std::pair(0, least_rotation(ring))));
    }
  }
}

TEST(LineJoiner, RefusesTrianglesThatDoNotFitTogether) {
  Joined joined;
  const IsoSegment segment{crossing(1), crossing(2), {}, {}};
  joined.joiner.add(segment);
  EXPECT_THROW(joined.joiner.add(segment), Failure);
  const LineJoiner::OpenLine part{crossing(1), crossing(3), {{0, 0}, {2, 2}}};
  EXPECT_THROW(joined.joiner.add(LineJoiner::OpenLine(part)), Failure);
}

}  // namespace
}  // namespace spillway::test
