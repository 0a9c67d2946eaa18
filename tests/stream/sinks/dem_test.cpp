// Rasters of triangulations: against plain evaluation, and against themselves made otherwise.

#include "stream/sinks/dem.h"

#include <spillway/dem.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "src/error.h"
#include "src/geometry/predicates.h"
#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

double rough(double x, double y) { return 50 * std::sin(x) * std::cos(2 * y) + x; }

TEST(Dem, EveryPixelIsWhatThePlaneOfItsTriangleSays) {
  for (const bool whole : {false, true}) {
    const auto points = square_points(300, 40, whole, 11);
    DemSinkOptions options;
    options.grid = {.resolution = 0.5};
    const Rastered dem = raster_of(with_heights(points, rough), options);
    const auto triangles = triangles_of(points, rough);
    std::uint64_t with_data = 0;
    for (std::uint32_t row = 0; row < dem.grid.rows; ++row) {
      for (std::uint32_t column = 0; column < dem.grid.columns; ++column) {
        const Point<2> p{dem.grid.centre_x(column), dem.grid.centre_y(row)};
        std::optional<double> height;
        for (const Triangle& t : triangles) {
          if (edges_touched(t, p) < 0) continue;
          const double area =
              (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[2][0] - t[0][0]) * (t[1][1] - t[0][1]);
          double sum = 0;
          for (int i = 0; i < 3; ++i) {
            const Point<3>& a = t[(i + 1) % 3];
            const Point<3>& b = t[(i + 2) % 3];
            sum += t[i][2] * ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / area;
          }
          height = sum;
        }
        const float pixel = dem.bands[0][std::size_t{row} * dem.grid.columns + column];
        if (height) {
          ++with_data;
          EXPECT_NEAR(pixel, *height, 1e-5) << row << ", " << column;
        } else {
          EXPECT_EQ(pixel, options.nodata) << row << ", " << column;
        }
      }
    }
    EXPECT_EQ(dem.with_data, with_data);
    EXPECT_GT(with_data, 1000U);
  }
}

