#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "src/error.h"
#include "src/terrain/isolines.h"
#include "tests/stream/sinks/contour_grid.h"

namespace spillway::test {
namespace {

std::vector<std::pair<double, Line>> sorted(const Contours& contours) {
  std::vector<std::pair<double, Line>> lines(contours.lines.begin(), contours.lines.end());
  std::sort(lines.begin(), lines.end());
  return lines;
}

double area(const Line& line) {
  double twice = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    twice += line[i][0] * line[i + 1][1] - line[i + 1][0] * line[i][1];
  }
  return twice / 2;
}

double cone(double x, double y) { return 20 - std::hypot(x - 20, y - 20); }

TEST(Contours, OfAConeAreClosedRingsThatTurnLeftAroundTheSummit) {
  const Contours contours = contours_of_grid(40, cone, 3, 50, 1);
  std::set<double> closed;
  for (const auto& [height, line] : contours.lines) {
    if (line.front() != line.back()) continue;
    EXPECT_TRUE(closed.insert(height).second) << "two rings at " << height;
    const double radius = 20 - height;
    EXPECT_NEAR(area(line), M_PI * radius * radius, 0.1 * area(line) + 0.2) << height;
    EXPECT_EQ(line.front(), *std::min_element(line.begin(), line.end()));
  }
  EXPECT_THAT(closed, ::testing::IsSupersetOf({3.0, 6.0, 9.0, 12.0, 15.0, 18.0}));
}

TEST(Contours, DoNotDependOnTheOrderOfTrianglesOrBlocks) {
  const auto wavy = [](double x, double y) { return 7 * std::sin(x / 5) * std::cos(y / 7); };
  const auto expected = sorted(contours_of_grid(50, wavy, 0.5, 100000, 1));
  EXPECT_GT(expected.size(), 50U);
  for (const std::size_t block_size : {1U, 7U, 400U}) {
    EXPECT_EQ(sorted(contours_of_grid(50, wavy, 0.5, block_size, 2)), expected) << block_size;
  }
}

TEST(Contours, OfAnotherShapeDoNotDependOnTheOrderOfTrianglesBlocksOrMemory) {
  const auto rough = [](double x, double y) {
    return 7 * std::sin(x / 5) * std::cos(y / 7) + std::sin(97 * x + 31 * y);
  };
  for (const LineTolerance& tolerance :
       {LineTolerance{.smooth = 0.5}, LineTolerance{.simplify = 0.4},
        LineTolerance{.smooth = 0.5, .simplify = 0.1}}) {
    const auto with_memory = [&](std::uint64_t memory) {
      return ContourSinkOptions{.tolerance = tolerance, .memory = memory};
    };
    const auto expected = sorted(contours_of_grid(50, rough, 0.5, 100000, 1, with_memory(1 << 20)));
    EXPECT_GT(expected.size(), 50U);
    for (const auto& [height, line] : expected) {
      if (line.front() != line.back()) continue;
      EXPECT_EQ(line.front(), *std::min_element(line.begin(), line.end()));
    }
    for (const std::size_t block_size : {1U, 7U, 400U}) {
      const Contours contours = contours_of_grid(50, rough, 0.5, block_size, 2, with_memory(4096));
      EXPECT_GT(contours.spilled, 0U);
      EXPECT_EQ(sorted(contours), expected) << block_size;
    }
  }
}

TEST(Contours, OfATiltedPlaneRunFromHullToHullAtTheRightPlace) {
  const Contours contours = contours_of_grid(
      10, [](double x, double) { return x + 0.25; }, 1, 9, 3);
  EXPECT_EQ(contours.lines.size(), 10U);
  for (const auto& [height, line] : contours.lines) {
    EXPECT_NE(line.front(), line.back());
    for (const Point<2>& point : line) EXPECT_NEAR(point[0], height - 0.25, 1e-12);
    EXPECT_GT(line.front()[1], line.back()[1]) << "higher ground is to the left";
  }
}

TEST(Contours, ExactlyAtVerticesHaveNoGapsAndNoRepeatedPoints) {
  const Contours contours = contours_of_grid(
      20, [](double x, double y) { return std::floor((x + y) / 4); }, 1, 13, 4);
  EXPECT_FALSE(contours.lines.empty());
  for (const auto& [height, line] : contours.lines) {
    EXPECT_EQ(std::adjacent_find(line.begin(), line.end()), line.end());
    for (const Point<2>& end : {line.front(), line.back()}) {
      if (line.front() == line.back()) break;
      EXPECT_TRUE(end[0] == 0 || end[0] == 20 || end[1] == 0 || end[1] == 20)
          << "an open line ends inside, at " << end[0] << ", " << end[1];
    }
  }
}

TEST(Contours, GoThroughTheDiskWhenTheyOutgrowTheirMemory) {
  const auto in_memory = contours_of_grid(40, cone, 0.1, 100000, 5, {.memory = 1 << 24});
  const auto spilled = contours_of_grid(40, cone, 0.1, 64, 5, {.memory = 16 * 1024});
  EXPECT_GT(spilled.spilled, 0U);
  EXPECT_EQ(in_memory.spilled, 0U);
  EXPECT_EQ(spilled.lines.size(), in_memory.lines.size());
  EXPECT_TRUE(std::ranges::is_permutation(spilled.lines, in_memory.lines));
}

double length(const Line& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    sum += std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  }
  return sum;
}

