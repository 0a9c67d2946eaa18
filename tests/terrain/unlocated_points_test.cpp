// Heights of triangles at points, against rational numbers and every pair of them.

#include "src/terrain/unlocated_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include "tests/terrain/terrain_mesh.h"

namespace spillway::test {
namespace {

using Wide = __int128;

Wide area_of(const Point<3>& a, const Point<3>& b, double x, double y) {
  return (Wide(b[0]) - Wide(a[0])) * (Wide(y) - Wide(a[1])) -
         (Wide(b[1]) - Wide(a[1])) * (Wide(x) - Wide(a[0]));
}

/// The height of a triangle of whole numbers at a place of whole numbers, rounded once at the end;
/// nothing outside.
std::optional<double> exact_height(const Triangle& t, double x, double y) {
  const std::array<Wide, 3> parts = {area_of(t[1], t[2], x, y), area_of(t[2], t[0], x, y),
                                     area_of(t[0], t[1], x, y)};
  const Wide whole = parts[0] + parts[1] + parts[2];
  if (whole == 0) return std::nullopt;
  Wide sum = 0;
  for (int i = 0; i < 3; ++i) {
    if (whole > 0 ? parts[i] < 0 : parts[i] > 0) return std::nullopt;
    sum += parts[i] * Wide(t[i][2]);
  }
  return static_cast<double>(static_cast<long double>(sum) / static_cast<long double>(whole));
}

std::vector<NumberedPlace> numbered(const std::vector<Point<2>>& points) {
  std::vector<NumberedPlace> places;
  for (const Point<2>& p : points) places.push_back({p[0], p[1], 7 + 3 * places.size()});
  return places;
}

/// Locates all points, and compares heights and what is left with exact ones.
void compare(const std::vector<Triangle>& triangles, const std::vector<Point<2>>& points) {
  const std::vector<NumberedPlace> places = numbered(points);
  UnlocatedPoints unlocated(places);
  std::vector<NumberedHeight> found;
  for (const Triangle& triangle : triangles) unlocated.take_located(triangle, found);
  std::map<std::uint64_t, double> heights;
  for (const auto& [number, height] : found) {
    EXPECT_TRUE(heights.emplace(number, height).second) << "point " << number << " comes twice";
  }
  std::vector<NumberedPlace> rest;
  unlocated.append_to(rest);
  EXPECT_EQ(rest.size(), unlocated.size());
  EXPECT_EQ(rest.size() + found.size(), places.size());
  for (const NumberedPlace& place : places) {
    std::optional<double> exact;
    for (const Triangle& triangle : triangles) {
      if (!exact) exact = exact_height(triangle, place.x, place.y);
    }
    const auto height = heights.find(place.number);
    ASSERT_EQ(height != heights.end(), exact.has_value()) << "point " << place.x << ", " << place.y;
    if (exact) {
      EXPECT_NEAR(height->second, *exact, 1e-6) << "point " << place.x << ", " << place.y;
    }
  }
}

double bumps(double x, double y) { return std::floor(300 * std::sin(x / 40) * std::cos(y / 30)); }

TEST(UnlocatedPoints, GetTheExactHeightInTrianglesOnEdgesVerticesAndTheHull) {
  for (const double side : {12.0, 60.0, 4000.0}) {  // the first two are full of edges and vertices
    compare(triangles_of(square_points(400, side, true, 3), bumps),
            square_points(1500, side * 1.1, true, 4));
  }
}

TEST(UnlocatedPoints, AreFoundInTrianglesMuchLargerThanTheirCells) {
  std::vector<Point<2>> needles = square_points(40, 1e6, true, 5);
  for (int i = 0; i < 40; ++i) needles.push_back({i * 20000.0, i * 20000.0 + (i % 2)});
  compare(triangles_of(needles, bumps), square_points(4000, 1e6, true, 6));
}

TEST(UnlocatedPoints, AreFoundAlsoOnOneLineOrPlace) {
  const std::vector<Triangle> triangles = triangles_of(square_points(300, 50, true, 8), bumps);
  std::vector<Point<2>> row;
  std::vector<Point<2>> column;
  std::vector<Point<2>> place(20, Point<2>{20, 30});
  for (int i = -5; i < 60; ++i) {
    row.push_back({static_cast<double>(i), 17});
    column.push_back({17, static_cast<double>(i)});
  }
  compare(triangles, row);
  compare(triangles, column);
  compare(triangles, place);
}

TEST(UnlocatedPoints, OfATriangleWithoutAreaAreLeftToItsNeighbours) {
  const std::vector<NumberedPlace> places = {{1, 1, 0}};
  UnlocatedPoints unlocated(places);
  std::vector<NumberedHeight> found;
  unlocated.take_located({Point<3>{0, 0, 0}, Point<3>{1, 1, 1}, Point<3>{2, 2, 2}}, found);
  EXPECT_TRUE(found.empty());
  EXPECT_EQ(unlocated.size(), 1U);
}

TEST(UnlocatedPoints, GetTheSameBitsFromAllTrianglesAtAnEdge) {
  const Point<3> a{0, 0, 0.1};
  const Point<3> b{9, 3, 0.7};
  std::vector<double> heights;
  for (const Point<3>& apex : {Point<3>{2, 8, 5.3}, Point<3>{7, -9, -2.9}, Point<3>{1, 40, 1e9}}) {
    for (const Triangle& triangle : {Triangle{a, b, apex}, Triangle{b, apex, a}}) {
      const std::vector<NumberedPlace> places = {{3, 1, 0}};
      std::vector<NumberedHeight> found;
      UnlocatedPoints(places).take_located(triangle, found);
      ASSERT_EQ(found.size(), 1U);
      heights.push_back(found[0].height);
    }
  }
  EXPECT_EQ(std::ranges::count(heights, heights[0]), 6);
}

}  // namespace
}  // namespace spillway::test