TEST(Dem, TilesThreadsAndLeavesDoNotMatter) {
  for (const bool whole : {false, true}) {
    // More than one tile of pixels each way, many of them on vertices and edges if `whole`.
    const auto points = with_heights(square_points(20'000, 300, whole, 3), rough);
    DemSinkOptions options = kAllProducts;
    options.grid = {.resolution = 0.5, .bounds = Box<2>{{-0.25, -0.25}, {300.25, 300.25}}};
    const Rastered one = raster_of(points, options);
    for (const EngineOptions& stream :
         {EngineOptions{.threads = 2}, EngineOptions{.asked = {.leaf_points = 100}, .threads = 1},
          EngineOptions{.asked = {.tile_points = 1500, .leaf_points = 200},
          .threads = 2,
          .buffered_points = 3000}}) {
      const Rastered other = raster_of(points, options, stream);
      EXPECT_EQ(other.grid, one.grid);
      for (std::size_t b = 0; b < one.bands.size(); ++b) {
        EXPECT_EQ(other.bands[b], one.bands[b]) << dem_product_names()[b];
      }
    }
  }
}

/// Centres on edges and vertices, level ground, nodata beyond the hull, holes, tiles cut off by the
/// raster's edges: with closed tiles all is as without.
TEST(Dem, TilesThatAreClosedDoNotMatter) {
  for (const bool whole : {false, true}) {
    const auto points = with_heights(square_points(20'000, 700, whole, 5),
                                     [](double x, double y) { return x < 300 ? 1 : rough(x, y); });
    DemSinkOptions options{.products = {DemProduct::kHeight, DemProduct::kFacetSlope,
                                        DemProduct::kFacetAspect, DemProduct::kFacetHillshade}};
    options.grid = {.resolution = 0.5, .bounds = Box<2>{{20, -50}, {700, 650}}};
    for (const double max_edge : {1000.0, 22.0}) {
      EngineOptions stream{.asked = {.max_edge = max_edge}};
      options.closes_tiles = false;
      options.memory = 0;
      const Rastered open = raster_of(points, options, stream);
      EXPECT_EQ(open.closed, 0U);
      options.closes_tiles = true;
      for (const unsigned threads : {1U, 2U, 4U}) {
        stream.threads = threads;
        stream.asked.tile_points = 1500;
        options.memory = threads == 2 ? kMemory : 2 * RasterStore::least_memory(4, threads);
        const Rastered closed = raster_of(points, options, stream);
        EXPECT_GT(closed.closed, max_edge > 100 ? 15U : 0U);
        EXPECT_LT(closed.closed, 36U);
        EXPECT_EQ(closed.with_data, open.with_data);
        for (std::size_t b = 0; b < open.bands.size(); ++b) {
          EXPECT_TRUE(closed.bands[b] == open.bands[b]) << dem_product_names()[b];
        }
      }
    }
  }
}

/// Vertices of a pixel may come after all of the triangles at its centre.
TEST(Dem, TilesWithDensitiesAreNotClosed) {
  DemSinkOptions options = kAllProducts;
  options.grid = {.resolution = 0.5, .bounds = Box<2>{{10, 10}, {290, 290}}};
  options.closes_tiles = true;
  const auto points = with_heights(square_points(20'000, 300, false, 6), rough);
  EXPECT_EQ(raster_of(points, options).closed, 0U);
}

TEST(Dem, TheOrderOfTrianglesDoesNotMatter) {
  const auto points = square_points(400, 20, true, 8);
  auto triangles = triangles_of(points, rough);
  const PixelGrid grid{-0.25, 20.25, 0.5, 41, 41};
  const Rastered one = raster_of(triangles, grid, kAllProducts);
  std::reverse(triangles.begin(), triangles.end());
  for (Triangle& triangle : triangles)
    std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
  EXPECT_EQ(raster_of(triangles, grid, kAllProducts).bands, one.bands);
  for (Triangle& triangle : triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(raster_of(triangles, grid, kAllProducts).bands, one.bands) << "turned over";
}

TEST(Dem, TheHullBelongsToTheRaster) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 25; ++i) points.push_back({i % 5 * 1.0, i / 5 * 1.0});
  DemSinkOptions options = kAllProducts;
  options.grid = {.resolution = 1, .bounds = Box<2>{{-0.5, -0.5}, {4.5, 4.5}}};
  const Rastered dem =
      raster_of(with_heights(points, [](double x, double y) { return x + y; }), options);
  EXPECT_EQ(dem.with_data, 25U);
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(dem.bands[0][i], static_cast<float>(i % 5 + 4 - i / 5));
    EXPECT_NEAR(dem.bands[1][i], std::atan(std::sqrt(2.0)) * 180 / M_PI, 1e-5);
    EXPECT_EQ(dem.bands[2][i], 225);
    EXPECT_EQ(dem.bands[4][i], 1);
  }
}

TEST(Dem, LevelGroundHasNoAspect) {
  DemSinkOptions options = kAllProducts;
  options.grid = {.resolution = 0.5};
  const Rastered dem = raster_of(
      with_heights(square_points(50, 10, true, 2), [](double, double) { return 7; }), options);
  for (std::size_t i = 0; i < dem.bands[0].size(); ++i) {
    EXPECT_EQ(dem.bands[2][i], options.nodata);
    if (dem.bands[0][i] != options.nodata) {
      EXPECT_EQ(dem.bands[0][i], 7);
      EXPECT_EQ(dem.bands[1][i], 0);
    }
  }
}

TEST(Dem, DensityCountsEveryVertexOnce) {
  DemSinkOptions options{.products = {DemProduct::kDensity}};
  options.grid = {.resolution = 3};
  const auto points = with_heights(square_points(5000, 90, false, 4), rough);
  const Rastered dem = raster_of(points, options, {.asked = {.tile_points = 700}, .threads = 2});
  double sum = 0;
  for (const float pixel : dem.bands[0]) sum += pixel;
  EXPECT_EQ(sum, 5000);
}

TEST(Dem, LongEdgesLeaveNoData) {
  // Two patches far apart.
  auto points = square_points(400, 10, false, 6);
  for (std::size_t i = 0; i < points.size(); i += 2) points[i][0] += 100;
  DemSinkOptions options;
  options.grid = {.resolution = 1, .bounds = Box<2>{{0, 0}, {110, 10}}};
  const Rastered dem =
      raster_of(with_heights(points, rough), options, {.asked = {.max_edge = 20.0}});
  for (std::uint32_t column = 20; column < 90; ++column) {
    EXPECT_EQ(dem.bands[0][5 * dem.grid.columns + column], options.nodata);
  }
  EXPECT_GT(dem.with_data, 100U);
  options.max_edge = 20;  // the same of a mesh
  EXPECT_EQ(raster_of(triangles_of(points, rough), dem.grid, options).bands, dem.bands);
}

/// Whether GDAL takes a float for nodata: its ARE_REAL_EQUAL().
bool gdal_takes_for_nodata(float value, float nodata) {
  return value == nodata || std::abs(value - nodata) < std::numeric_limits<float>::epsilon() *
                                                           std::abs(value + nodata) * 2;
}

TEST(Dem, WhatWouldBeTakenForNodataIsMovedByAFewStepsOfAFloat) {
  Random random(3);
  std::vector<float> values = {7, -9999, 0.1F, 1e-44F, -1e-40F, 1, -1, 65536, 1e30F};
  for (int i = 0; i < 200; ++i) values.push_back(static_cast<float>(random.uniform(-1e4, 1e4)));
  const PixelGrid grid{0, 8, 1, 8, 8};
  for (const float nodata : values) {
    for (const float height :
         {nodata, std::nextafter(nodata, -INFINITY), std::nextafter(nodata, INFINITY)}) {
      const double z = height;
      DemSinkOptions options{.nodata = nodata};
      const Rastered dem =
          raster_of({Triangle{{{-9, -9, z}, {99, -9, z}, {-9, 99, z}}}}, grid, options);
      EXPECT_EQ(dem.with_data, 64U);
      for (const float pixel : dem.bands[0]) {
        ASSERT_FALSE(gdal_takes_for_nodata(pixel, nodata)) << nodata;
        ASSERT_NEAR(pixel, nodata, 1e-6 * std::abs(nodata) + 1e-44);
      }
    }
  }
}

TEST(Dem, ZerosOfAllProductsAreToldFromANodataOfZero) {
  DemSinkOptions options = kAllProducts;
  options.light.altitude = 0;
  options.nodata = 0;
  const Rastered dem = raster_of({Triangle{{{-9, -9, -0.0}, {99, -9, 0}, {-9, 99, -0.0}}}},
                                 {0, 8, 1, 8, 8}, options);
  for (std::size_t b = 0; b < 5; ++b) {
    const float expected = b == 2 ? 0.0F : std::numeric_limits<float>::denorm_min();  // level
    EXPECT_THAT(dem.bands[b], ::testing::Each(expected)) << dem_product_names()[b];
  }
}

TEST(Dem, ZerosHaveNoSign) {
  DemSinkOptions options = kAllProducts;
  options.light.altitude = 0;
  const Rastered dem = raster_of({Triangle{{{-9, -9, -0.0}, {99, -9, 0}, {-9, 99, -0.0}}}},
                                 {0, 8, 1, 8, 8}, options);
  for (const std::vector<float>& band : dem.bands) {
    for (const float pixel : band) EXPECT_TRUE(pixel == -9999 || !std::signbit(pixel));
  }
}

TEST(Dem, NodataOfTheLargestFloatLeavesHeightsFinite) {
  const float most = std::numeric_limits<float>::max();
  const double z = most;
  const Rastered dem = raster_of({Triangle{{{-9, -9, z}, {99, -9, z}, {-9, 99, z}}}},
                                 {0, 8, 1, 8, 8}, {.nodata = most});
  EXPECT_THAT(dem.bands[0], ::testing::Each(::testing::Lt(most)));
}

TEST(Dem, PixelsAreCountedOnceAndNoneBesideTheRaster) {
  for (const auto& [columns, rows] : {std::pair{200U, 200U}, {256U, 256U}, {300U, 520U}}) {
    DemSinkOptions options = kAllProducts;
    options.memory = kMemory;
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    Dem dem(options, std::nullopt, *scratch);
    dem.begin(PixelGrid{0, 0, 1, columns, rows});
    KeepingRaster raster(dem.grid(), options.products.size());
    std::vector<std::uint64_t> counts;
    dem.write(raster, [&](std::uint64_t pixels) { counts.push_back(pixels); });
    EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end()));
    EXPECT_EQ(counts.back(), std::uint64_t{columns} * rows);
  }
}

TEST(Dem, PixelsThatDoNotFitIntoMemoryGoToTheDiskAndComeBack) {
  const auto points = with_heights(square_points(3000, 1500, false, 5), rough);
  DemSinkOptions options{
      .products = {DemProduct::kHeight, DemProduct::kFacetSlope, DemProduct::kDensity}};
  options.grid = {.resolution = 1};
  const Rastered one = raster_of(points, options);
  EXPECT_EQ(one.spilled, 0U);
  options.memory = RasterStore::least_memory(3, 1) + (1U << 20);
  const Rastered small =
      raster_of(points, options, {.asked = {.tile_points = 300, .leaf_points = 50}});
  EXPECT_GT(small.spilled, options.memory / 4);
  EXPECT_EQ(small.bands, one.bands);
}

TEST(Dem, TooLittleMemoryAndTooLargeARasterAreRefused) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  EXPECT_THROW(Dem({.memory = 1000}, std::nullopt, *scratch), InvalidArgument);
  Dem dem({.grid = {.resolution = 1e-6}, .memory = kMemory}, std::nullopt, *scratch);
  EXPECT_THROW(dem.begin(Box<2>{{0, 0}, {1000, 1000}}), InvalidArgument);
}

