// Which pixels lie in polygons, against exact arithmetic.

#include "src/terrain/polygon_pixels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

using Ring = std::vector<Point<2>>;

/// Centres are whole numbers, so that determinants are exact.
constexpr PixelGrid kGrid{-0.5, 40.5, 1, 41, 41};

/// By the even-odd rule: edges that cross the row west of the centre, or at it.
bool is_inside(const std::vector<Ring>& rings, std::int64_t x, std::int64_t y) {
  bool inside = false;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Point<2> low = ring[i];
      Point<2> high = ring[(i + 1) % ring.size()];
      if (low[1] > high[1]) std::swap(low, high);
      const auto at = [](double number) { return static_cast<std::int64_t>(number); };
      if (at(low[1]) > y || at(high[1]) <= y) continue;
      const std::int64_t rise = at(high[1]) - at(low[1]);
      if (at(low[0]) * rise + (y - at(low[1])) * (at(high[0]) - at(low[0])) <= x * rise) {
        inside = !inside;
      }
    }
  }
  return inside;
}

/// Row by row; 1 for those in it.
std::vector<int> pixels_of(const std::vector<Ring>& rings) {
  const PolygonPixels polygon(rings, kGrid);
  std::vector<int> pixels(std::size_t{kGrid.rows} * kGrid.columns);
  const PixelWindow& window = polygon.window();
  for (std::uint32_t row = window.row_begin; row < window.row_end; ++row) {
    std::uint32_t last = 0;
    for (const auto& [begin, end] : polygon.row(row)) {
      EXPECT_TRUE(last == 0 || last < begin);
      EXPECT_LT(begin, end);
      EXPECT_GE(begin, window.column_begin);
      EXPECT_LE(end, window.column_end);
      for (std::uint32_t c = begin; c < end; ++c) ++pixels[row * kGrid.columns + c];
      last = end;
    }
    for (std::uint32_t c = 0; c < kGrid.columns; ++c) {
      EXPECT_EQ(polygon.has(row, c), pixels[row * kGrid.columns + c] == 1);
    }
  }
  return pixels;
}

TEST(PolygonPixels, AreThoseWhoseCentresLieInThePolygonByExactArithmetic) {
  std::mt19937 random(1);
  std::size_t inside = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<Ring> rings(1 + random() % 2);
    for (Ring& ring : rings) {
      ring.resize(3 + random() % 5);
      // On whole numbers, edges pass through centres; slopes are powers of two or roundings matter.
      for (Point<2>& p : ring) p = {double(random() % 16) * 4 - 8, double(random() % 4) * 16 - 8};
    }
    const std::vector<int> pixels = pixels_of(rings);
    for (std::uint32_t row = 0; row < kGrid.rows; ++row) {
      for (std::uint32_t column = 0; column < kGrid.columns; ++column) {
        const bool expected = is_inside(rings, column, std::int64_t{40} - row);
        ASSERT_EQ(pixels[row * kGrid.columns + column], expected ? 1 : 0)
            << run << ": " << column << ", " << 40 - row;
        inside += expected ? 1 : 0;
      }
    }
  }
  EXPECT_GT(inside, 50'000U);
}

TEST(PolygonPixels, OfNeighboursAreEachInOneOfThem) {
  std::mt19937 random(2);
  for (int run = 0; run < 50; ++run) {
    // A fan around a point, with corners on all sides beyond the raster.
    const Point<2> middle = {5 + 30 * std::generate_canonical<double, 53>(random),
                             double(5 + random() % 30)};
    const Ring around = {{-9, -9}, {20.3, -9}, {50, -9}, {50, 17.7},
                         {50, 50}, {20, 50},   {-9, 50}, {-9, 20}};
    std::vector<int> covered(std::size_t{kGrid.rows} * kGrid.columns);
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::vector<int> pixels =
          pixels_of({{middle, around[i], around[(i + 1) % around.size()]}});
      for (std::size_t p = 0; p < pixels.size(); ++p) covered[p] += pixels[p];
    }
    ASSERT_EQ(covered, std::vector<int>(covered.size(), 1)) << run;
  }
}

TEST(PolygonPixels, OfWhatLiesBesideTheRasterAreNone) {
  for (const Ring& ring :
       {Ring{{100, 0}, {110, 0}, {110, 10}}, Ring{{0.1, 0.1}, {0.2, 0.2}, {0.1, 0.3}},
        Ring{{1, 1}, {5, 1}}, Ring{}}) {
    EXPECT_TRUE(PolygonPixels(std::vector<Ring>{ring}, kGrid).window().empty());
  }
}

}  // namespace
}  // namespace spillway::test
