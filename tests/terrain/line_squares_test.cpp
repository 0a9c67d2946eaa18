// Lines that are cut at the edges of squares.

#include "src/terrain/line_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tests/terrain/line_length.h"

namespace spillway::test {
namespace {

using Line = std::vector<Point<2>>;
using Pieces = std::vector<std::pair<GridSquare, Line>>;

Pieces cut(const Line& line, double side) {
  Pieces pieces;
  cut_at_squares(line, side, [&](GridSquare square, std::span<const Point<2>> points) {
    pieces.emplace_back(square, Line(points.begin(), points.end()));
  });
  return pieces;
}

Line random_line(std::mt19937& random, bool whole) {
  Line line(2 + random() % 12);
  for (Point<2>& p : line) {
    for (int k = 0; k < 2; ++k) {
      p[k] = static_cast<double>(random() % 400) / 10 - 20;
      if (whole) p[k] = std::round(p[k] / 5) * 5;  // on edges and corners
    }
  }
  if (random() % 2 == 0) line.push_back(line.front());
  return line;
}

TEST(LineSquares, PiecesLieInTheirSquaresAndAreTheWholeLine) {
  std::mt19937 random(4);
  for (int run = 0; run < 2000; ++run) {
    const Line line = random_line(random, run % 2 == 0);
    const double side = run % 3 == 0 ? 5 : 7.25;
    double length = 0;
    for (const auto& [square, piece] : cut(line, side)) {
      ASSERT_GE(piece.size(), 2U);
      length += length_of(piece);
      for (const Point<2>& p : piece) {
        ASSERT_GE(p[0], static_cast<double>(square.column) * side);
        ASSERT_LE(p[0], static_cast<double>(square.column + 1) * side);
        ASSERT_GE(p[1], static_cast<double>(square.row) * side);
        ASSERT_LE(p[1], static_cast<double>(square.row + 1) * side);
      }
    }
    ASSERT_NEAR(length, length_of(line), 1e-9);
  }
}

TEST(LineSquares, DoNotDependOnTheDirectionOfALine) {
  std::mt19937 random(5);
  for (int run = 0; run < 1000; ++run) {
    Line line = random_line(random, false);
    if (line.front() == line.back()) line.pop_back();
    Pieces there = cut(line, 7.25);
    std::reverse(line.begin(), line.end());
    Pieces back = cut(line, 7.25);
    std::reverse(back.begin(), back.end());
    for (auto& [square, piece] : back) std::reverse(piece.begin(), piece.end());
    ASSERT_EQ(there, back) << run;
  }
}

TEST(LineSquares, OfAClosedLineMeetAtItsEndsInOne) {
  const Pieces pieces = cut({{1, 1}, {12, 1}, {12, 4}, {1, 4}, {1, 1}}, 10);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].first, (GridSquare{0, 0}));
  EXPECT_EQ(pieces[0].second, (Line{{10, 4}, {1, 4}, {1, 1}, {10, 1}}));
  EXPECT_EQ(pieces[1].first, (GridSquare{0, 1}));
  EXPECT_EQ(pieces[1].second, (Line{{10, 1}, {12, 1}, {12, 4}, {10, 4}}));
  const Line inside = {{1, 1}, {2, 1}, {2, 2}, {1, 1}};
  EXPECT_EQ(cut(inside, 10), (Pieces{{{0, 0}, inside}})) << "stays closed";
}

TEST(LineSquares, HoldTheirSouthernAndWesternEdges) {
  EXPECT_EQ(cut({{10, 2}, {10, 8}}, 10), (Pieces{{{0, 1}, {{10, 2}, {10, 8}}}}));
  EXPECT_EQ(cut({{2, -10}, {8, -10}}, 10), (Pieces{{{-1, 0}, {{2, -10}, {8, -10}}}}));
  for (int i = 1; i < 2000; ++i) {  // multiples that division rounds down
    const double edge = i * 0.1;
    EXPECT_EQ(cut({{edge, 0.01}, {edge, 0.02}}, 0.1)[0].first, (GridSquare{0, i})) << i;
  }
  EXPECT_TRUE(cut({{3, 3}}, 10).empty());
  EXPECT_TRUE(cut({{3, 3}, {3, 3}}, 10).empty());
}

}  // namespace
}  // namespace spillway::test
