// Products of a pixel's neighbours: those of the heights that are written, at edges of tiles, too.

#include <spillway/dem.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "src/terrain/neighbourhood.h"
#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

double rough(double x, double y) { return 50 * std::sin(x / 9) * std::cos(y / 7) + x / 3; }

const DemSinkOptions kDerived{
    .products = {DemProduct::kSlope, DemProduct::kFacetSlope, DemProduct::kAspect,
                 DemProduct::kHillshade, DemProduct::kHeight, DemProduct::kMultiHillshade,
                 DemProduct::kRoughness, DemProduct::kTri, DemProduct::kTpi, DemProduct::kCurvature,
                 DemProduct::kProfileCurvature, DemProduct::kPlanCurvature},
    .nodata = kNothing};

/// Heights around a pixel, of a raster that reaches a pixel further on all sides.
Neighbourhood around(const Rastered& heights, std::uint32_t row, std::uint32_t column) {
  Neighbourhood z{};
  for (std::uint32_t i = 0; i < 9; ++i) {
    z[i] = heights.bands[0][(row + i / 3) * heights.grid.columns + column + i % 3];
  }
  return z;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::ranges::equal(
      a, b, [](float p, float q) { return p == q || (std::isnan(p) && std::isnan(q)); });
}

/// More than one tile each way, with holes and a hull that does not fill it.
DemSinkOptions with_holes(bool compute_edges) {
  DemSinkOptions options = kDerived;
  options.grid = {.resolution = 1, .bounds = Box<2>{{10, -20}, {310, 280}}};
  options.compute_edges = compute_edges;
  return options;
}
const EngineOptions kHoles{.asked = {.max_edge = 16.0}};