TEST(RasterStore, PreferredValuesWinOverOthersInAnyOrder) {
  for (const auto& order : {std::vector{0, 1, 2}, std::vector{2, 1, 0}, std::vector{1, 0, 2}}) {
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    RasterStore store({PixelRule::kPreferred}, std::uint64_t{8} << 20, *scratch);
    {
      RasterStore::Hand hand(store);
      float* const pixels = hand.tile(0);
      for (const int i : order) {
        put_pixel(pixels[0], 5.0F - static_cast<float>(i), PixelRule::kPreferred, i == 1);
        put_pixel(pixels[1], static_cast<float>(i), PixelRule::kPreferred, false);
      }
    }
    std::vector<float> pixels;
    store.take(0, pixels);
    EXPECT_EQ(pixels[0], 4);
    EXPECT_EQ(pixels[1], 0);
    EXPECT_TRUE(std::isnan(pixels[2]));
  }
}

TEST(RasterStore, ZerosOfEitherSignAreZerosPreferredOrNot) {
  for (const float zero : {0.0F, -0.0F}) {
    for (const bool preferred_first : {false, true}) {
      const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
      RasterStore store({PixelRule::kPreferred}, std::uint64_t{8} << 20, *scratch);
      {
        RasterStore::Hand hand(store);
        float* const pixels = hand.tile(0);
        for (const bool preferred : {preferred_first, !preferred_first}) {
          put_pixel(pixels[0], preferred ? 66.0F : zero, PixelRule::kPreferred, preferred);
          put_pixel(pixels[1], preferred ? zero : 66.0F, PixelRule::kPreferred, preferred);
          put_pixel(pixels[2], preferred ? 66.0F : zero, PixelRule::kPreferred, false);
        }
      }
      std::vector<float> pixels;
      store.take(0, pixels);
      EXPECT_EQ(pixels[0], 66);
      EXPECT_EQ(pixels[1], 0);
      EXPECT_EQ(pixels[2], 0);
      EXPECT_FALSE(std::signbit(pixels[1]) || std::signbit(pixels[2]));
    }
  }
}

