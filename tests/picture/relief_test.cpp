#include "src/picture/relief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "src/picture/ramps.h"

namespace spillway::test {
namespace {

constexpr std::uint32_t kSide = 60;

/// In the colours of heights.
Picture drawn(const HeightPixels& heights, const ReliefStyle& style) {
  const ColourOfPixel colour =
      colours_by(heights, seen_range(heights), all_ramps().front().colours);
  return draw_relief(heights, colour, style);
}

/// Heights of a function of x and y, in pixels from the upper left corner, y downwards; where it
/// is not a number there is none.
HeightPixels pixels_of(const std::function<double(double x, double y)>& height) {
  HeightPixels pixels(kSide, kSide);
  constexpr std::uint32_t samples = HeightPixels::kSamples;
  for (std::uint32_t row = 0; row < kSide * samples; ++row) {
    for (std::uint32_t column = 0; column < kSide * samples; ++column) {
      const double z = height((column + 0.5) / samples, (row + 0.5) / samples);
      if (!std::isnan(z)) pixels.add(column, row, static_cast<float>(z));
    }
  }
  return pixels;
}

double cone(double x, double y) { return 1000 - std::hypot(x - kSide / 2.0, y - kSide / 2.0); }

float brightness(const Picture& picture, std::uint32_t column, std::uint32_t row) {
  const Colour colour = picture.colour(column, row);
  return colour[0] + colour[1] + colour[2];
}

TEST(Relief, AConeIsBrightToTheNorthWestAndDarkToTheSouthEast) {
  const Picture picture = drawn(pixels_of(cone), {.exaggeration = 1});
  // Places at the same height: all differences are light.
  EXPECT_GT(brightness(picture, 20, 20), 1.3F * brightness(picture, 39, 39));
  EXPECT_GT(brightness(picture, 20, 20), brightness(picture, 39, 20));
  EXPECT_GT(brightness(picture, 39, 20), brightness(picture, 39, 39));
}

TEST(Relief, LightAlongTheGroundLeavesWhatItDoesNotMeetDark) {
  const Picture picture =
      drawn(pixels_of(cone), {.exaggeration = 1, .light = {.azimuth = 315, .altitude = 0}});
  EXPECT_GT(brightness(picture, 20, 20), 2 * brightness(picture, 39, 39));
  EXPECT_LT(brightness(picture, 39, 39), 0.9F);
}

TEST(Relief, AConeLooksTheSameMirroredAtTheDirectionOfLight) {
  const Picture picture = drawn(pixels_of(cone), {.exaggeration = 1});
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < row; ++column) {
      EXPECT_NEAR(brightness(picture, column, row), brightness(picture, row, column), 0.03);
    }
  }
}

TEST(Relief, GradientsOfAPlaneAreExactAndHighHeightsLoseNone) {
  const HeightPixels pixels =
      pixels_of([](double x, double y) { return 8848 + 0.25 * x - 0.5 * y; });
  const Gradient gradient = pixels.gradient(30, 30, 2);
  EXPECT_NEAR(gradient[0], 0.125, 1e-3);
  EXPECT_NEAR(gradient[1], 0.25, 1e-3);  // y grows northwards
}

TEST(Relief, WithoutHeightsPixelsAreTransparentAndHalfCoveredOnesHalfOpaque) {
  const HeightPixels pixels = pixels_of([](double x, double) {
    return x < 20 + 1.0 / 3 ? 5 : std::numeric_limits<double>::quiet_NaN();
  });
  const Picture picture = drawn(pixels, {});
  EXPECT_EQ(picture.opacity(19, 7), 255);
  EXPECT_EQ(picture.opacity(20, 7), 85);
  EXPECT_EQ(picture.opacity(21, 7), 0);
  EXPECT_EQ(picture.colour(20, 7), picture.colour(19, 7));  // no dark rim
}

TEST(Relief, HigherIsLighterOnLevelGround) {
  const HeightPixels pixels = pixels_of([](double x, double) { return std::floor(x / 10); });
  const Picture picture = drawn(pixels, {.exaggeration = 1e-9});
  for (std::uint32_t step = 1; step < 6; ++step) {
    EXPECT_GT(brightness(picture, 10 * step + 5, 9), brightness(picture, 10 * step - 5, 9));
  }
}

TEST(Relief, OnlyVeryFlatAndVerySteepTerrainsAreExaggerated) {
  const auto hills = [](double factor) {
    return [factor](double x, double y) { return factor * std::sin(x / 5) * std::cos(y / 5); };
  };
  const double flat = visible_exaggeration(pixels_of(hills(0.01)), 1);
  const double steep = visible_exaggeration(pixels_of(hills(100)), 1);
  EXPECT_GT(flat, 10);
  EXPECT_LT(steep, 0.1);
  EXPECT_EQ(visible_exaggeration(pixels_of(hills(2)), 1), 1);
  EXPECT_EQ(visible_exaggeration(pixels_of(hills(0)), 1), 1);
}

TEST(Relief, OutliersDoNotTakeAllColours) {
  const HeightPixels pixels =
      pixels_of([](double x, double y) { return x < 2 && y < 2 ? 100'000 : x; });
  const HeightRange range = seen_range(pixels);
  EXPECT_LT(range.highest + pixels.base(), 61);
  EXPECT_GT(range.lowest + pixels.base(), 0);
}

}  // namespace
}  // namespace spillway::test
