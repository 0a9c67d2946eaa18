// Rasters of triangulations: against plain evaluation, and against themselves made otherwise.

#include "stream/dem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "src/error.h"
#include "src/geometry/predicates.h"
#include "stream/dem_writer.h"
#include "tests/stream/stream_runner.h"
#include "tests/terrain/terrain_mesh.h"

namespace spillway {
namespace {

using testing::edges_touched;
using testing::square_points;
using testing::triangles_of;

constexpr std::uint64_t kMemory = std::uint64_t{64} << 20;

/// Keeps what is written, band by band.
class KeepingRaster : public Raster {
 public:
  KeepingRaster(const PixelGrid& grid, std::size_t count)
      : grid_(grid), bands(count, std::vector<float>(std::size_t{grid.columns} * grid.rows)) {}

  void write_tile(std::size_t band, std::uint32_t tile_column, std::uint32_t tile_row,
                  std::span<const float> pixels) override {
    ASSERT_EQ(pixels.size(), RasterStore::kTilePixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t column = tile_column * kRasterTile + i % kRasterTile;
      const std::size_t row = tile_row * kRasterTile + i / kRasterTile;
      if (column < grid_.columns && row < grid_.rows) {
        bands[band][row * grid_.columns + column] = pixels[i];
      }
    }
  }
  void finish() override {}

 private:
  PixelGrid grid_;

