// Heights and what is derived from them, and where grids lie.

#include "src/terrain/pixel_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "src/error.h"
#include "src/terrain/grid_choice.h"
#include "tests/terrain/terrain_mesh.h"

namespace spillway::test {
namespace {

/// Calls `expect` for each pixel of each triangle.
void for_all_pixels(
    const PixelGrid& grid, const std::vector<Triangle>& triangles,
    const std::function<void(const Triangle&, double x, double y, double height)>& expect) {
  const PixelCentres centres(grid, std::nullopt);
  std::vector<PixelRun> runs;
  std::size_t pixels = 0;
  for (const Triangle& triangle : triangles) {
    const Triangle canonical = in_canonical_order(triangle);
    find_pixels(centres, canonical, box_of(centres, canonical), runs);
    const TrianglePlane plane(canonical, {1, 1});
    for (const PixelRun& run : runs) {
      for (std::uint32_t c = run.begin; c < run.end; ++c, ++pixels) {
        const double x = grid.centre_x(c);
        const double y = grid.centre_y(run.row);
        expect(canonical, x, y, plane.at(run.relation, x, y));
      }
    }
  }
  EXPECT_GT(pixels, 0U);
}

TEST(TrianglePlane, APlaneIsExactWithinRounding) {
  const auto plane = [](double x, double y) { return 100 + 0.25 * x - 1.5 * y; };
  for (const bool whole : {false, true}) {
    for_all_pixels({0, 100, 0.5, 200, 200}, triangles_of(square_points(500, 100, whole, 3), plane),
                   [&](const Triangle&, double x, double y, double height) {
                     EXPECT_NEAR(height, plane(x, y), 1e-11);
                   });
  }
}

TEST(TrianglePlane, NeedlesKeepThePlaneToo) {
  const auto plane = [](double x, double y) { return 3 * x - 2 * y; };
  const std::vector<Triangle> triangles =
      triangles_of({{0, 0}, {1'000'000, 1}, {2'000'000, 1}, {999'999, 1}}, plane);
  for_all_pixels({0, 2, 1. / 64, 2000000, 128}, triangles,
                 [&](const Triangle&, double x, double y, double height) {
                   ASSERT_NEAR(height, plane(x, y), 1e-8);
                 });
}

TEST(TrianglePlane, AQuadraticSurfaceIsOffByNoMoreThanTheInterpolationBound) {
  const auto bowl = [](double x, double y) { return 0.01 * (x * x + y * y); };
  for_all_pixels({0, 100, 1, 100, 100}, triangles_of(square_points(800, 100, false, 5), bowl),
                 [&](const Triangle& triangle, double x, double y, double height) {
                   double longest = 0;
                   for (int i = 0; i < 3; ++i) {
                     const Point<3>& a = triangle[i];
                     const Point<3>& b = triangle[(i + 1) % 3];
                     longest = std::max(longest, std::hypot(a[0] - b[0], a[1] - b[1]));
                   }
                   // |f - interpolant| <= (largest second derivative) * R^2 / 2, R <=
                   // longest/sqrt(3) for the smallest circle around the triangle.
                   EXPECT_LE(std::abs(height - bowl(x, y)), 0.02 * longest * longest / 6 + 1e-12);
                   EXPECT_GE(height, bowl(x, y) - 1e-12);
                 });
}

TEST(TrianglePlane, NeighboursAgreeOnTheirEdgesToTheLastBit) {
  const auto rough = [](double x, double y) { return std::sin(7 * x + 3 * y) * 1000; };
  std::map<std::pair<double, double>, double> heights;
  std::size_t shared = 0;
  for_all_pixels({-0.25, 9.25, 0.5, 19, 19}, triangles_of(square_points(70, 9, true, 2), rough),
                 [&](const Triangle&, double x, double y, double height) {
                   const auto [found, is_new] = heights.try_emplace({x, y}, height);
                   if (is_new) return;
                   ++shared;
                   EXPECT_EQ(found->second, height);
                 });
  EXPECT_GT(shared, 50U);
}

TEST(Surface, SlopeAndAspectOfPlanes) {
  EXPECT_DOUBLE_EQ(slope_of({1, 0}), 45);
  EXPECT_DOUBLE_EQ(slope_of({0, 0}), 0);
  EXPECT_TRUE(std::isnan(aspect_of({0, 0})));
  EXPECT_DOUBLE_EQ(aspect_of({0, -1}), 0);   // falls to the north
  EXPECT_DOUBLE_EQ(aspect_of({-1, 0}), 90);  // to the east
  EXPECT_DOUBLE_EQ(aspect_of({0, 1}), 180);
  EXPECT_DOUBLE_EQ(aspect_of({1, 0}), 270);
  EXPECT_EQ(static_cast<float>(aspect_of({1e-12, -1})), 0);  // not 360
}

TEST(Surface, NoProductIsMinusZero) {
  const auto is_zero = [](double value) { return value == 0 && !std::signbit(value); };
  for (const double zero : {0.0, -0.0}) {
    EXPECT_TRUE(is_zero(aspect_of({zero, -1})));
    EXPECT_TRUE(is_zero(slope_of({zero, -zero})));
    EXPECT_TRUE(is_zero(hillshade_of({zero, zero}, {zero, zero, zero})));
    EXPECT_TRUE(is_zero(hillshade_of({zero, 1}, {0, 1, -0.0})));
  }
}

TEST(Surface, GradientIsInOutputUnits) {
  const Triangle canonical = in_canonical_order({{{0, 0, 5}, {100, 0, 7}, {0, 100, 4}}});
  const Gradient gradient = TrianglePlane(canonical, {0.01, 0.02}).gradient();
  EXPECT_DOUBLE_EQ(gradient[0], 2);
  EXPECT_DOUBLE_EQ(gradient[1], -0.5);
}

TEST(Surface, HillshadeIsBrightestTowardsTheLightAndDarkBehind) {
  const Point<3> light = direction_of({.azimuth = 90, .altitude = 45});
  EXPECT_NEAR(hillshade_of({-1, 0}, light), 255, 1e-9);  // falls to the east, at 45 degrees
  EXPECT_NEAR(hillshade_of({0, 0}, light), 255 * std::sqrt(0.5), 1e-9);
  EXPECT_EQ(hillshade_of({2, 0}, light), 0);
}

TEST(GridChoice, TheExtentIsCoveredFromItsUpperLeftCorner) {
  EXPECT_EQ(choose_grid({.resolution = 2}, {{1, 10}, {8, 15}}), (PixelGrid{1, 15, 2, 4, 3}));
}

TEST(GridChoice, AWholeNumberOfPixelsIsNotRoundedUp) {
  const PixelGrid grid = choose_grid({.resolution = 0.1}, {{0.1, 0.1}, {0.7, 1.2}});
  EXPECT_EQ(grid.columns, 6U);
  EXPECT_EQ(grid.rows, 11U);
}

TEST(GridChoice, AlignedEdgesAreMultiplesOfTheResolution) {
  EXPECT_EQ(choose_grid({.resolution = 2, .align = true}, {{1, -3}, {8, 15}}),
            (PixelGrid{0, 16, 2, 4, 10}));
  EXPECT_EQ(choose_grid({.resolution = 5, .bounds = Box<2>{{-7, 1}, {1, 9}}, .align = true}, {}),
            (PixelGrid{-10, 10, 5, 3, 2}));
}

TEST(GridChoice, BoundsOverruleTheExtentAndAGivenGridBoth) {
  const GridRequest request{.resolution = 1, .bounds = Box<2>{{0, 0}, {3, 2}}};
  EXPECT_EQ(choose_grid(request, {{-50, -50}, {50, 50}}), (PixelGrid{0, 2, 1, 3, 2}));
  GridRequest given = request;
  given.given = PixelGrid{7, 8, 9, 10, 11};
  EXPECT_EQ(choose_grid(given, {{-50, -50}, {50, 50}}), *given.given);
}

TEST(GridChoice, MorePixelsThanGdalCountsAreRefused) {
  EXPECT_THROW((void)choose_grid({.resolution = 1e-9}, {{0, 0}, {100, 1}}), InvalidArgument);
}

}  // namespace
}  // namespace spillway::test