std::vector<Point<3>> some_points() {
  return with_heights(square_points(3'500, 290, false, 7), rough);
}

TEST(DemNeighbours, EveryPixelIsWhatItsNineHeightsTell) {
  for (const bool compute_edges : {false, true}) {
    for (const auto method : {GradientMethod::kHorn, GradientMethod::kZevenbergenThorne}) {
      DemSinkOptions options = with_holes(compute_edges);
      options.gradient = method;
      options.ground.height = 1.5;
      options.light = {.azimuth = 200, .altitude = 30};
      const Rastered dem = raster_of(some_points(), options, kHoles);
      ASSERT_EQ(dem.grid.columns, 300U);
      options.products = {DemProduct::kHeight};
      options.grid.given = PixelGrid{9, 281, 1, 302, 302};
      const Rastered heights = raster_of(some_points(), options, kHoles);
      std::size_t holes = 0;
      std::size_t edges = 0;
      for (std::uint32_t row = 0; row < dem.grid.rows; ++row) {
        for (std::uint32_t column = 0; column < dem.grid.columns; ++column) {
          const std::size_t i = std::size_t{row} * dem.grid.columns + column;
          Neighbourhood z = around(heights, row, column);
          const bool has_height = !std::isnan(z[4]);
          const bool whole = is_complete(z);
          holes += has_height ? 0 : 1;
          edges += has_height && !whole ? 1 : 0;
          if (has_height && compute_edges) {
            complete(z, {row == 0, row + 1 == dem.grid.rows, column == 0,
                         column + 1 == dem.grid.columns});
          }
          if (!is_complete(z)) {
            for (const std::size_t b : {0, 2, 3, 5, 6, 7, 8, 9, 10, 11}) {
              ASSERT_TRUE(std::isnan(dem.bands[b][i])) << row << ", " << column << ", " << b;
            }
            continue;
          }
          Gradient gradient = gradient_of(z, method, {1, 1});
          for (double& part : gradient) part *= 1.5;
          const CurvedSurface curved(z, {1, 1}, 1.5);
          ASSERT_FLOAT_EQ(dem.bands[0][i], static_cast<float>(slope_of(gradient)));
          const float aspect = rounded_aspect_of(gradient);
          ASSERT_TRUE(dem.bands[2][i] == aspect || std::isnan(aspect));
          ASSERT_FLOAT_EQ(dem.bands[3][i],
                          static_cast<float>(shade_of(gradient, direction_of(options.light))));
          ASSERT_FLOAT_EQ(dem.bands[5][i], static_cast<float>(MultiShade(30).of(gradient)));
          ASSERT_FLOAT_EQ(dem.bands[6][i], static_cast<float>(roughness_of(z)));
          ASSERT_FLOAT_EQ(dem.bands[7][i], static_cast<float>(ruggedness_of(z)));
          ASSERT_FLOAT_EQ(dem.bands[8][i], static_cast<float>(position_of(z)));
          ASSERT_FLOAT_EQ(dem.bands[9][i], static_cast<float>(curved.curvature()));
          ASSERT_FLOAT_EQ(dem.bands[10][i], static_cast<float>(curved.profile()));
          ASSERT_FLOAT_EQ(dem.bands[11][i], static_cast<float>(curved.plan()));
        }
      }
      EXPECT_GT(holes, 1000U);
      EXPECT_GT(edges, 300U);
    }
  }
}

TEST(DemNeighbours, ThreadsTilesAndMemoryDoNotMatter) {
  const DemSinkOptions options = with_holes(true);
  const auto points = some_points();
  const Rastered one = raster_of(points, options, kHoles);
  for (const unsigned threads : {1U, 2U, 5U}) {
    for (const bool little : {false, true}) {
      for (const bool closes : {false, true}) {
        DemSinkOptions other = options;
        other.closes_tiles = closes;
        if (little) other.memory = RasterStore::least_memory(2, threads) + (1U << 18);
        EngineOptions stream = kHoles;
        stream.threads = threads;
        stream.asked.tile_points = 500;
        const Rastered dem = raster_of(points, other, stream);
        EXPECT_EQ(dem.with_data, one.with_data);
        for (std::size_t b = 0; b < one.bands.size(); ++b) {
          EXPECT_TRUE(same(dem.bands[b], one.bands[b]))
              << dem_product_names()[static_cast<std::size_t>(options.products[b])] << ", "
              << threads << (little ? " little" : "") << (closes ? " closes" : "");
        }
      }
    }
  }
}

TEST(DemNeighbours, TilesThatDoNotFitInARowOfThemGoToTheDiskAndComeBack) {
  // 30 x 2 tiles, of which 16 fit.
  const PixelGrid grid{0, 512, 1, 7'680, 512};
  const std::vector<Triangle> triangles = {
      {{{-10, -10, 0}, {30'000, -10, 300}, {-10, 30'000, 900}}}};
  DemSinkOptions options{.products = {DemProduct::kSlope}};
  const Rastered one = raster_of(triangles, grid, options);
  options.memory = RasterStore::least_memory(1, 1) + (1U << 20);
  const Rastered little = raster_of(triangles, grid, options);
  EXPECT_EQ(one.spilled, 0U);
  EXPECT_GT(little.spilled, 0U);
  EXPECT_EQ(little.bands, one.bands);
  EXPECT_EQ(one.with_data, 7'680U * 512);
}

/// The surface goes on beyond the raster's edges: there is no frame without data.
TEST(DemNeighbours, PartsOfARasterAreThoseOfTheWhole) {
  DemSinkOptions options = with_holes(false);
  const auto points = some_points();
  const Rastered whole = raster_of(points, options, kHoles);
  const std::array<PixelGrid, 3> parts = {
      {{60, 260, 1, 200, 256}, {11, 279, 1, 257, 298}, {150, 200, 1, 1, 1}}};
  for (const PixelGrid& part : parts) {
    options.grid.given = part;
    for (const unsigned threads : {1U, 3U}) {
      EngineOptions stream = kHoles;
      stream.threads = threads;
      const Rastered dem = raster_of(points, options, stream);
      ASSERT_EQ(dem.grid, part);
      for (std::size_t b = 0; b < dem.bands.size(); ++b) {
        for (std::size_t i = 0; i < dem.bands[b].size(); ++i) {
          const auto column = static_cast<std::size_t>(part.west - 10) + i % part.columns;
          const auto row = static_cast<std::size_t>(280 - part.north) + i / part.columns;
          const float expected = whole.bands[b][row * whole.grid.columns + column];
          ASSERT_TRUE(dem.bands[b][i] == expected ||
                      (std::isnan(dem.bands[b][i]) && std::isnan(expected)))
              << row << ", " << column << ", " << b;
        }
      }
    }
  }
}

TEST(DemNeighbours, ARasterOfOneRowHasNoSlopeWithoutDataBeyond) {
  const std::vector<Triangle> triangles = {{{{0, 0, 0}, {9, 0, 3}, {0, 9, 7}}},
                                           {{{9, 9, 1}, {9, 0, 3}, {0, 9, 7}}}};
  DemSinkOptions options{.products = {DemProduct::kSlope}, .compute_edges = true};
  EXPECT_EQ(raster_of(triangles, {0, 4.5, 9, 1, 1}, options).with_data, 0U);
  EXPECT_EQ(raster_of(triangles, {0, 9, 1, 9, 9}, options).with_data, 81U);
  options.compute_edges = false;
  EXPECT_EQ(raster_of(triangles, {0, 9, 1, 9, 9}, options).with_data, 49U);
}

TEST(DemNeighbours, HeightsThatAreMovedFromNodataCountAsTheyAre) {
  const std::vector<Triangle> triangles = {{{{-9, -9, 0}, {99, -9, 12}, {-9, 99, 24}}}};
  const PixelGrid grid{0, 20, 1, 20, 20};
  DemSinkOptions options{.products = {DemProduct::kSlope}};
  const Rastered one = raster_of(triangles, grid, options);
  options.nodata = one.bands[0][21];
  const Rastered other = raster_of(triangles, grid, options);
  EXPECT_EQ(other.with_data, one.with_data);
  EXPECT_NEAR(other.bands[0][21], one.bands[0][21], 1e-5);
}

}  // namespace
}  // namespace spillway::test