 public:
  std::vector<std::vector<float>> bands;
};

struct Rastered {
  PixelGrid grid;
  std::vector<std::vector<float>> bands;
  std::uint64_t with_data = 0;
  std::uint64_t spilled = 0;
};

Rastered finished(Dem& dem, const DemOptions& options) {
  KeepingRaster raster(dem.grid(), options.products.size());
  dem.write(raster, [](std::uint64_t) {});
  return {dem.grid(), std::move(raster.bands), dem.pixels_with_data(), dem.spilled_bytes()};
}

/// Points through the whole pipeline.
Rastered raster_of(const std::vector<Point<3>>& points, DemOptions options,
                   StreamOptions stream = {}) {
  if (options.memory == 0) options.memory = kMemory;
  options.threads = stream.threads;
  const std::string path = write_points<3>(points);
  PointSource source(disk(), {path}, {.dimension = 2});
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  MemoryBudget budget(kMemory);
  Dem dem(options, source.lattice(), *scratch);
  stream.extent_known = [&dem](const Box<2>& extent, std::uint64_t) { dem.begin(extent); };
  DemWriter writer(dem);
  (void)triangulate_stream<2>(source, writer, *scratch, budget, stream);
  return finished(dem, options);
}

/// Triangles as they are, without any pipeline.
Rastered raster_of(const std::vector<Triangle>& triangles, const PixelGrid& grid,
                   DemOptions options) {
  options.memory = kMemory;
  options.grid.given = grid;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  Dem dem(options, std::nullopt, *scratch);
  dem.begin(Box<2>{});
  std::vector<Point<3>> vertices;
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : triangles) {
    for (const Point<3>& corner : triangle) {
      corners.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(corner);
    }
  }
  dem.paint(vertices, corners);
  return finished(dem, options);
}

std::vector<Point<3>> with_heights(const std::vector<Point<2>>& points,
                                   const testing::HeightOf& height) {
  std::vector<Point<3>> result;
  for (const Point<2>& p : points) result.push_back({p[0], p[1], height(p[0], p[1])});
  return result;
}

double rough(double x, double y) { return 50 * std::sin(x) * std::cos(2 * y) + x; }

const DemOptions kAllProducts{.products = {DemProduct::kHeight, DemProduct::kSlope,
                                           DemProduct::kAspect, DemProduct::kHillshade,
                                           DemProduct::kDensity}};

TEST(Dem, EveryPixelIsWhatThePlaneOfItsTriangleSays) {
  for (const bool whole : {false, true}) {
    const auto points = square_points(300, 40, whole, 11);
    DemOptions options;
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
    DemOptions options = kAllProducts;
    options.grid = {.resolution = 0.5, .bounds = Box<2>{{-0.25, -0.25}, {300.25, 300.25}}};
    const Rastered one = raster_of(points, options);
    for (const StreamOptions& stream :
         {StreamOptions{.threads = 2}, StreamOptions{.threads = 1, .leaf_size = 100},
          StreamOptions{
              .threads = 2, .tile_capacity = 1500, .buffered_points = 3000, .leaf_size = 200}}) {
      const Rastered other = raster_of(points, options, stream);
      EXPECT_EQ(other.grid, one.grid);
      for (std::size_t b = 0; b < one.bands.size(); ++b) {
        EXPECT_EQ(other.bands[b], one.bands[b]) << dem_product_names()[b];
      }
    }
  }
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
  DemOptions options = kAllProducts;
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
  DemOptions options = kAllProducts;
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
  DemOptions options{.products = {DemProduct::kDensity}};
  options.grid = {.resolution = 3};
  const auto points = with_heights(square_points(5000, 90, false, 4), rough);
  const Rastered dem = raster_of(points, options, {.threads = 2, .tile_capacity = 700});
  double sum = 0;
  for (const float pixel : dem.bands[0]) sum += pixel;
  EXPECT_EQ(sum, 5000);
}

TEST(Dem, LongEdgesLeaveNoData) {
  // Two patches far apart.
  auto points = square_points(400, 10, false, 6);
  for (std::size_t i = 0; i < points.size(); i += 2) points[i][0] += 100;
  DemOptions options;
  options.grid = {.resolution = 1, .bounds = Box<2>{{0, 0}, {110, 10}}};
  const Rastered dem = raster_of(with_heights(points, rough), options, {.max_edge = 20.0});
  for (std::uint32_t column = 20; column < 90; ++column) {
    EXPECT_EQ(dem.bands[0][5 * dem.grid.columns + column], options.nodata);
  }
  EXPECT_GT(dem.with_data, 100U);
  options.max_edge = 20;  // the same of a mesh
  EXPECT_EQ(raster_of(triangles_of(points, rough), dem.grid, options).bands, dem.bands);
}

TEST(Dem, AHeightThatEqualsNodataIsMovedByTheLeastBit) {
  DemOptions options{.nodata = 7};
  options.grid = {.resolution = 1};
  const Rastered dem = raster_of(
      with_heights(square_points(50, 10, true, 2), [](double, double) { return 7; }), options);
  EXPECT_GT(dem.with_data, 10U);
  EXPECT_EQ(std::count(dem.bands[0].begin(), dem.bands[0].end(), std::nextafter(7.0F, 8.0F)),
            static_cast<std::ptrdiff_t>(dem.with_data));
}

TEST(Dem, PixelsThatDoNotFitIntoMemoryGoToTheDiskAndComeBack) {
  const auto points = with_heights(square_points(3000, 1500, false, 5), rough);
  DemOptions options{.products = {DemProduct::kHeight, DemProduct::kSlope, DemProduct::kDensity}};
  options.grid = {.resolution = 1};
  const Rastered one = raster_of(points, options);
  EXPECT_EQ(one.spilled, 0U);
  options.memory = RasterStore::least_memory(3, 1) + (1U << 20);
  const Rastered small = raster_of(points, options, {.tile_capacity = 300, .leaf_size = 50});
  EXPECT_GT(small.spilled, options.memory / 2);
  EXPECT_EQ(small.bands, one.bands);
}

TEST(Dem, TooLittleMemoryAndTooLargeARasterAreRefused) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  EXPECT_THROW(Dem({.memory = 1000}, std::nullopt, *scratch), UsageError);
  Dem dem({.grid = {.resolution = 1e-6}, .memory = kMemory}, std::nullopt, *scratch);
  EXPECT_THROW(dem.begin(Box<2>{{0, 0}, {1000, 1000}}), UsageError);
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

TEST(RasterStore, AFullDiskIsAnError) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 100'000);
  RasterStore store({PixelRule::kSum}, RasterStore::least_memory(1, 1), *scratch);
  RasterStore::Hand hand(store);
  EXPECT_THROW(
      {
        for (std::uint64_t tile = 0; tile < 1000; ++tile) {
          float* const pixels = hand.tile(tile);
          std::fill_n(pixels, RasterStore::kTilePixels, static_cast<float>(tile));
        }
      },
      Error);
}

}  // namespace
}  // namespace spillway
