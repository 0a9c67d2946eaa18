// Which pixel a point lies in is decided by comparisons with edges, never by a rounded quotient.

#include "src/terrain/pixel_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace spillway::test {
namespace {

TEST(PixelCells, HoldTheirWesternAndNorthernEdgesAndTheLastOneBoth) {
  const PixelCells cells({10, 20, 2, 3, 4}, std::nullopt);
  EXPECT_EQ(cells.column(10), 0U);
  EXPECT_EQ(cells.column(12), 1U);
  EXPECT_EQ(cells.column(std::nextafter(12, 0)), 0U);
  EXPECT_EQ(cells.column(16), 2U);
  EXPECT_EQ(cells.column(std::nextafter(16, 20)), std::nullopt);
  EXPECT_EQ(cells.column(9.99), std::nullopt);
  EXPECT_EQ(cells.row(20), 0U);
  EXPECT_EQ(cells.row(18), 1U);
  EXPECT_EQ(cells.row(std::nextafter(18, 20)), 0U);
  EXPECT_EQ(cells.row(12), 3U);
  EXPECT_EQ(cells.row(11.9), std::nullopt);
}

TEST(PixelCells, EdgesAreThoseThatAreComputed) {
  const PixelGrid grid{0.1, 100.7, 0.1, 1000, 1000};
  const PixelCells cells(grid, std::nullopt);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double west = grid.west + i * grid.resolution;
    const double north = grid.north - i * grid.resolution;
    EXPECT_EQ(cells.column(west), i);
    EXPECT_EQ(cells.row(north), i);
    if (i == 0) continue;
    EXPECT_EQ(cells.column(std::nextafter(west, 0)), i - 1);
    EXPECT_EQ(cells.row(std::nextafter(north, 1000)), i - 1);
  }
}

/// Of a lattice of centimetres, pixels of decimetres hold ten steps each, from their edge on.
TEST(PixelCells, EdgesThatAreStepsOfTheLatticeButForRoundingAreJustThese) {
  const IntegerLattice lattice{.scale = {0.01, 0.01, 0.01}, .offset = {500000, 4100000, 0}};
  const PixelGrid grid{500000.3, 4100200, 0.1, 1500, 2000};
  const PixelCells cells(grid, lattice);
  for (int step = 30; step < 15000; ++step) {
    EXPECT_EQ(cells.column(step), static_cast<std::uint32_t>(step - 30) / 10);
    EXPECT_EQ(cells.row(step), std::min(1999U, static_cast<std::uint32_t>(20000 - step) / 10));
  }
  EXPECT_EQ(cells.column(29), std::nullopt);
  EXPECT_EQ(cells.column(15030), 1499U);
  EXPECT_EQ(cells.column(15031), std::nullopt);
}

TEST(PixelCells, HugeDistancesAreInNoPixel) {
  const PixelCells cells({0, 0, 1e-3, 2147483647, 2147483647}, std::nullopt);
  EXPECT_EQ(cells.column(1e300), std::nullopt);
  EXPECT_EQ(cells.row(-1e300), std::nullopt);
  EXPECT_EQ(cells.column(2147483.6465), 2147483646U);
}

}  // namespace
}  // namespace spillway::test