TEST(RasterStore, SumsStopAtTheSameValueInOneStoreAndInMany) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  RasterStore store({PixelRule::kSum}, std::uint64_t{8} << 20, *scratch);
  RasterStore other({PixelRule::kSum}, std::uint64_t{8} << 20, *scratch);
  for (RasterStore* const one : {&store, &other}) {
    RasterStore::Hand hand(*one);
    for (int i = 0; i < 3; ++i) put_pixel(hand.tile(0)[0], 0x1.8p23F, PixelRule::kSum, true);
  }
  std::vector<float> pixels;
  const std::vector<std::vector<std::byte>> others = {other.take_tile(0)};
  store.take(0, pixels, others);
  EXPECT_EQ(pixels[0], 0x1p24F);
}

TEST(RasterStore, AFullDiskIsAnError) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 10'000);
  RasterStore store({PixelRule::kSum}, RasterStore::least_memory(1, 1), *scratch);
  RasterStore::Hand hand(store);
  EXPECT_THROW(
      {
        for (std::uint64_t tile = 0; tile < 1000; ++tile) {
          float* const pixels = hand.tile(tile);
          std::fill_n(pixels, RasterStore::kTilePixels, static_cast<float>(tile));
        }
      },
      Failure);
}

}  // namespace
}  // namespace spillway::test
