// Volumes between triangles, against prisms, pyramids and sums over fine rasters.

#include "src/terrain/overlay_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/terrain/terrain_mesh.h"

namespace spillway::test {
namespace {

Triangle flat(double height) {
  return {Point<3>{0, 0, height}, Point<3>{4, 0, height}, Point<3>{0, 4, height}};
}

VolumeSums between(const std::vector<Triangle>& first, const std::vector<Triangle>& second) {
  VolumeSums sums;
  for (const Triangle& a : first) {
    for (const Triangle& b : second) {
      add_between(in_canonical_order(a), in_canonical_order(b), sums);
    }
  }
  return sums;
}

/// The prism below a triangle, from z = 0 on.
double prism(const Triangle& t) { return plane_area(t) * (t[0][2] + t[1][2] + t[2][2]) / 3; }

/// A square with its corners among the vertices, so that the whole of it is covered.
std::vector<Triangle> square(std::size_t count, std::uint64_t seed, const HeightOf& height) {
  std::vector<Point<2>> points = square_points(count, 100, false, seed);
  for (const double x : {0.0, 100.0}) {
    for (const double y : {0.0, 100.0}) points.push_back({x, y});
  }
  return triangles_of(points, height);
}

double hills(double x, double y) { return 50 + 10 * std::sin(x / 9) * std::cos(y / 7); }
double slope(double x, double y) { return 40 + 0.1 * x + 0.12 * y; }

TEST(OverlayVolume, OfLevelTrianglesIsAPrism) {
  const VolumeSums sums = between({flat(3)}, {flat(1)});
  EXPECT_EQ(sums.cut.value(), 16);
  EXPECT_EQ(sums.fill.value(), 0);
  EXPECT_EQ(sums.cut_area.value(), 8);
  EXPECT_EQ(sums.area.value(), 8);
}

TEST(OverlayVolume, OfALevelTriangleOnItselfIsNothingButArea) {
  const VolumeSums sums = between({flat(3)}, {flat(3)});
  EXPECT_EQ(sums.cut.value(), 0);
  EXPECT_EQ(sums.fill.value(), 0);
  EXPECT_EQ(sums.cut_area.value(), 0);
  EXPECT_EQ(sums.fill_area.value(), 0);
  EXPECT_EQ(sums.area.value(), 8);
}

TEST(OverlayVolume, IsDividedWhereTheSurfacesCross) {
  // z = x less 1: a tetrahedron of 9 / 2 of base is above, the rest below.
  const Triangle slanted = {Point<3>{0, 0, 0}, Point<3>{4, 0, 4}, Point<3>{0, 4, 0}};
  VolumeSums sums;
  add_above(slanted, 1, sums);
  EXPECT_NEAR(sums.cut.value(), 4.5, 1e-12);
  EXPECT_NEAR(sums.cut_area.value(), 4.5, 1e-12);
  EXPECT_NEAR(sums.fill_area.value(), 3.5, 1e-12);
  EXPECT_NEAR(sums.cut.value() - sums.fill.value(), prism(slanted) - 8, 1e-12);
  const VolumeSums same = between({slanted}, {flat(1)});
  EXPECT_NEAR(same.cut.value(), sums.cut.value(), 1e-12);
  EXPECT_NEAR(same.fill.value(), sums.fill.value(), 1e-12);
}

TEST(OverlayVolume, IsOfWhatTrianglesHaveInCommon) {
  Triangle other = flat(1);
  for (Point<3>& corner : other) corner[0] += 2;
  EXPECT_NEAR(between({flat(3)}, {other}).area.value(), 2, 1e-12);
  for (Point<3>& corner : other) corner[0] += 20;
  EXPECT_EQ(between({flat(3)}, {other}).area.value(), 0);
}

TEST(OverlayVolume, OfWholeSurfacesIsTheDifferenceOfTheirPrisms) {
  const std::vector<Triangle> first = square(300, 1, hills);
  const std::vector<Triangle> second = square(200, 2, slope);
  const VolumeSums sums = between(first, second);
  double expected = 0;
  for (const Triangle& triangle : first) expected += prism(triangle);
  for (const Triangle& triangle : second) expected -= prism(triangle);
  EXPECT_NEAR(sums.cut.value() - sums.fill.value(), expected, 1e-8);
  EXPECT_NEAR(sums.area.value(), 10'000, 1e-8);
  EXPECT_NEAR(sums.cut_area.value() + sums.fill_area.value(), 10'000, 1e-8);
  EXPECT_GT(sums.cut.value(), 1000);
  EXPECT_GT(sums.fill.value(), 1000);
  const VolumeSums turned = between(second, first);
  EXPECT_EQ(turned.cut.value(), sums.fill.value());
  EXPECT_EQ(turned.fill.value(), sums.cut.value());
}

TEST(OverlayVolume, IsWhatAFineRasterSums) {
  const std::vector<Triangle> first = square(60, 3, hills);
  const std::vector<Triangle> second = square(50, 4, slope);
  const VolumeSums sums = between(first, second);
  const auto height_in = [](const std::vector<Triangle>& triangles, double x, double y) {
    for (const Triangle& t : triangles) {
      const auto part = [&](int i, int j) {
        return (t[j][0] - t[i][0]) * (y - t[i][1]) - (t[j][1] - t[i][1]) * (x - t[i][0]);
      };
      const double a = part(1, 2);
      const double b = part(2, 0);
      const double c = part(0, 1);
      if (a >= 0 && b >= 0 && c >= 0) {
        return (a * t[0][2] + b * t[1][2] + c * t[2][2]) / (a + b + c);
      }
    }
    ADD_FAILURE();
    return 0.0;
  };
  constexpr int kSide = 400;
  constexpr double kStep = 100.0 / kSide;
  double cut = 0;
  double fill = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int k = 0; k < kSide; ++k) {
      const double x = (i + 0.5) * kStep;
      const double y = (k + 0.5) * kStep;
      const double above = height_in(first, x, y) - height_in(second, x, y);
      (above > 0 ? cut : fill) += std::abs(above) * kStep * kStep;
    }
  }
  EXPECT_NEAR(sums.cut.value() / cut, 1, 1e-3);
  EXPECT_NEAR(sums.fill.value() / fill, 1, 1e-3);
}

TEST(OverlayVolume, DependsOnNoOrder) {
  std::vector<Triangle> first = square(100, 5, hills);
  std::vector<Triangle> second = square(90, 6, slope);
  const VolumeSums sums = between(first, second);
  std::ranges::reverse(first);
  std::ranges::reverse(second);
  for (Triangle& triangle : first) std::rotate(&triangle[0], &triangle[1], &triangle[0] + 3);
  const VolumeSums other = between(first, second);
  EXPECT_EQ(sums.cut.value(), other.cut.value());
  EXPECT_EQ(sums.fill.value(), other.fill.value());
  EXPECT_EQ(sums.area.value(), other.area.value());
}

TEST(OverlayVolume, FarFromTheOriginIsAsExact) {
  std::vector<Triangle> first = square(100, 7, hills);
  std::vector<Triangle> second = square(100, 8, slope);
  const VolumeSums near = between(first, second);
  for (auto* const surface : {&first, &second}) {
    for (Triangle& triangle : *surface) {
      for (Point<3>& corner : triangle) {
        for (const int k : {0, 1}) corner[k] = std::round(corner[k] * 0x1p20) * 0x1p-20 + 5'000'000;
      }
    }
  }
  const VolumeSums far = between(first, second);
  EXPECT_NEAR(far.cut.value() / near.cut.value(), 1, 1e-7);
  EXPECT_NEAR(far.area.value(), 10'000, 1e-4);
}

}  // namespace
}  // namespace spillway::test
