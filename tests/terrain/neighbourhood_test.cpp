// What nine heights tell: of planes and of a paraboloid, where it is known.

#include "src/terrain/neighbourhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// The heights of a surface around a place, in pixels of these sides.
Neighbourhood around(double x, double y, const Point<2>& sides,
                     const std::function<double(double x, double y)>& height) {
  Neighbourhood z{};
  for (int i = 0; i < 9; ++i) {
    z[i] = static_cast<float>(height(x + (i % 3 - 1) * sides[0], y + (1 - i / 3) * sides[1]));
  }
  return z;
}

TEST(Neighbourhood, BothGradientsOfAPlaneAreItsOwn) {
  const Point<2> sides{0.5, 0.25};
  const auto plane = [](double x, double y) { return 8 + 0.75 * x - 1.5 * y; };
  for (const auto method : {GradientMethod::kHorn, GradientMethod::kZevenbergenThorne}) {
    const Gradient gradient = gradient_of(around(4, 2, sides, plane), method, sides);
    EXPECT_EQ(gradient[0], 0.75);
    EXPECT_EQ(gradient[1], -1.5);
  }
}

TEST(Neighbourhood, HornCountsTheNeighboursBesideTwice) {
  Neighbourhood z{};
  z[5] = 8;
  EXPECT_EQ(gradient_of(z, GradientMethod::kHorn, {1, 1})[0], 2);
  EXPECT_EQ(gradient_of(z, GradientMethod::kZevenbergenThorne, {1, 1})[0], 4);
  z[5] = 0;
  z[2] = 8;
  EXPECT_EQ(gradient_of(z, GradientMethod::kHorn, {1, 1})[0], 1);
  EXPECT_EQ(gradient_of(z, GradientMethod::kHorn, {1, 1})[1], 1);
  EXPECT_EQ(gradient_of(z, GradientMethod::kZevenbergenThorne, {1, 1})[0], 0);
}

TEST(Neighbourhood, AspectsAreThoseOfAGradientRounded) {
  EXPECT_TRUE(std::isnan(rounded_aspect_of({0, 0})));
  for (const auto& [gradient, aspect] : std::vector<std::pair<Gradient, float>>{
           {{0, -1}, 0.0F}, {{-1, 0}, 90.0F}, {{0, 1}, 180.0F}, {{1, 0}, 270.0F}}) {
    EXPECT_EQ(rounded_aspect_of(gradient), aspect);
    EXPECT_FALSE(std::signbit(rounded_aspect_of(gradient)));
  }
  EXPECT_EQ(rounded_aspect_of({1e-9, -1}), 0);  // not 360
  for (int degrees = 1; degrees < 360; ++degrees) {
    const double radians = degrees * M_PI / 180;
    const Gradient gradient = {-std::sin(radians), -std::cos(radians)};
    EXPECT_NEAR(rounded_aspect_of(gradient), aspect_of(gradient), 4e-5);
  }
}

TEST(Neighbourhood, ShadesReachFromOneTo255) {
  const Point<3> light = direction_of({.azimuth = 90, .altitude = 45});
  EXPECT_NEAR(shade_of({-1, 0}, light), 255, 1e-9);
  EXPECT_NEAR(shade_of({0, 0}, light), 1 + 254 * std::sqrt(0.5), 1e-9);
  EXPECT_EQ(shade_of({2, 0}, light), 1);
}

/// Each light by itself, with its weight.
TEST(Neighbourhood, LightFromFourSidesIsWeightedByTheAspect) {
  const MultiShade shade(30);
  EXPECT_NEAR(shade.of({0, 0}), 1 + 254 * 0.5, 1e-9);
  EXPECT_NEAR(shade.of({1e-9, 1e-9}), 1 + 254 * 0.5, 1e-5);
  for (const Gradient& gradient : {Gradient{0.3, 0.2}, {-2, 0.5}, {0, -1}, {5, 5}, {-0.1, -0.7}}) {
    double sum = 0;
    for (const double azimuth : {225.0, 270.0, 315.0, 360.0}) {
      const double off = (aspect_of(gradient) - azimuth) * M_PI / 180;
      const double one = shade_of(gradient, direction_of({.azimuth = azimuth, .altitude = 30})) - 1;
      sum += std::cos(off) * std::cos(off) * one / 2;
    }
    EXPECT_NEAR(shade.of(gradient), 1 + sum, 1e-9);
  }
}

