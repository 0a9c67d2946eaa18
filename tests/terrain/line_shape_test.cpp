#include "src/terrain/line_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

using Line = std::vector<Point<2>>;
using ::testing::ElementsAre;

/// Portals across the x axis at 0, 1, 2, ..., passed at these heights, that reach from -1 to 1.
std::vector<Portal> along_x(const std::vector<double>& heights) {
  std::vector<Portal> portals;
  for (const double y : heights) {
    const auto x = static_cast<double>(portals.size());
    portals.push_back({{x, y}, {x, 1}, {x, -1}});
  }
  return portals;
}

TEST(LineShape, WithoutToleranceIsExact) {
  EXPECT_THAT(shaped_line(along_x({0, 0.5, 0.25}), {}),
              ElementsAre(Point<2>{0, 0}, Point<2>{1, 0.5}, Point<2>{2, 0.25}));
}

TEST(LineShape, OfFewestBendsIsTheShortestThroughItsPortals) {
  EXPECT_THAT(shaped_line(along_x({0, 0.5, -0.5, 0.25, 0}), {.simplify = 9}),
              ElementsAre(Point<2>{0, 0}, Point<2>{4, 0}));
  // No farther than 0.25 from each of its points: it bends at ends of portals.
  EXPECT_THAT(shaped_line(along_x({0, 0.5, -0.5, 0.25, 0}), {.simplify = 0.25}),
              ElementsAre(Point<2>{0, 0}, Point<2>{1, 0.25}, Point<2>{2, -0.25}, Point<2>{3, 0},
                          Point<2>{4, 0}));
}

TEST(LineShape, OfASpiralTouchesItsInnerSide) {
  std::vector<Portal> portals;
  for (int i = 0; i <= 100; ++i) {
    const double angle = i * M_PI / 20;
    const auto at = [&](double radius) {
      return Point<2>{radius * std::cos(angle), radius * std::sin(angle)};
    };
    portals.push_back({at(10 + i), at(9.0 + i), at(12.0 + i)});
  }
  const Line line = shaped_line(portals, {.simplify = 9});
  ASSERT_GT(line.size(), 90U);
  EXPECT_EQ(line.front(), portals.front().at);
  EXPECT_EQ(line.back(), portals.back().at);
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    EXPECT_TRUE(std::ranges::any_of(portals, [&](const Portal& p) { return p.left == line[i]; }));
  }
}

TEST(LineShape, ThatIsStraightStaysWhereSmooth) {
  std::vector<Portal> portals;
  for (const double x : {0.0, 0.5, 0.6, 3.0, 3.1, 7.0}) {  // over edges at all angles
    portals.push_back({{x, x}, {x - 1, x + x}, {x + 1, x - x}});
  }
  const Line line = shaped_line(portals, {.smooth = 1});
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i][0], portals[i].at[0], 1e-12);
    EXPECT_NEAR(line[i][1], portals[i].at[1], 1e-12);
  }
}

/// A vertex on the level is the end of several portals, and other lines may be there.
TEST(LineShape, IsEitherAtAVertexOrApartFromIt) {
  std::mt19937 random(3);
  const Point<2> vertex{88.48, 0.1};
  const auto around = [&](double size) {
    return Point<2>{vertex[0] + size * (static_cast<double>(random() % 2001) / 1000 - 1),
                    vertex[1] + size * (static_cast<double>(random() % 2001) / 1000 - 1)};
  };
  std::size_t at_vertex = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<Portal> portals = {{vertex, vertex, vertex}};
    for (int k = 0; k < 3; ++k) portals.push_back({vertex, vertex, around(0.5)});
    const Point<2> end = around(2);
    portals.push_back({end, end, end});
    for (const Point<2>& p : shaped_line(portals, {.smooth = 0.5})) {
      if (p == vertex) {
        ++at_vertex;
      } else {
        EXPECT_GT(std::hypot(p[0] - vertex[0], p[1] - vertex[1]), 1e-12);
      }
    }
  }
  EXPECT_GT(at_vertex, 30000U);
}

TEST(LineShape, ThatIsClosedIsSmoothAtItsBeginningToo) {
  std::vector<Portal> portals;
  for (int i = 0; i <= 24; ++i) {
    const double angle = i * M_PI / 12;
    const auto at = [&](double radius) {
      return Point<2>{radius * std::cos(angle), radius * std::sin(angle)};
    };
    const double radius = i % 24 == 0 ? 11.0 : 10.0;
    portals.push_back({at(radius), at(8), at(12)});
  }
  portals.back() = portals.front();
  const Line line = shaped_line(portals, {.smooth = 2});
  EXPECT_EQ(line.front(), line.back());
  EXPECT_LT(line.front()[0], 10.3);
}

}  // namespace
}  // namespace spillway::test