TEST(Contours, ShorterThanTheLeastLengthAreLeftOutAndCounted) {
  const auto wavy = [](double x, double y) { return 7 * std::sin(x / 5) * std::cos(y / 7); };
  const Contours all = contours_of_grid(50, wavy, 0.5, 100, 1);
  const auto of_length =
      sorted(contours_of_grid(50, wavy, 0.5, 100, 1, {.min_length = 25, .memory = 1 << 20}));
  std::vector<std::pair<double, Line>> expected;
  for (const auto& line : sorted(all)) {
    if (length(line.second) >= 25) expected.push_back(line);
  }
  EXPECT_EQ(of_length, expected);
  EXPECT_LT(expected.size(), all.lines.size());
  EXPECT_TRUE(std::ranges::any_of(
      expected, [](const auto& line) { return line.second.front() == line.second.back(); }));
  EXPECT_EQ(contours_of_grid(50, wavy, 0.5, 7, 3, {.min_length = 25, .memory = 1 << 20}).shorter,
            all.lines.size() - expected.size());
}

/// The least sequence of all that a ring has, by trying every beginning.
Line least_rotation(const Line& ring) {
  Line least(ring.begin(), ring.end() - 1);
  Line turned = least;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    least = std::min(least, turned);
  }
  least.push_back(least.front());
  return least;
}

TEST(Contours, ThatMeetThemselvesAreTheSameInEveryOrder) {
  std::size_t meetings_at_the_beginning = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    // Few whole heights, zeros of both signs among them: levels pass through vertices everywhere.
    std::mt19937 random(seed);
    std::map<std::pair<double, double>, double> heights;
    const auto height = [&](double x, double y) {
      const auto [found, is_new] = heights.try_emplace({x, y});
      if (is_new) {
        found->second = static_cast<double>(random() % 4) - 2;
        if (found->second == 0 && random() % 2 == 0) found->second = -0.0;
      }
      return found->second;
    };
    const auto expected = sorted(contours_of_grid(15, height, 1, 100000, 0));
    for (const auto& [level, line] : expected) {
      if (line.front() != line.back()) continue;
      EXPECT_EQ(line, least_rotation(line));
      if (std::count(line.begin(), line.end(), line.front()) > 2) ++meetings_at_the_beginning;
    }
    for (const std::size_t block_size : {1U, 7U, 100U}) {
      const std::uint64_t memory = block_size == 7 ? 512 : 1 << 20;
      ASSERT_EQ(sorted(contours_of_grid(15, height, 1, block_size, seed + 1, {.memory = memory})),
                expected)
          << seed << ", " << block_size;
    }
  }
  EXPECT_GT(meetings_at_the_beginning, 20U);
}

TEST(Contours, OfOnlyLevelGroundAreNone) {
  EXPECT_TRUE(contours_of_grid(
                  5, [](double, double) { return 2.0; }, 1, 3, 6)
                  .lines.empty());
}

TEST(Levels, CountALevelOnlyAboveTheLowerEnd) {
  const Levels levels = Levels::every(0.1, 0);
  const Levels::Range range = levels.between(levels.height(3), levels.height(6));
  EXPECT_EQ(range.first, 4);
  EXPECT_EQ(range.end, 7);
  const Levels list = Levels::of_list({5, 1, 3, 3});
  EXPECT_EQ(list.between(1, 5).first, 1);
  EXPECT_EQ(list.between(1, 5).end, 3);
  EXPECT_EQ(list.height(2), 5);
}

TEST(Levels, RefuseAnIntervalThatHeightsCannotTellApart) {
  for (const double interval : {1e-300, 1e-22, 1e-9}) {
    const Levels levels = Levels::every(interval, 1e9);
    EXPECT_THROW(static_cast<void>(levels.between(1e9, 1e9)), Failure) << interval;
  }
}

TEST(Levels, HaveNoMinusZero) {
  EXPECT_FALSE(std::signbit(Levels::of_list({-0.0}).height(0)));
  EXPECT_FALSE(std::signbit(Levels::every(0.5, -0.0).height(0)));
}

TEST(Levels, EverySoManyFromTheBaseIsAnIndex) {
  const Levels levels = Levels::every(2, 1);
  for (const std::int64_t number : {-10, -5, 0, 5}) EXPECT_TRUE(levels.is_index(number, 5));
  for (const std::int64_t number : {-6, -4, -1, 1, 4, 6}) EXPECT_FALSE(levels.is_index(number, 5));
  EXPECT_TRUE(levels.is_index(7, 1));
  EXPECT_TRUE(levels.is_index(0, ~std::uint64_t{0}));
  EXPECT_FALSE(levels.is_index(7, ~std::uint64_t{0}));
  EXPECT_FALSE(Levels::of_list({0, 5}).is_index(0, 5));
}

TEST(Levels, RefuseWhatMakesNoSense) {
  EXPECT_THROW(Levels::every(0, 0), InvalidArgument);
  EXPECT_THROW(Levels::every(-1, 0), InvalidArgument);
  EXPECT_THROW(Levels::every(NAN, 0), InvalidArgument);
  EXPECT_THROW(Levels::of_list({}), InvalidArgument);
  EXPECT_THROW(static_cast<void>(Levels::every(1e-300, 0).between(5, 6)), Failure);
}

}  // namespace
}  // namespace spillway::test
