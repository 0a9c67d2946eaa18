#pragma once
// Makes rasters in memory, of points through the pipeline or of triangles as they are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/parallel/parallel.h"
#include "stream/sinks/dem.h"
#include "stream/sinks/dem_writer.h"
#include "tests/stream/stream_runner.h"
#include "tests/terrain/terrain_mesh.h"

namespace spillway::test {

inline constexpr std::uint64_t kMemory = std::uint64_t{64} << 20;

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
  std::uint64_t closed = 0;
  std::uint64_t points = 0;
  std::uint64_t filled = 0;
};

inline Rastered finished(Dem& dem, const DemSinkOptions& options) {
  KeepingRaster raster(dem.grid(), options.products.size());
  dem.write(raster, [](std::uint64_t) {});
  return {dem.grid(), std::move(raster.bands), dem.pixels_with_data(), dem.spilled_bytes(),
          dem.closed_tiles(),
          dem.points_in_pixels(),
          dem.filled_pixels()};
}

/// Points through the whole pipeline.
inline Rastered raster_of(const std::vector<Point<3>>& points, DemSinkOptions options,
                          EngineOptions stream = {}) {
  if (options.memory == 0) options.memory = kMemory;
  options.threads = stream.threads;
  const std::string path = write_points<3>(points);
  JoinedInputs source(disk(), {path}, {.dimension = 2});
  QuietSetup setup(std::move(stream), kMemory);
  Dem dem(options, source.lattice(), *setup.scratch);
  class Extents final : public RunSink {
   public:
    Extents(Dem& dem, bool wants_points) : dem_(dem), wants_points_(wants_points) {}
    void extent_known(const Box<2>& extent, std::uint64_t /*points*/) override {
      dem_.begin(extent);
    }
    [[nodiscard]] bool wants_points() const override { return wants_points_; }
    void take_points(std::span<const LatticePoint> points) override { dem_.take_points(points); }

   private:
    Dem& dem_;
    const bool wants_points_;
  } extents(dem, are_of_points(options.products));
  DemWriter writer(dem);
  (void)triangulate_stream<2>(
      source, writer, {setup.options, *setup.scratch, setup.budget, extents, setup.progress});
  return finished(dem, options);
}

/// Triangles as they are, without any pipeline; so many at a time.
inline Rastered raster_of(const std::vector<Triangle>& triangles, const PixelGrid& grid,
                          DemSinkOptions options, std::size_t at_a_time = 1 << 20) {
  if (options.memory == 0) options.memory = kMemory;
  options.grid.given = grid;
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  Dem dem(options, std::nullopt, *scratch);
  dem.begin(Box<2>{});
  with_threads(options.threads, [&] {
    for (std::size_t begin = 0; begin < triangles.size(); begin += at_a_time) {
      std::vector<PlacedPoint> vertices;
      std::vector<std::uint32_t> corners;
      for (std::size_t t = begin; t < std::min(triangles.size(), begin + at_a_time); ++t) {
        for (const Point<3>& corner : triangles[t]) {
          corners.push_back(static_cast<std::uint32_t>(vertices.size()));
          vertices.emplace_back(corner);
        }
      }
      dem.paint(vertices, corners);
    }
  });
  return finished(dem, options);
}

inline std::vector<Point<3>> with_heights(const std::vector<Point<2>>& points,
                                          const HeightOf& height) {
  std::vector<Point<3>> result;
  for (const Point<2>& p : points) result.push_back({p[0], p[1], height(p[0], p[1])});
  return result;
}

inline const DemSinkOptions kAllProducts{
    .products = {DemProduct::kHeight, DemProduct::kFacetSlope, DemProduct::kFacetAspect,
                 DemProduct::kFacetHillshade, DemProduct::kDensity}};

}  // namespace spillway::test
