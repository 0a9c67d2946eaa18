// Lines that are smooth or have few points: they meet no others, and stay near where they were.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "src/geometry/predicates.h"
#include "tests/stream/sinks/contour_grid.h"

namespace spillway::test {
namespace {

struct Segment {
  Point<2> a;
  Point<2> b;
  std::int64_t level = 0;
};

/// Contours of a grid whose points and heights are shaken.
class RoughTerrain {
 public:
  /// Heights are multiples of `step`; 0: any.
  RoughTerrain(unsigned seed, double noise, double step) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-1, 1);
    for (int y = 0; y <= kSide; ++y) {
      for (int x = 0; x <= kSide; ++x) {
        double z = 8 * std::sin(x / 7.0) * std::cos(y / 9.0) + noise * shake(random);
        if (step > 0) z = step * std::round(z / step);
        block_.vertices.push_back({x + 0.24 * shake(random), y + 0.24 * shake(random), z});
      }
    }
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto v = static_cast<std::uint32_t>(y * (kSide + 1) + x);
        for (const std::uint32_t corner :
             {v, v + 1, v + kSide + 2, v, v + kSide + 2, v + kSide + 1}) {
          block_.corners.push_back(corner);
        }
      }
    }
  }

  [[nodiscard]] std::multimap<std::int64_t, Line> lines(const Levels& levels,
                                                        const LineTolerance& tolerance) const {
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    std::multimap<std::int64_t, Line> lines;
    ContourWriter writer(
        {.levels = levels, .lattice = {}, .tolerance = tolerance, .memory = 1 << 20},
        [&](std::span<const Point<2>> points, std::int64_t level) {
          lines.emplace(level, Line(points.begin(), points.end()));
        },
        *scratch);
    writer.write(MeshStreamBlock(block_));
    writer.finish({});
    return lines;
  }

 private:
  static constexpr int kSide = 40;
  MeshStreamBlock block_;
};

std::vector<Segment> segments_of(const std::multimap<std::int64_t, Line>& lines) {
  std::vector<Segment> segments;
  for (const auto& [level, line] : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) segments.push_back({line[i - 1], line[i], level});
  }
  return segments;
}

bool is_in_box(const Segment& s, const Point<2>& p) {
  return std::minmax(s.a[0], s.b[0]).first <= p[0] && p[0] <= std::minmax(s.a[0], s.b[0]).second &&
         std::minmax(s.a[1], s.b[1]).first <= p[1] && p[1] <= std::minmax(s.a[1], s.b[1]).second;
}

enum class Meeting { kNone, kTouch, kCross };

/// How two segments meet, exactly.
Meeting meeting_of(const Segment& s, const Segment& t) {
  const int ta = orientation<2>({s.a, s.b, t.a});
  const int tb = orientation<2>({s.a, s.b, t.b});
  const int sa = orientation<2>({t.a, t.b, s.a});
  const int sb = orientation<2>({t.a, t.b, s.b});
  if (ta * tb < 0 && sa * sb < 0) return Meeting::kCross;
  const bool touch = (ta == 0 && is_in_box(s, t.a)) || (tb == 0 && is_in_box(s, t.b)) ||
                     (sa == 0 && is_in_box(t, s.a)) || (sb == 0 && is_in_box(t, s.b));
  return touch ? Meeting::kTouch : Meeting::kNone;
}

struct Meetings {
  std::size_t of_levels = 0;  ///< pairs of segments of different levels that have a common point
  std::size_t crossings = 0;  ///< pairs of the same level that cross
  std::size_t pairs = 0;      ///< that were looked at
};

/// Looks at all pairs whose boxes meet in x, in the order of x.
Meetings meetings_of(std::vector<Segment> segments) {
  const auto left = [](const Segment& s) { return std::min(s.a[0], s.b[0]); };
  std::ranges::sort(segments, {}, left);
  Meetings meetings;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    const double right = std::max(s.a[0], s.b[0]);
    for (std::size_t j = i + 1; j < segments.size() && left(segments[j]) <= right; ++j) {
      const Segment& t = segments[j];
      if (std::max(s.a[1], s.b[1]) < std::min(t.a[1], t.b[1])) continue;
      if (std::max(t.a[1], t.b[1]) < std::min(s.a[1], s.b[1])) continue;
      ++meetings.pairs;
      const Meeting meeting = meeting_of(s, t);
      if (s.level != t.level && meeting != Meeting::kNone) ++meetings.of_levels;
      if (s.level == t.level && meeting == Meeting::kCross) ++meetings.crossings;
    }
  }
  return meetings;
}

double distance(const Point<2>& p, const Segment& s) {
  const double dx = s.b[0] - s.a[0];
  const double dy = s.b[1] - s.a[1];
  const double along = ((p[0] - s.a[0]) * dx + (p[1] - s.a[1]) * dy) / (dx * dx + dy * dy);
  const double share = std::clamp(along, 0.0, 1.0);
  return std::hypot(s.a[0] + share * dx - p[0], s.a[1] + share * dy - p[1]);
}

/// The greatest distance of a point of some lines to the nearest other line of its level.
double farthest(const std::multimap<std::int64_t, Line>& lines,
                const std::multimap<std::int64_t, Line>& others) {
  double most = 0;
  for (const auto& [level, line] : lines) {
    std::multimap<std::int64_t, Line> of_level;
    const auto [begin, end] = others.equal_range(level);
    const std::vector<Segment> segments = segments_of({begin, end});
    for (const Point<2>& p : line) {
      double nearest = INFINITY;
      for (const Segment& s : segments) nearest = std::min(nearest, distance(p, s));
      most = std::max(most, nearest);
    }
  }
  return most;
}

