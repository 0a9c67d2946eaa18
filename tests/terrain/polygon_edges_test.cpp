// What lies in polygons, and lines that are cut at their edges.

#include "src/terrain/polygon_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "tests/terrain/line_length.h"

namespace spillway::test {
namespace {

using Line = std::vector<Point<2>>;

std::vector<Line> cut(const PolygonEdges& polygon, const Line& line) {
  std::vector<Line> pieces;
  polygon.cut(line, [&](std::span<const Point<2>> points) {
    pieces.emplace_back(points.begin(), points.end());
  });
  return pieces;
}

constexpr int kCells = 6;

/// Quadrangles that share their edges and cover the square from 0, 0 to 6, 6. Corners inside are
/// moved, where `moves`, by quarters, so that some edges stay level or upright. Every other one runs
/// clockwise.
std::vector<PolygonEdges> covering(std::mt19937& random, bool moves) {
  std::map<std::pair<int, int>, Point<2>> corners;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      Point<2> corner = {static_cast<double>(i), static_cast<double>(j)};
      const bool is_inside = i > 0 && i < kCells && j > 0 && j < kCells;
      for (double& c : corner) {
        if (moves && is_inside) c += (static_cast<double>(random() % 3) - 1) / 4;
      }
      corners[{i, j}] = corner;
    }
  }
  std::vector<PolygonEdges> polygons;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      Line ring = {corners[{i, j}], corners[{i + 1, j}], corners[{i + 1, j + 1}],
                   corners[{i, j + 1}]};
      if ((i + j) % 2 == 0) std::ranges::reverse(ring);
      polygons.emplace_back(std::vector<Line>{ring});
    }
  }
  return polygons;
}

/// Inside the square; where `coarse`, on corners and along edges mostly.
Line random_line(std::mt19937& random, bool coarse) {
  Line line(2 + random() % 12);
  for (Point<2>& p : line) {
    for (double& c : p) {
      c = coarse ? static_cast<double>(1 + random() % 20) / 4
                 : static_cast<double>(1 + random() % 5999) / 1000;
    }
  }
  if (random() % 2 == 0) line.push_back(line.front());
  return line;
}

TEST(PolygonEdges, EveryPlaceIsInOneOfThoseThatShareEdges) {
  std::mt19937 random(1);
  for (int run = 0; run < 50; ++run) {
    const std::vector<PolygonEdges> polygons = covering(random, run % 2 == 0);
    for (const Point<2>& place : random_line(random, run % 3 == 0)) {
      const auto holds = [&](const PolygonEdges& polygon) { return polygon.contains(place); };
      EXPECT_EQ(std::ranges::count_if(polygons, holds), 1) << place[0] << " " << place[1];
    }
  }
}

TEST(PolygonEdges, HolesAreNotPartOfThem) {
  const PolygonEdges polygon(
      std::vector<Line>{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}});
  EXPECT_TRUE(polygon.contains({1, 5}));
  EXPECT_FALSE(polygon.contains({5, 5}));
  EXPECT_TRUE(polygon.contains({0, 0}));
  EXPECT_FALSE(polygon.contains({10, 5}));
  EXPECT_EQ(cut(polygon, {{-1, 5}, {12, 5}}),
            (std::vector<Line>{{{0, 5}, {4, 5}}, {{6, 5}, {10, 5}}}));
}

TEST(PolygonEdges, PiecesOfThoseThatShareEdgesAreTheWholeLineAndMeet) {
  std::mt19937 random(2);
  for (int run = 0; run < 2000; ++run) {
    const std::vector<PolygonEdges> polygons = covering(random, run % 2 == 0);
    const Line line = random_line(random, run % 3 == 0);
    double length = 0;
    std::map<Point<2>, int> ends;  // how many more pieces begin there than end
    for (const PolygonEdges& polygon : polygons) {
      for (const Line& piece : cut(polygon, line)) {
        ASSERT_GE(piece.size(), 2U);
        length += length_of(piece);
        ++ends[piece.front()];
        --ends[piece.back()];
      }
    }
    ASSERT_NEAR(length, length_of(line), 1e-12 * (1 + length)) << "run " << run;
    if (length == 0) continue;
    ++ends[line.back()];
    --ends[line.front()];
    for (const auto& [place, balance] : ends) {
      ASSERT_EQ(balance, 0) << "run " << run << ", at " << place[0] << " " << place[1];
    }
  }
}

