// All products of data full of exact ties: level ground, zeros of both signs, triangles that fall
// exactly to north, east, south and west, centres of pixels on edges and vertices. Each pixel is
// computed again by rule 5 of docs/dem.md, and has the same bits whatever the order of points,
// triangles and corners, the threads, the tiles and the memory.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

/// x and y in steps of 1 / kSteps, so that vertices and centres are whole numbers.
constexpr int kSteps = 8;
using Steps = std::array<std::int64_t, 2>;

Steps steps_of(double x, double y) { return {std::llround(x * kSteps), std::llround(y * kSteps)}; }

Steps steps_of(const Point<3>& p) { return steps_of(p[0], p[1]); }

/// Twice the area of a, b, c, exactly.
__int128 turn(const Steps& a, const Steps& b, const Steps& c) {
  return static_cast<__int128>(b[0] - a[0]) * (c[1] - a[1]) -
         static_cast<__int128>(b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether a counter-clockwise triangle holds a place, its border included.
bool holds(const std::array<Steps, 3>& t, const Steps& p) {
  return turn(t[0], t[1], p) >= 0 && turn(t[1], t[2], p) >= 0 && turn(t[2], t[0], p) >= 0;
}

/// Whether it does after a small step east and one as much smaller north. The steps are so small,
/// compared with whole numbers up to some thousands, that smaller ones would decide alike.
bool owns(const std::array<Steps, 3>& t, const Steps& p) {
  constexpr std::int64_t kFine = std::int64_t{1} << 20;
  std::array<Steps, 3> fine{};
  for (int i = 0; i < 3; ++i) fine[i] = {t[i][0] * kFine * kFine, t[i][1] * kFine * kFine};
  return holds(fine, {p[0] * kFine * kFine + kFine, p[1] * kFine * kFine + 1});
}

/// Products of a triangle; corners are whole numbers, so that only the last steps are rounded.
struct Facet {
  explicit Facet(const Triangle& t) {
    for (int i = 0; i < 3; ++i) places[i] = steps_of(t[i]);
    std::array<std::array<std::int64_t, 3>, 2> to{};
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 3; ++k) to[i][k] = std::llround(t[i + 1][k]) - std::llround(t[0][k]);
    }
    origin = t[0];
    area = to[0][0] * to[1][1] - to[0][1] * to[1][0];
    east = to[0][2] * to[1][1] - to[1][2] * to[0][1];
    north = to[0][0] * to[1][2] - to[1][0] * to[0][2];
  }

  [[nodiscard]] long double height(const Steps& p) const {
    const std::int64_t dx = p[0] - std::llround(origin[0] * kSteps);
    const std::int64_t dy = p[1] - std::llround(origin[1] * kSteps);
    return origin[2] + static_cast<long double>(east * dx + north * dy) /
                           static_cast<long double>(area * kSteps);
  }
  [[nodiscard]] long double slope() const {
    return std::atan(std::sqrt(square())) * 180 / std::numbers::pi_v<long double>;
  }
  [[nodiscard]] std::optional<long double> aspect() const {
    if (east == 0 && north == 0) return std::nullopt;
    const int sign = area > 0 ? 1 : -1;
    const long double degrees = std::atan2(static_cast<long double>(-sign * east),
                                           static_cast<long double>(-sign * north)) *
                                180 / std::numbers::pi_v<long double>;
    return degrees < 0 ? degrees + 360 : std::abs(degrees);
  }
  [[nodiscard]] long double hillshade(const Light& light) const {
    const long double azimuth = light.azimuth * std::numbers::pi_v<long double> / 180;
    const long double altitude = light.altitude * std::numbers::pi_v<long double> / 180;
    const long double gx = static_cast<long double>(east) / area;
    const long double gy = static_cast<long double>(north) / area;
    const long double cosine =
        (std::sin(altitude) -
         std::cos(altitude) * (std::sin(azimuth) * gx + std::cos(azimuth) * gy)) /
        std::sqrt(1 + square());
    return 255 * std::clamp<long double>(cosine, 0, 1);
  }

  std::array<Steps, 3> places{};
  Point<3> origin{};
  std::int64_t area = 0;   ///< twice it
  std::int64_t east = 0;   ///< how the height grows to the east, times the area
  std::int64_t north = 0;  ///< likewise

 private:
  [[nodiscard]] long double square() const {
    const auto e = static_cast<long double>(east) / area;
    const auto n = static_cast<long double>(north) / area;
    return e * e + n * n;
  }
};

using Cloud = std::vector<Point<3>>;

double zero_of(Random& random) { return random.integer(0, 1) == 0 ? 0.0 : -0.0; }