std::size_t points_of(const std::multimap<std::int64_t, Line>& lines) {
  std::size_t count = 0;
  for (const auto& [level, line] : lines) count += line.size();
  return count;
}

/// How much lines turn, in degrees, for each unit of their length.
double turning(const std::multimap<std::int64_t, Line>& lines) {
  double sum = 0;
  double length = 0;
  for (const auto& [level, line] : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      length += std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
      if (i + 1 == line.size()) continue;
      const double turn = std::atan2(line[i + 1][1] - line[i][1], line[i + 1][0] - line[i][0]) -
                          std::atan2(line[i][1] - line[i - 1][1], line[i][0] - line[i - 1][0]);
      sum += std::abs(std::remainder(turn, 2 * M_PI));
    }
  }
  return sum * 180 / M_PI / length;
}

/// Places at which lines end: all at the hull.
std::multiset<std::pair<std::int64_t, Point<2>>> ends(
    const std::multimap<std::int64_t, Line>& lines) {
  std::multiset<std::pair<std::int64_t, Point<2>>> places;
  for (const auto& [level, line] : lines) {
    if (line.front() == line.back()) continue;
    places.emplace(level, line.front());
    places.emplace(level, line.back());
  }
  return places;
}

constexpr double kRounding = 1e-9;

const std::vector<LineTolerance> kTolerances = {{.smooth = 0.3},
                                                {.simplify = 0.2},
                                                {.smooth = 0.5, .simplify = 0.1},
                                                {.smooth = 5, .simplify = 5},
                                                {.simplify = 1e6}};

TEST(ContourShape, LinesOfDifferentLevelsNeverMeetAndOfTheSameNeverCross) {
  const std::vector<Levels> levels = {Levels::every(1, 0.125), Levels::every(0.25, 0.1),
                                      Levels::of_list({-3, -2.75, 0.3, 0.31, 2, 7})};
  for (unsigned seed = 0; seed < 4; ++seed) {
    const RoughTerrain terrain(seed, seed, 0);
    for (const Levels& some : levels) {
      for (const LineTolerance& tolerance : kTolerances) {
        const Meetings meetings = meetings_of(segments_of(terrain.lines(some, tolerance)));
        EXPECT_GT(meetings.pairs, 500U);
        EXPECT_EQ(meetings.of_levels, 0U) << seed << ", " << tolerance.simplify;
        EXPECT_EQ(meetings.crossings, 0U) << seed << ", " << tolerance.simplify;
      }
    }
  }
}

TEST(ContourShape, MeetingsAreFoundWhereLinesAreRoundedInstead) {
  auto lines = RoughTerrain(1, 1, 0).lines(Levels::every(0.25, 0.1), {});
  EXPECT_EQ(meetings_of(segments_of(lines)).of_levels, 0U);
  for (auto& [level, line] : lines) {
    for (Point<2>& p : line) p = {std::round(3 * p[0]) / 3, std::round(3 * p[1]) / 3};
    line.erase(std::unique(line.begin(), line.end()), line.end());
  }
  const Meetings meetings = meetings_of(segments_of(lines));
  EXPECT_GT(meetings.of_levels, 100U);
  EXPECT_GT(meetings.crossings, 0U);
}

TEST(ContourShape, NorDoTheyWhereManyVerticesAreExactlyOnALevel) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const RoughTerrain terrain(seed, 1.5, 0.5);
    for (const LineTolerance& tolerance : kTolerances) {
      const auto lines = terrain.lines(Levels::every(1, 0), tolerance);
      const Meetings meetings = meetings_of(segments_of(lines));
      EXPECT_EQ(meetings.of_levels, 0U) << seed;
      EXPECT_EQ(meetings.crossings, 0U) << seed;
      EXPECT_EQ(lines.size(), terrain.lines(Levels::every(1, 0), {}).size()) << seed;
    }
  }
}

TEST(ContourShape, StaysWithinItsToleranceAndKeepsEnds) {
  const Levels levels = Levels::every(1, 0.125);
  for (unsigned seed = 0; seed < 3; ++seed) {
    const RoughTerrain terrain(seed, seed, 0);
    const auto exact = terrain.lines(levels, {});
    for (const LineTolerance& tolerance : kTolerances) {
      const auto lines = terrain.lines(levels, tolerance);
      EXPECT_EQ(lines.size(), exact.size());
      EXPECT_EQ(ends(lines), ends(exact));
      EXPECT_LE(farthest(lines, exact), tolerance.sum() + kRounding);
      EXPECT_LE(farthest(exact, lines), tolerance.sum() + kRounding);
    }
  }
}

TEST(ContourShape, HasFewerPointsWhereSimpleAndBendsLessWhereSmooth) {
  const Levels levels = Levels::every(1, 0.125);
  const RoughTerrain terrain(5, 0.3, 0);
  const auto exact = terrain.lines(levels, {});
  const auto simple = terrain.lines(levels, {.simplify = 0.2});
  const auto smooth = terrain.lines(levels, {.smooth = 0.5});
  const auto both = terrain.lines(levels, {.smooth = 0.5, .simplify = 0.1});
  RecordProperty("points", static_cast<int>(points_of(exact)));
  RecordProperty("simple", static_cast<int>(points_of(simple)));
  EXPECT_LT(2 * points_of(simple), points_of(exact));
  EXPECT_EQ(points_of(smooth), points_of(exact));
  EXPECT_LT(2 * turning(smooth), turning(exact));
  EXPECT_LT(2 * points_of(both), points_of(exact));
  EXPECT_LT(turning(both), turning(simple));
}

}  // namespace
}  // namespace spillway::test
