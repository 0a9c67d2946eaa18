// Polygons become triangles: which outlines are simple, and the laws of how these are cut.

#include "formats/meshes/common/polygon_cutter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "formats/meshes/common/polygon_outline.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using Outline = std::vector<Point<2>>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The triangles of an outline as points, each beginning with its least, in order.
std::set<std::array<Point<2>, 3>> cut(const Outline& outline) {
  PolygonCutter cutter;
  std::set<std::array<Point<2>, 3>> triangles;
  for (const auto& [a, b, c] : cutter.cut(outline)) {
    std::array<Point<2>, 3> triangle = {outline[a], outline[b], outline[c]};
    std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
    triangles.insert(triangle);
  }
  return triangles;
}

/// Corners on a small grid, so that many of them are collinear or cocircular.
Outline random_outline(std::mt19937_64& random, std::size_t corners, int side) {
  Outline outline(corners);
  std::uniform_int_distribution<int> coordinate(0, side);
  for (Point<2>& corner : outline) {
    corner = {static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))};
  }
  return outline;
}

/// A comb: teeth of random length, narrow gaps between them, corners within its sides.
Outline comb(std::mt19937_64& random, int teeth) {
  Outline outline;
  std::uniform_int_distribution<int> height(1, 50);
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const double y = height(random);
    outline.insert(outline.end(), {{4.0 * tooth, 0}, {4.0 * tooth, -y}, {4.0 * tooth + 3, -y}});
    outline.push_back({4.0 * tooth + 3, 0});
  }
  outline.insert(outline.end(), {{4.0 * teeth, 1}, {2.0 * teeth, 1}, {0, 1}});
  return outline;
}

double doubled_area(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double doubled_area(const Outline& outline) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    area += doubled_area(outline[0], outline[i], outline[i + 1]);
  }
  return area;
}

/// Expects a constrained Delaunay triangulation of an outline that is simple.
void expect_laws(const Outline& outline) {
  PolygonCutter cutter;
  const auto triangles = cutter.cut(outline);
  ASSERT_EQ(triangles.size(), outline.size() - 2);
  const double area = doubled_area(outline);
  double sum = 0;
  std::map<Edge, std::uint32_t> apexes;
  for (const auto& triangle : triangles) {
    const double own =
        doubled_area(outline[triangle[0]], outline[triangle[1]], outline[triangle[2]]);
    ASSERT_GT(own * area, 0);
    sum += own;
    for (int k = 0; k < 3; ++k) {
      const Edge edge{triangle[k], triangle[(k + 1) % 3]};
      ASSERT_TRUE(apexes.emplace(edge, triangle[(k + 2) % 3]).second);
    }
  }
  ASSERT_EQ(sum, area);
  for (const auto& [edge, apex] : apexes) {
    const auto other = apexes.find({edge.second, edge.first});
    if (other == apexes.end()) {
      ASSERT_EQ((edge.first + 1) % outline.size(), edge.second) << "a side of the polygon";
      continue;
    }
    std::array<Point<2>, 3> triangle = {outline[edge.first], outline[edge.second], outline[apex]};
    if (area < 0) std::swap(triangle[0], triangle[1]);
    ASSERT_LT(in_sphere<2>(triangle, outline[other->second]), 0);
  }
}

/// Expects the same triangles from wherever the outline begins, and turned round the other way.
void expect_no_beginning(Outline outline) {
  const auto triangles = cut(outline);
  for (std::size_t i = 0; i < std::min<std::size_t>(outline.size(), 12); ++i) {
    std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    ASSERT_EQ(cut(outline), triangles);
  }
  std::ranges::reverse(outline);
  std::set<std::array<Point<2>, 3>> turned;
  for (const auto& [a, b, c] : triangles) turned.insert({a, c, b});
  ASSERT_EQ(cut(outline), turned);
}

TEST(PolygonCutter, SimplePolygonsOnAGridAreCutByTheLawsFromAnyCorner) {
  std::mt19937_64 random(1);
  int simple = 0;
  for (int trial = 0; trial < 60000; ++trial) {
    const Outline outline = random_outline(random, 4 + trial % 5, 2 + trial % 3);
    if (!outline_fault(outline).empty()) continue;
    ++simple;
    ASSERT_NO_FATAL_FAILURE(expect_laws(outline)) << ::testing::PrintToString(outline);
    ASSERT_NO_FATAL_FAILURE(expect_no_beginning(outline)) << ::testing::PrintToString(outline);
  }
  EXPECT_GT(simple, 3000);
}

TEST(PolygonCutter, CombsOfManyCornersAreCutByTheLaws) {
  std::mt19937_64 random(2);
  for (const int teeth : {2, 10, 500}) {
    const Outline outline = comb(random, teeth);
    ASSERT_EQ(outline_fault(outline), "");
    ASSERT_NO_FATAL_FAILURE(expect_laws(outline));
    ASSERT_NO_FATAL_FAILURE(expect_no_beginning(outline));
  }
}

TEST(PolygonCutter, ASquareHasTheDiagonalThatTheTieRuleChooses) {
  const Outline square = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  const auto triangles = cut(square);
  const bool rising = in_sphere<2>({square[2], square[3], square[1]}, square[0]) > 0;
  EXPECT_EQ(triangles.contains({Point<2>{0, 0}, {1, 0}, {1, 1}}), rising);
  EXPECT_EQ(triangles.contains({Point<2>{0, 0}, {1, 0}, {0, 1}}), !rising);
}

TEST(PolygonCutter, CornersWithinASideAreKept) {
  const Outline triangle = {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {0, 4}, {0, 1}};
  ASSERT_EQ(outline_fault(triangle), "");
  expect_laws(triangle);
}

TEST(PolygonOutline, FaultsAreTold) {
  const std::pair<Outline, const char*> cases[] = {
      {{{0, 0}, {1, 1}, {2, 2}, {3, 3}}, "on one line"},
      {{{1, 1}, {1, 1}, {1, 1}, {1, 1}}, "on one line"},
      {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}, "crosses or touches"},          // a bow tie
      {{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}, "crosses or touches"},  // a corner on a side
      {{{0, 0}, {3, 0}, {1, 0}, {1, 2}}, "crosses or touches"},          // a spike
      {{{0, 0}, {1, 0}, {1, 0}, {0, 1}}, "crosses or touches"},          // a corner twice
      {{{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}, "crosses or touches"}};
  for (const auto& [outline, fault] : cases) {
    EXPECT_THAT(outline_fault(outline), HasSubstr(fault)) << ::testing::PrintToString(outline);
  }
  EXPECT_EQ(outline_fault(Outline{{0, 0}, {4, 0}, {1, 1}, {0, 4}}), "");
}

TEST(PolygonOutline, AreDecidedExactly) {
  // The third corner lies on the line through the first and the last, or one unit in the last place
  // beside it.
  const double away = std::nextafter(0.3, 1);
  const Outline on = {{0, 0}, {0.9, 0}, {0.3, 0.3}, {0.9, 0.9}};
  const Outline beside = {{0, 0}, {0.9, 0}, {away, 0.3}, {0.9, 0.9}};
  EXPECT_NE(outline_fault(on), "");
  EXPECT_EQ(outline_fault(beside), "");
}

}  // namespace
}  // namespace spillway::test