/// Whole numbers everywhere, and the more ties the better.
std::vector<Cloud> clouds() {
  Random random(20);
  std::vector<Cloud> clouds;
  const auto lattice = [&](int side, const auto& height) {
    Cloud cloud;
    for (int i = 0; i < side * side; ++i) {
      const int x = i % side;
      const int y = i / side;
      const int z = height(x, y);
      cloud.push_back({1.0 * x, 1.0 * y, z == 0 ? zero_of(random) : z});
    }
    return cloud;
  };
  const auto few = [&](int, int) { return static_cast<int>(random.integer(-1, 1)); };
  clouds.push_back(lattice(9, few));
  clouds.push_back(lattice(8, [](int, int) { return 0; }));
  clouds.push_back(lattice(9, [](int, int y) { return std::abs(y - 4); }));   // south and north
  clouds.push_back(lattice(9, [](int x, int) { return -std::abs(x - 4); }));  // east and west
  clouds.push_back(lattice(9, [](int x, int y) { return std::max(0, 3 - x - y); }));
  clouds.push_back(lattice(9, [](int x, int y) { return std::min(0, std::abs(x - y) - 2); }));
  for (int turn = 0; turn < 4; ++turn) {
    std::set<std::pair<int, int>> places;
    while (places.size() < 60) {
      places.emplace(random.integer(0, 16), random.integer(0, 16));
    }
    Cloud cloud;
    for (const auto& [x, y] : places) {
      const auto z = static_cast<int>(random.integer(-2, 2));
      cloud.push_back({1.0 * x, 1.0 * y, z == 0 ? zero_of(random) : z});
    }
    clouds.push_back(cloud);
  }
  return clouds;
}

std::vector<Triangle> triangles_of_cloud(const Cloud& cloud) {
  std::vector<Point<2>> points;
  std::map<std::pair<double, double>, double> heights;
  for (const Point<3>& p : cloud) {
    points.push_back({p[0], p[1]});
    heights[{p[0], p[1]}] = p[2];
  }
  return triangles_of(points, [&](double x, double y) { return heights.at({x, y}); });
}

/// Centres on vertices and edges, between them, and beside the hull.
std::vector<DemSinkOptions> rasters() {
  std::vector<DemSinkOptions> rasters;
  for (const auto& [resolution, west] : {std::pair{1.0, -1.5}, {0.5, -0.25}, {0.25, 0.0}}) {
    DemSinkOptions options = kAllProducts;
    options.grid = {.resolution = resolution,
                    .bounds = Box<2>{{west, west}, {west + 18, west + 18}}};
    rasters.push_back(options);
  }
  rasters[1].light = {.azimuth = 0, .altitude = 0};  // many exact zeros
  rasters[2].nodata = 0;
  return rasters;
}

std::vector<std::vector<std::uint32_t>> bits(const Rastered& dem, std::size_t bands) {
  std::vector<std::vector<std::uint32_t>> all;
  for (std::size_t b = 0; b < bands; ++b) {
    std::vector<std::uint32_t>& band = all.emplace_back();
    for (const float pixel : dem.bands[b]) band.push_back(std::bit_cast<std::uint32_t>(pixel));
  }
  return all;
}

/// Equal but for some roundings of a float, or for what cancellation leaves of zero.
void expect_close(float pixel, long double value) {
  EXPECT_NEAR(pixel, static_cast<double>(value), 1e-6 * std::max(1.0, 0.2 * std::abs(1.0 * pixel)));
  EXPECT_FALSE(pixel == 0 && std::signbit(pixel));
}

/// What the pixel at a place must hold, product by product.
void expect_pixel(const std::vector<Facet>& facets, const Steps& place,
                  const DemSinkOptions& options, const std::array<float, 4>& pixel) {
  std::vector<const Facet*> around;
  const Facet* owner = nullptr;
  for (const Facet& facet : facets) {
    if (!holds(facet.places, place)) continue;
    around.push_back(&facet);
    if (owns(facet.places, place)) owner = &facet;
  }
  if (around.empty()) {
    for (const float value : pixel) EXPECT_EQ(value, options.nodata);
    return;
  }
  if (owner != nullptr) around = {owner};
  long double slope = 90;
  long double hillshade = 255;
  std::optional<long double> aspect;
  for (const Facet* facet : around) {
    slope = std::min(slope, facet->slope());
    hillshade = std::min(hillshade, facet->hillshade(options.light));
    if (const auto found = facet->aspect()) aspect = std::min(aspect.value_or(360), *found);
  }
  expect_close(pixel[0], around.front()->height(place));
  expect_close(pixel[1], slope);
  expect_close(pixel[3], hillshade);
  if (!aspect) {
    EXPECT_EQ(pixel[2], options.nodata);
    return;
  }
  expect_close(pixel[2], *aspect);
  EXPECT_GE(pixel[2], 0);
  EXPECT_LT(pixel[2], 360);
  if (*aspect == 0) {
    EXPECT_EQ(pixel[2], options.nodata == 0 ? std::nextafter(0.0F, 1.0F) : 0);
  }
}

