// What ranks have made of parts of a mesh, put together, is what one process makes of all of it.

#include "stream/ranks/share_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stream/sinks/dem_shares.h"
#include "tests/distributed/world.h"
#include "tests/stream/sinks/dem_runner.h"

namespace spillway::test {
namespace {

constexpr PixelGrid kGrid{.west = 0, .north = 600, .resolution = 1, .columns = 700, .rows = 600};

std::vector<Triangle> terrain() {
  return triangles_of(square_points(500, 650, false, 11),
                      [](double x, double y) { return x + 0.5 * y; });
}

/// Every triangle as a part of its own, with its first corner imported, so that each vertex of the
/// terrain is counted for as many triangles as name it second or third.
void paint(Dem& dem, const Triangle& triangle) {
  MeshStreamBlock mesh;
  mesh.vertices = {LatticePoint(triangle[1]), LatticePoint(triangle[2])};
  mesh.imported = {0};
  mesh.corners = {2, 0, 1};
  const std::vector<LatticePoint> imported = {LatticePoint(triangle[0])};
  DemWriter(dem).take_merged({.mesh = mesh, .imported_vertices = imported});
}

void give(Dem& dem) {
  ShareToFirstRank sender(world());
  give_share(dem, sender);
  sender.end();
}

void write(Dem& dem, Raster& raster, const std::function<void(std::uint64_t)>& progress) {
  SharesOfOtherRanks others(world());
  dem.write(raster, progress, take_shares(others, dem));
  others.end();
}

/// A raster being made, and what it needs.
struct Painted {
  explicit Painted(std::uint64_t memory) {
    options.memory = memory;
    options.grid.given = kGrid;
    dem.emplace(options, std::nullopt, *scratch);
    dem->begin(Box<2>{});
  }

  std::unique_ptr<ScratchFolder> scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  DemSinkOptions options = kAllProducts;
  std::optional<Dem> dem;
};

TEST(SharesOfRanks, IsTheRasterOfAllThatRanksHavePainted) {
  const std::vector<Triangle> triangles = terrain();
  Painted alone(kMemory);
  for (const Triangle& triangle : triangles) paint(*alone.dem, triangle);
  const Rastered expected = finished(*alone.dem, alone.options);
  EXPECT_GT(expected.with_data, 100'000U);

  const std::uint64_t least = RasterStore::least_memory(alone.options.products.size(), 1);
  for (const std::uint64_t memory : {kMemory, least}) {
    Painted own(memory);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (t % static_cast<std::size_t>(world().size()) ==
          static_cast<std::size_t>(world().rank())) {
        paint(*own.dem, triangles[t]);
      }
    }
    if (world().rank() != 0) {
      give(*own.dem);
      EXPECT_TRUE(own.dem->tiles().empty());
      continue;
    }
    KeepingRaster raster(kGrid, own.options.products.size());
    std::uint64_t told = 0;
    write(*own.dem, raster, [&told](std::uint64_t pixels) { told = pixels; });
    EXPECT_TRUE(raster.bands == expected.bands);
    EXPECT_EQ(own.dem->pixels_with_data(), expected.with_data);
    EXPECT_EQ(told, std::uint64_t{kGrid.columns} * kGrid.rows);
  }
}

TEST(SharesOfRanks, NeedsNothingOfRanksThatHavePaintedNothing) {
  Painted own(kMemory);
  if (world().rank() != 0) {
    give(*own.dem);
    return;
  }
  paint(*own.dem, {Point<3>{0, 0, 1}, {300, 0, 1}, {0, 300, 1}});
  KeepingRaster raster(kGrid, own.options.products.size());
  write(*own.dem, raster, [](std::uint64_t) {});
  EXPECT_GT(own.dem->pixels_with_data(), 0U);
}

TEST(SharesOfRanks, CountsVerticesWhereTheyAreNew) {
  Painted own(kMemory);
  paint(*own.dem, {Point<3>{10.5, 10.5, 1}, {20.5, 10.5, 1}, {10.5, 20.5, 1}});
  const Rastered raster = finished(*own.dem, own.options);
  const std::vector<float>& density = raster.bands.at(4);
  double sum = 0;
  for (const float pixel : density) {
    if (pixel != own.options.nodata) sum += pixel;
  }
  EXPECT_EQ(sum, 2);
}

}  // namespace
}  // namespace spillway::test
