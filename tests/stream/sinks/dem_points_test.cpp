// Rasters of points: against plain evaluation, and against themselves made otherwise.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

double rough(double x, double y) { return 50 * std::sin(x) * std::cos(2 * y) + x; }

DemSinkOptions of_points() {
  DemSinkOptions options{.products = {DemProduct::kCount, DemProduct::kMin, DemProduct::kHeight,
                                      DemProduct::kMax, DemProduct::kPercentile, DemProduct::kMean,
                                      DemProduct::kStddev, DemProduct::kPercentile}};
  options.percentiles = {50, 95};
  options.grid = {.resolution = 3.3, .bounds = Box<2>{{5, 5}, {1500, 1200}}};
  return options;
}

/// Points of the whole range, many of them with the x and y of others.
std::vector<Point<3>> repeated_points(std::size_t count, bool whole, unsigned seed) {
  std::vector<Point<3>> points = with_heights(square_points(count, 1600, whole, seed), rough);
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < count; i += 3) {
    const Point<3>& of = points[random() % count];
    points.push_back({of[0], of[1], of[2] + static_cast<double>(random() % 100)});
  }
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

/// The heights of each pixel with points, ascending; found by comparing with every edge.
std::map<std::size_t, std::vector<double>> heights_by_pixel(const std::vector<Point<3>>& points,
                                                            const PixelGrid& grid) {
  std::vector<double> west;
  std::vector<double> south;
  for (std::uint32_t c = 1; c < grid.columns; ++c) {
    west.push_back(grid.west + c * grid.resolution);
  }
  for (std::uint32_t r = grid.rows; r-- > 1;) south.push_back(grid.north - r * grid.resolution);
  std::map<std::size_t, std::vector<double>> heights;
  for (const Point<3>& p : points) {
    if (p[0] < grid.west || p[0] > grid.west + grid.columns * grid.resolution ||
        p[1] > grid.north || p[1] < grid.north - grid.rows * grid.resolution) {
      continue;
    }
    const auto column = std::ranges::upper_bound(west, p[0]) - west.begin();
    const auto below = std::ranges::lower_bound(south, p[1]) - south.begin();
    const auto row = static_cast<std::ptrdiff_t>(grid.rows) - 1 - below;
    heights[static_cast<std::size_t>(row * grid.columns + column)].push_back(p[2]);
  }
  for (auto& [pixel, of_pixel] : heights) std::ranges::sort(of_pixel);
  return heights;
}

double percentile(const std::vector<double>& heights, double percent) {
  const double place = static_cast<double>(heights.size() - 1) * percent / 100;
  const auto low = static_cast<std::size_t>(std::floor(place));
  const std::size_t high = std::min(low + 1, heights.size() - 1);
  return heights[low] + (place - std::floor(place)) * (heights[high] - heights[low]);
}

void expect_float(float pixel, double value) {
  EXPECT_LE(std::abs(pixel - value), 1e-6 * std::max(1e-3, std::abs(value)));
}