TEST(DemOracle, EveryPixelIsThatOfTheTriangleThatOwnsItsCentre) {
  for (const Cloud& cloud : clouds()) {
    std::vector<Facet> facets;
    for (const Triangle& triangle : triangles_of_cloud(cloud)) facets.emplace_back(triangle);
    for (const DemSinkOptions& options : rasters()) {
      const Rastered dem = raster_of(cloud, options);
      std::vector<float> density(dem.bands[4].size());
      const PixelCells cells(dem.grid, std::nullopt);
      for (const Point<3>& p : cloud) {
        const auto column = cells.column(p[0]);
        const auto row = cells.row(p[1]);
        if (column && row) ++density[*row * dem.grid.columns + *column];
      }
      for (std::size_t i = 0; i < density.size(); ++i) {
        const auto row = static_cast<std::uint32_t>(i / dem.grid.columns);
        const auto column = static_cast<std::uint32_t>(i % dem.grid.columns);
        expect_pixel(facets, steps_of(dem.grid.centre_x(column), dem.grid.centre_y(row)), options,
                     {dem.bands[0][i], dem.bands[1][i], dem.bands[2][i], dem.bands[3][i]});
        expect_close(dem.bands[4][i], density[i]);
        ASSERT_FALSE(::testing::Test::HasFailure())
            << "cloud of " << cloud.size() << ", resolution " << dem.grid.resolution << ", row "
            << row << ", column " << column;
      }
    }
  }
}

TEST(DemOracle, OrdersThreadsAndTilesChangeNoBit) {
  std::mt19937 random(7);
  for (Cloud cloud : clouds()) {
    auto triangles = triangles_of_cloud(cloud);
    for (const DemSinkOptions& options : rasters()) {
      const Rastered one = raster_of(cloud, options);
      const auto of_points = bits(one, 5);
      const auto of_mesh = bits(one, 4);
      for (unsigned threads = 1; threads <= 8; ++threads) {
        std::shuffle(cloud.begin(), cloud.end(), random);
        EngineOptions stream{.threads = threads};
        if (threads % 2 == 0) stream.asked.leaf_points = 5 + threads;
        if (threads % 3 == 0) stream.asked.tile_points = stream.buffered_points = 10 * threads;
        ASSERT_EQ(bits(raster_of(cloud, options, stream), 5), of_points) << threads;

        std::shuffle(triangles.begin(), triangles.end(), random);
        for (Triangle& triangle : triangles) {
          std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
          if (random() % 2 == 0) std::swap(triangle[0], triangle[1]);
        }
        DemSinkOptions painted = options;
        painted.threads = threads;
        ASSERT_EQ(bits(raster_of(triangles, one.grid, painted, threads), 4), of_mesh) << threads;
      }
    }
  }
}

TEST(DemOracle, PixelsOnTheDiskChangeNoBit) {
  std::mt19937 random(9);
  const Cloud cloud = clouds()[6];
  auto triangles = triangles_of_cloud(cloud);
  const PixelGrid grid{-1.0 / 128, 16 + 1.0 / 128, 1.0 / 64, 1025, 1025};  // 25 tiles
  DemSinkOptions options = kAllProducts;
  const auto expected = bits(raster_of(triangles, grid, options), 4);
  options.memory = RasterStore::least_memory(5, 1) + (1U << 20);
  for (int turn = 0; turn < 4; ++turn) {
    std::shuffle(triangles.begin(), triangles.end(), random);
    const Rastered spilled = raster_of(triangles, grid, options, 3);
    EXPECT_GT(spilled.spilled, 0U);
    EXPECT_EQ(bits(spilled, 4), expected);
  }
}

TEST(DemOracle, ATriangleThatFallsDueNorthWinsOverItsNeighbours) {
  // Centres on the edge from (0, 0) to (4, 8) belong to the triangle in the east. That in the west
  // falls exactly north.
  const Point<3> top{0, 0, 10};
  const Point<3> shared{4, 8, 2};
  std::vector<Triangle> triangles = {{top, shared, {-6, 8, 2}}, {top, {9, 1, 0}, shared}};
  const PixelGrid grid{-6.5, 8.5, 1, 16, 9};
  DemSinkOptions options{.products = {DemProduct::kFacetAspect}};
  for (int turn = 0; turn < 2; ++turn) {
    const Rastered dem = raster_of(triangles, grid, options);
    EXPECT_NEAR(dem.bands[0][6 * 16 + 7], 66.0375137, 1e-5);  // at (1, 2)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(dem.bands[0][1 * 16 + 6]), 0U);
    std::swap(triangles[0], triangles[1]);
  }
}

}  // namespace
}  // namespace spillway::test
