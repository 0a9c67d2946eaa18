#include "src/picture/polygons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace spillway::test {
namespace {

constexpr Colour kRed = {1, 0, 0};
constexpr Colour kBlue = {0, 0, 1};

SeenPolygon triangle(const Point<3>& a, const Point<3>& b, const Point<3>& c,
                     const Colour& colour) {
  SeenPolygon polygon;
  polygon.corners = {a, b, c, {}};
  polygon.colour = colour;
  return polygon;
}

/// A fan of thin triangles that fills the square from 1 to 9, turning either way.
std::vector<SeenPolygon> fan() {
  std::vector<Point<3>> rim;
  for (int i = 0; i < 37; ++i) rim.push_back({1 + 8 * i / 37.0, 1, 0});
  for (int i = 0; i < 37; ++i) rim.push_back({9, 1 + 8 * i / 37.0, 0});
  for (int i = 0; i < 37; ++i) rim.push_back({9 - 8 * i / 37.0, 9, 0});
  for (int i = 0; i < 37; ++i) rim.push_back({1, 9 - 8 * i / 37.0, 0});
  std::vector<SeenPolygon> polygons;
  const Point<3> hub = {4.3, 6.1, 0};
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Point<3>& next = rim[(i + 1) % rim.size()];
    polygons.push_back(i % 2 == 0 ? triangle(hub, rim[i], next, kRed)
                                  : triangle(hub, next, rim[i], kBlue));
  }
  return polygons;
}

std::vector<std::uint8_t> bytes(const Picture& picture) {
  return {picture.bytes().begin(), picture.bytes().end()};
}

TEST(Polygons, NeighboursLeaveNoGapAndDoNotReachOut) {
  const Picture picture = draw_polygons(fan(), 10, 10);
  for (std::uint32_t row = 0; row < 10; ++row) {
    for (std::uint32_t column = 0; column < 10; ++column) {
      const bool inside = row >= 1 && row < 9 && column >= 1 && column < 9;
      EXPECT_EQ(picture.opacity(column, row), inside ? 255 : 0) << column << ' ' << row;
    }
  }
}

TEST(Polygons, TheOrderDoesNotMatter) {
  std::vector<SeenPolygon> polygons = fan();
  const auto forwards = bytes(draw_polygons(polygons, 10, 10));
  std::reverse(polygons.begin(), polygons.end());
  EXPECT_EQ(bytes(draw_polygons(polygons, 10, 10)), forwards);
}

TEST(Polygons, TheNearerOneIsSeenAlsoWhereTwoInterpenetrate) {
  // One is level, the other one rises from left to right through it.
  const std::vector<SeenPolygon> both = {
      triangle({-50, -50, 0}, {50, -50, 0}, {0, 100, 0}, kRed),
      triangle({-50, -50, -55}, {50, -50, 45}, {0, 100, -5}, kBlue)};
  const Picture picture = draw_polygons(both, 10, 10);
  EXPECT_EQ(picture.colour(0, 5), kRed);
  EXPECT_EQ(picture.colour(9, 5), kBlue);
}

TEST(Polygons, HalfAPixelIsHalfOpaque) {
  SeenPolygon square;
  square.count = 4;
  square.corners = {{{0, 0, 0}, {2, 0, 0}, {2, 1 + 1.0 / 3, 0}, {0, 1 + 1.0 / 3, 0}}};
  square.colour = kRed;
  const Picture picture = draw_polygons(std::vector{square}, 2, 2);
  EXPECT_EQ(picture.opacity(0, 0), 255);
  EXPECT_EQ(picture.opacity(0, 1), 85);
  EXPECT_EQ(picture.colour(0, 1), kRed);
}

TEST(Polygons, EdgesAreDarkAndAPolygonWithADoubleCornerIsNotAllEdge) {
  SeenPolygon polygon;
  polygon.count = 4;
  polygon.corners = {{{0, 0, 0}, {40, 0, 0}, {40, 0, 0}, {0, 40, 0}}};
  polygon.colour = kRed;
  polygon.edge_opacity = 1;
  const Picture picture = draw_polygons(std::vector{polygon}, 40, 40);
  EXPECT_EQ(picture.colour(10, 10), kRed);
  EXPECT_LT(picture.colour(10, 0)[0], 0.6);
}

TEST(Polygons, WithoutAreaNothingIsDrawn) {
  const std::vector<SeenPolygon> needle = {triangle({0, 0, 0}, {5, 5, 0}, {10, 10, 0}, kRed)};
  EXPECT_EQ(bytes(draw_polygons(needle, 10, 10)), bytes(Picture(10, 10)));
}

}  // namespace
}  // namespace spillway::test