TEST(PolygonEdges, CutTheLineTurnedRoundInTheSamePlaces) {
  std::mt19937 random(3);
  for (int run = 0; run < 500; ++run) {
    const std::vector<PolygonEdges> polygons = covering(random, true);
    Line line = random_line(random, run % 3 == 0);
    Line turned(line.rbegin(), line.rend());
    for (const PolygonEdges& polygon : polygons) {
      std::vector<Line> pieces = cut(polygon, turned);
      for (Line& piece : pieces) std::ranges::reverse(piece);
      std::vector<Line> expected = cut(polygon, line);
      std::ranges::sort(pieces);
      std::ranges::sort(expected);
      ASSERT_EQ(pieces, expected) << "run " << run;
    }
  }
}

TEST(PolygonEdges, PiecesOfAClosedLineThatMeetAtItsEndsAreOne) {
  const PolygonEdges polygon(std::vector<Line>{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}});
  const Line ring = {{5, 5}, {12, 5}, {12, 8}, {5, 8}, {5, 5}};
  EXPECT_EQ(cut(polygon, ring), (std::vector<Line>{{{10, 8}, {5, 8}, {5, 5}, {10, 5}}}));
  const Line inside = {{1, 1}, {2, 1}, {2, 2}, {1, 1}};
  EXPECT_EQ(cut(polygon, inside), std::vector<Line>{inside});
  EXPECT_TRUE(cut(polygon, {{20, 20}, {30, 30}}).empty());
  EXPECT_TRUE(cut(polygon, {}).empty());
}

TEST(PolygonEdges, OfManyEdgesAreThoseOfACircle) {
  Line ring;
  for (int i = 0; i < 10000; ++i) {
    const double angle = 2 * M_PI * i / 10000;
    ring.push_back({std::cos(angle), std::sin(angle)});
  }
  const PolygonEdges circle(std::vector<Line>{ring});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  for (int run = 0; run < 2000; ++run) {
    const Point<2> place = {coordinate(random), coordinate(random)};
    const double radius = std::hypot(place[0], place[1]);
    if (std::abs(radius - 1) < 1e-6) continue;
    EXPECT_EQ(circle.contains(place), radius < 1);
  }
  const std::vector<Line> chords = cut(circle, {{-2, 0.6}, {2, 0.6}});
  ASSERT_EQ(chords.size(), 1U);
  EXPECT_NEAR(length_of(chords.front()), 1.6, 1e-6);
}

/// Each edge of a comb is in all strips but for its back.
TEST(PolygonEdges, OfTallEdgesAreFoundAsWell) {
  constexpr int kTeeth = 5000;
  Line ring;
  for (int i = 0; i < kTeeth; ++i) {
    ring.push_back({2.0 * i, 1});
    ring.push_back({2.0 * i, 1000});
    ring.push_back({2.0 * i + 1, 1000});
    ring.push_back({2.0 * i + 1, 1});
  }
  ring.push_back({2.0 * kTeeth, 0});
  ring.push_back({-1, 0});
  const PolygonEdges comb(std::vector<Line>{ring});
  std::mt19937 random(5);
  for (int run = 0; run < 500; ++run) {
    const int tooth = static_cast<int>(random() % (2 * kTeeth));
    const double y = 2 + random() % 900;
    EXPECT_EQ(comb.contains({tooth + 0.5, y}), tooth % 2 == 0) << tooth;
  }
  EXPECT_EQ(cut(comb, {{-5, 500}, {2.0 * kTeeth, 500}}).size(), std::size_t{kTeeth});
}

}  // namespace
}  // namespace spillway::test
