#include "src/picture/tilted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "src/error.h"

namespace spillway::test {
namespace {

constexpr std::uint32_t kSide = 80;
constexpr double kDegree = std::numbers::pi / 180;

using Height = std::function<double(double column, double row)>;

/// A field of pixels of side 1, heights as they are; where a height is not a number there is none.
HeightField field_of(const Height& height) {
  HeightPixels pixels(kSide, kSide);
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const double z = height(column, row);
      if (std::isnan(z)) continue;
      pixels.add(column * HeightPixels::kSamples, row * HeightPixels::kSamples,
                 static_cast<float>(z));
    }
  }
  return {pixels, 1, 1};
}

double hill(double column, double row) {
  return 12 * std::exp(-(std::pow(column - 45, 2) + std::pow(row - 30, 2)) / 300);
}

/// A map whose colours tell where they are.
Picture map_of_places() {
  Picture map(kSide, kSide);
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      map.set(column, row,
              {static_cast<float>(column) / kSide, static_cast<float>(row) / kSide, 0.25F}, 1);
    }
  }
  return map;
}

TEST(HeightField, IsBilinearBetweenNodesAndEndsAtThem) {
  const HeightField field = field_of([](double c, double r) { return 100 + 2 * c + 3 * r; });
  EXPECT_NEAR(field.top(), 5 * 79, 1e-3);
  EXPECT_NEAR(field.height(10.25, 20.5), 2 * 10.25 + 3 * 20.5, 1e-3);
  EXPECT_NEAR(field.height(79, 79), 5 * 79, 1e-3);
  EXPECT_TRUE(std::isnan(field.height(79.1, 5)));
  EXPECT_TRUE(std::isnan(field.height(5, -0.1)));
}

TEST(HeightField, HasNoHeightBesideNodesWithoutOne) {
  const HeightField field =
      field_of([](double c, double r) { return c == 40 && r == 40 ? NAN : c + r; });
  EXPECT_TRUE(std::isnan(field.height(39.5, 39.5)));
  EXPECT_TRUE(std::isnan(field.height(40.5, 40.5)));
  EXPECT_FALSE(std::isnan(field.height(38.5, 40.5)));
}

TEST(HeightField, KnowsWhatIsNear) {
  const HeightField field = field_of([](double c, double r) { return c == 33 && r == 50 ? 9 : 0; });
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const double most = field.most_near(column, row);
      const double away = std::max(std::abs(column - 33.0), std::abs(row - 50.0));
      if (away <= HeightField::kReach) {
        EXPECT_EQ(most, 9) << column << ' ' << row;
      } else if (away > 2 * HeightField::kReach) {
        EXPECT_EQ(most, 0) << column << ' ' << row;
      }
    }
  }
}

/// A tower of height 10 in columns and rows 40 to 43, on a plain.
double tower(double column, double row) {
  return std::min({column, row}) >= 40 && std::max({column, row}) < 44 ? 10 : 0;
}

TEST(CastShadows, AreAsLongAsTheLightIsLow) {
  const HeightField field = field_of(tower);
  for (const double altitude : {20.0, 30.0, 45.0, 60.0}) {
    // Light from the south, so that the shadow falls to the north: to lower rows.
    const auto shadows = cast_shadows(field, {180, altitude});
    const double end = 39.5 - 10 / std::tan(altitude * kDegree);
    for (std::uint32_t row = 0; row < kSide; ++row) {
      const int shadow = shadows[std::size_t{row} * kSide + 41];
      if (row > end + 2 && row < 39) {
        EXPECT_EQ(shadow, 255) << altitude << ' ' << row;
      } else if (row < end - 2 || row > 44) {
        EXPECT_EQ(shadow, 0) << altitude << ' ' << row;
      }
      EXPECT_EQ(shadows[std::size_t{row} * kSide + 50], 0) << "beside";
    }
  }
}

TEST(CastShadows, FallAwayFromTheLight) {
  const HeightField field = field_of(tower);
  const auto in_shadow = [&](double azimuth, std::uint32_t column, std::uint32_t row) {
    return cast_shadows(field, {azimuth, 40})[std::size_t{row} * kSide + column] > 0;
  };
  EXPECT_TRUE(in_shadow(90, 36, 41));  // from the east: to the west
  EXPECT_FALSE(in_shadow(90, 47, 41));
  EXPECT_TRUE(in_shadow(315, 47, 47));  // from the north west: to the south east
  EXPECT_FALSE(in_shadow(315, 36, 36));
}

TEST(CastShadows, OfALightAlongAnEdgeFallOnTheEdge) {
  const auto wall = [](double column, double row) {
    return std::max(column, row) >= kSide - 3 ? 10.0 : 0.0;  // in the east and the south
  };
  const HeightField field = field_of(wall);
  const auto from_the_east = cast_shadows(field, {90, 30});
  for (std::uint32_t row = 0; row < 10; ++row) {
    EXPECT_EQ(from_the_east[std::size_t{row} * kSide + kSide - 6], 255) << row;
  }
  const auto from_the_south = cast_shadows(field, {180, 30});
  for (std::uint32_t column = 0; column < 10; ++column) {
    EXPECT_EQ(from_the_south[std::size_t{kSide - 6} * kSide + column], 255) << column;
  }
}

TEST(CastShadows, OfALightOverheadThereAreNone) {
  const auto shadows = cast_shadows(field_of(tower), {0, 90});
  EXPECT_EQ(std::ranges::count(shadows, 0), kSide * kSide);
}