TEST(DemOfPoints, EveryPixelTellsOfAllItsPoints) {
  for (const bool whole : {false, true}) {
    const std::vector<Point<3>> points = repeated_points(30'000, whole, 4);
    const DemSinkOptions options = of_points();
    const Rastered dem = raster_of(points, options);
    const auto heights = heights_by_pixel(points, dem.grid);
    std::uint64_t inside = 0;
    for (std::size_t i = 0; i < dem.bands[0].size(); ++i) {
      const auto found = heights.find(i);
      if (found == heights.end()) {
        EXPECT_EQ(dem.bands[0][i], 0);
        for (const std::size_t band : {1U, 3U, 4U, 5U, 6U, 7U}) {
          EXPECT_EQ(dem.bands[band][i], options.nodata);
        }
        continue;
      }
      const std::vector<double>& z = found->second;
      inside += z.size();
      double sum = 0;
      for (const double one : z) sum += one;
      const double mean = sum / static_cast<double>(z.size());
      double squares = 0;
      for (const double one : z) squares += (one - mean) * (one - mean);
      EXPECT_EQ(dem.bands[0][i], static_cast<float>(z.size()));
      EXPECT_EQ(dem.bands[1][i], static_cast<float>(z.front()));
      EXPECT_EQ(dem.bands[3][i], static_cast<float>(z.back()));
      expect_float(dem.bands[4][i], percentile(z, 50));
      expect_float(dem.bands[5][i], mean);
      expect_float(dem.bands[6][i], std::sqrt(squares / static_cast<double>(z.size())));
      expect_float(dem.bands[7][i], percentile(z, 95));
      ASSERT_FALSE(::testing::Test::HasFailure()) << "pixel " << i;
    }
    EXPECT_EQ(dem.points, inside);
    EXPECT_GT(inside, 25'000U);
    // Beside them the triangles' band is what it is alone.
    DemSinkOptions height = options;
    height.products = {DemProduct::kHeight};
    height.percentiles = {};
    EXPECT_TRUE(raster_of(points, height).bands[0] == dem.bands[2]);
  }
}

TEST(DemOfPoints, TilesThreadsAndMemoryDoNotMatter) {
  const std::vector<Point<3>> points = repeated_points(30'000, true, 8);
  DemSinkOptions options = of_points();
  options.products.push_back(DemProduct::kSlope);
  options.fill_voids = true;
  const Rastered one = raster_of(points, options);
  EXPECT_GT(one.filled, 1000U);
  for (const EngineOptions& stream :
       {EngineOptions{.threads = 2},
        EngineOptions{.asked = {.tile_points = 1500, .leaf_points = 200},
        .threads = 2,
        .buffered_points = 3000}}) {
    options.memory = stream.asked.tile_points == 0 ? 0 : std::uint64_t{12} << 20;
    const Rastered other = raster_of(points, options, stream);
    EXPECT_EQ(other.points, one.points);
    EXPECT_EQ(other.filled, one.filled);
    for (std::size_t b = 0; b < one.bands.size(); ++b) {
      EXPECT_TRUE(other.bands[b] == one.bands[b]) << b;
    }
  }
}

/// Of more equal points than a tile may have the triangulation sees one.
TEST(DemOfPoints, EqualPointsAreAllCounted) {
  std::vector<Point<3>> points = with_heights(square_points(2000, 100, false, 2), rough);
  for (int i = 0; i < 5000; ++i) points.push_back({50, 50, static_cast<double>(i)});
  DemSinkOptions options{.products = {DemProduct::kCount, DemProduct::kMax}};
  options.grid = {.resolution = 100, .bounds = Box<2>{{0, 0}, {100, 100}}};
  for (const std::size_t tile_points : {100U, 100'000U}) {
    const Rastered dem = raster_of(points, options, {.asked = {.tile_points = tile_points}});
    EXPECT_EQ(dem.bands[0], std::vector<float>{7000});
    EXPECT_EQ(dem.bands[1], std::vector<float>{4999});
  }
}

TEST(DemOfPoints, VoidsHaveTheHeightOfTheTriangleAndNothingElseHas) {
  const std::vector<Point<3>> points = with_heights(square_points(3000, 300, false, 6), rough);
  DemSinkOptions options{.products = {DemProduct::kMax, DemProduct::kCount, DemProduct::kHeight,
                                      DemProduct::kStddev, DemProduct::kPercentile}};
  options.percentiles = {10};
  options.grid = {.resolution = 2, .bounds = Box<2>{{-10, -10}, {310, 310}}};
  for (const double max_edge : {1e9, 9.0}) {
    options.fill_voids = false;
    const EngineOptions stream{.asked = {.max_edge = max_edge}};
    const Rastered plain = raster_of(points, options, stream);
    options.fill_voids = true;
    const Rastered filled = raster_of(points, options, stream);
    std::uint64_t voids = 0;
    std::uint64_t left = 0;
    for (std::size_t i = 0; i < plain.bands[0].size(); ++i) {
      const bool is_void = plain.bands[1][i] == 0;
      const float height = plain.bands[2][i];
      for (const std::size_t band : {0U, 4U}) {
        EXPECT_EQ(filled.bands[band][i], is_void ? height : plain.bands[band][i]);
      }
      for (const std::size_t band : {1U, 2U, 3U}) {
        EXPECT_EQ(filled.bands[band][i], plain.bands[band][i]);
      }
      if (is_void) ++(height == options.nodata ? left : voids);
    }
    EXPECT_EQ(filled.filled, voids);
    EXPECT_GT(voids, 1000U);
    EXPECT_GT(left, max_edge > 10 ? 1000U : 5000U);
  }
}

}  // namespace
}  // namespace spillway::test