TEST(Neighbourhood, RoughnessRuggednessAndPosition) {
  const Neighbourhood z = {1, 2, 3, 4, 7, 6, 5, 8, 9};
  EXPECT_EQ(roughness_of(z), 8);
  EXPECT_DOUBLE_EQ(ruggedness_of(z), std::sqrt(36 + 25 + 16 + 9 + 1 + 4 + 1 + 4));
  EXPECT_DOUBLE_EQ(position_of(z), 7 - 38 / 8.0);
}

/// z = a x^2 + b y^2 + c x y at a place: derivatives are known, and quadratic surfaces are met.
TEST(Neighbourhood, CurvaturesOfAParaboloidAreItsDerivatives) {
  const double a = 0.5;
  const double b = -0.25;
  const double c = 0.125;
  const auto surface = [=](double x, double y) { return a * x * x + b * y * y + c * x * y; };
  const Point<2> sides{0.5, 2};
  const double x = 3;
  const double y = -8;
  const double gx = 2 * a * x + c * y;
  const double gy = 2 * b * y + c * x;
  const double square = gx * gx + gy * gy;
  for (const double factor : {1.0, 3.0}) {
    const CurvedSurface curved(around(x, y, sides, surface), sides, factor);
    const double hundred = 100 * factor;
    EXPECT_DOUBLE_EQ(curved.curvature(), -2 * (a + b) * hundred);
    EXPECT_DOUBLE_EQ(curved.profile(),
                     2 * (a * gx * gx + b * gy * gy + c * gx * gy) / square * hundred);
    EXPECT_DOUBLE_EQ(curved.plan(),
                     -2 * (a * gy * gy + b * gx * gx - c * gx * gy) / square * hundred);
    EXPECT_NEAR(curved.curvature(), curved.plan() - curved.profile(), 1e-9);
  }
}

TEST(Neighbourhood, CurvaturesOfASummitBulge) {
  const auto dome = [](double x, double y) { return -x * x - y * y; };
  const CurvedSurface flank(around(1, 1, {1, 1}, dome), {1, 1}, 1);
  EXPECT_GT(flank.curvature(), 0);
  EXPECT_GT(flank.plan(), 0);
  EXPECT_LT(flank.profile(), 0);
  const CurvedSurface top(around(0, 0, {1, 1}, dome), {1, 1}, 1);
  EXPECT_EQ(top.curvature(), 400);
  EXPECT_EQ(top.plan(), 0);
  EXPECT_EQ(top.profile(), 0);
}

TEST(Neighbourhood, IsCompleteWhereAllNineAreFinite) {
  Neighbourhood z{};
  z.fill(std::numeric_limits<float>::max());
  EXPECT_TRUE(is_complete(z));
  for (float& height : z) {
    for (const float none : {kNothing, std::numeric_limits<float>::infinity()}) {
      const float old = std::exchange(height, none);
      EXPECT_FALSE(is_complete(z));
      height = old;
    }
  }
}

TEST(Neighbourhood, MissingNeighboursGetThePixelsOwnHeight) {
  Neighbourhood z = {1, kNothing, 3, 4, 5, 6, kNothing, 8, 9};
  complete(z, {});
  EXPECT_THAT(z, ElementsAre(1, 5, 3, 4, 5, 6, 5, 8, 9));
}

TEST(Neighbourhood, BeyondTheRasterItGoesOnAsInside) {
  constexpr float kN = kNothing;
  Neighbourhood north = {kN, kN, kN, 4, 5, 7, 7, 8, 9};
  complete(north, {.north = true});
  EXPECT_THAT(north, ElementsAre(1, 2, 5, 4, 5, 7, 7, 8, 9));
  Neighbourhood east = {1, 2, kN, 4, 5, kN, 7, 8, kN};
  complete(east, {.east = true});
  EXPECT_THAT(east, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  Neighbourhood corner = {kN, 2, 3, kN, 5, 7, kN, kN, kN};
  complete(corner, {.south = true, .west = true});
  EXPECT_THAT(corner, ElementsAre(2, 2, 3, 5, 5, 7, 8, 8, 11));
  Neighbourhood hole = {kN, kN, kN, 4, 5, 7, kN, 8, 9};
  complete(hole, {.north = true});
  EXPECT_THAT(hole, ElementsAre(5, 2, 5, 4, 5, 7, 5, 8, 9));
  Neighbourhood known = {7, kN, 9, 4, 5, 7, 7, 8, 9};
  complete(known, {.north = true});
  EXPECT_THAT(known, ElementsAre(7, 2, 9, 4, 5, 7, 7, 8, 9));
  Neighbourhood narrow = {kN, 2, kN, kN, 5, kN, kN, 8, kN};
  complete(narrow, {.west = true, .east = true});
  EXPECT_FALSE(is_complete(narrow));
}

}  // namespace
}  // namespace spillway::test