/// Where places are seen, by two rotations: about the vertical until one looks from the south, and
/// then tipped.
struct Camera {
  double azimuth;
  double elevation;

  [[nodiscard]] Point<2> seen(double column, double row, double z) const {
    const double middle = (kSide - 1) / 2.0;
    const double turn = (azimuth - 180) * kDegree;  // counter-clockwise
    const double east = column - middle;
    const double north = middle - row;
    const double right = east * std::cos(turn) - north * std::sin(turn);
    const double away = east * std::sin(turn) + north * std::cos(turn);
    return {right, away * std::sin(elevation * kDegree) + z * std::cos(elevation * kDegree)};
  }
};

TEST(Tilted, EveryPlaceOfAHillIsWhereItShouldBe) {
  const Picture map = map_of_places();
  const HeightField field = field_of(hill);
  for (const Camera camera : {Camera{180, 90}, Camera{180, 50}, Camera{90, 60}, Camera{225, 55}}) {
    const Picture view = draw_tilted(map, field, {camera.azimuth, camera.elevation, 400, 5});
    Point<2> lo = {1e9, 1e9};
    Point<2> hi = {-1e9, -1e9};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      for (const double z : {0.0, static_cast<double>(field.node(i))}) {
        const std::uint32_t row = i / kSide;
        const Point<2> place = camera.seen(i % kSide, row, z);
        for (int k = 0; k < 2; ++k) {
          lo[k] = std::min(lo[k], place[k]);
          hi[k] = std::max(hi[k], place[k]);
        }
      }
    }
    ASSERT_EQ(std::max(view.columns(), view.rows()), 400U);
    const double scale = 390 / std::max(hi[0] - lo[0], hi[1] - lo[1]);
    for (std::uint32_t row = 2; row < kSide - 2; row += 3) {
      for (std::uint32_t column = 2; column < kSide - 2; column += 3) {
        const Point<2> place =
            camera.seen(column, row, field.node(std::size_t{row} * kSide + column));
        const Colour seen = view.colour(static_cast<std::uint32_t>((place[0] - lo[0]) * scale + 5),
                                        static_cast<std::uint32_t>((hi[1] - place[1]) * scale + 5));
        EXPECT_NEAR(seen[0] * kSide, column, 1) << camera.azimuth << ' ' << camera.elevation;
        EXPECT_NEAR(seen[1] * kSide, row, 1) << camera.azimuth << ' ' << camera.elevation;
      }
    }
  }
}

TEST(Tilted, WhatStandsInFrontHidesWhatIsBehind) {
  const Picture map = map_of_places();
  const Picture view = draw_tilted(map, field_of(tower), {180, 30, 400, 0});
  // From the south at 30 degrees the tower hides 10 / tan(30) = 17 rows behind it.
  int seen = 0;
  int hidden = 0;
  for (std::uint32_t row = 0; row < view.rows(); ++row) {
    for (std::uint32_t column = 0; column < view.columns(); ++column) {
      if (view.opacity(column, row) < 255) continue;
      const Colour colour = view.colour(column, row);
      const double map_column = colour[0] * kSide;
      const double map_row = colour[1] * kSide;
      if (std::abs(map_column - 41.5) > 1) continue;
      if (map_row > 25 && map_row < 38) ++hidden;
      if (map_row > 2 && map_row < 20) ++seen;
    }
  }
  EXPECT_GT(seen, 200);
  EXPECT_LE(hidden, 15)
      << "but for a row of pixels that are half of its top, half of what is behind";
}

TEST(Tilted, WhereTheTerrainEndsItIsCutDownToItsLowestPlace) {
  Picture map(kSide, kSide);
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) map.set(i % kSide, i / kSide, kWhite, 1);
  // A plain of height 20, with a lower place in the north, seen from the south.
  const Picture view = draw_tilted(
      map, field_of([](double, double row) { return row < 3 ? 0 : 20; }), {180, 45, 400, 0});
  const double scale = 400 / (kSide - 1.0);
  const auto wall = static_cast<std::uint32_t>(20 * std::cos(45 * kDegree) * scale);
  EXPECT_LT(view.colour(200, view.rows() - wall / 2)[0], 0.6F);
  EXPECT_EQ(view.opacity(200, view.rows() - wall / 2), 255);
  EXPECT_EQ(view.colour(200, view.rows() - wall - 4)[0], 1.0F);
  EXPECT_LT(view.colour(200, view.rows() - wall + 4)[0], 0.6F);
}

TEST(Tilted, HolesAreSeenThrough) {
  const Picture map = map_of_places();
  const auto with_hole = [](double c, double r) {
    return std::hypot(c - 40, r - 40) < 12 ? NAN : 0.0;
  };
  const Picture view = draw_tilted(map, field_of(with_hole), {180, 90, 400, 0});
  EXPECT_EQ(view.opacity(202, 202), 0);
  EXPECT_EQ(view.opacity(50, 50), 255);
}

TEST(Tilted, OfOnePixelThereIsNothingToSee) {
  const auto one = [](double c, double r) { return c == 40 && r == 40 ? 1.0 : NAN; };
  EXPECT_THROW(draw_tilted(map_of_places(), field_of(one), {180, 90, 400, 0}), Failure);
}

}  // namespace
}  // namespace spillway::test
