// Which pixels belong to which triangle, against exact predicates on every pair of them.

#include "src/terrain/triangle_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "src/error.h"
#include "tests/terrain/terrain_mesh.h"

namespace spillway::test {
namespace {

double level(double /*x*/, double /*y*/) { return 0; }

struct Visits {
  std::vector<int> owners;   // by pixel
  std::vector<int> touched;  // triangles that found the pixel
};

/// Scans all triangles and compares every pixel with exact predicates on the whole raster.
Visits scan(const PixelGrid& grid, const std::vector<Triangle>& triangles) {
  const PixelCentres centres(grid, std::nullopt);
  const std::size_t pixels = std::size_t{grid.columns} * grid.rows;
  Visits visits{std::vector<int>(pixels), std::vector<int>(pixels)};
  std::vector<PixelRun> runs;
  for (const Triangle& triangle : triangles) {
    const Triangle canonical = in_canonical_order(triangle);
    std::vector<int> relation(pixels, -1);
    find_pixels(centres, canonical, box_of(centres, canonical), runs);
    for (const PixelRun& run : runs) {
      for (std::uint32_t column = run.begin; column < run.end; ++column) {
        const std::size_t pixel = std::size_t{run.row} * grid.columns + column;
        EXPECT_EQ(relation[pixel], -1) << "a pixel comes twice";
        relation[pixel] = run.relation == TriangleRelation::kInside   ? 0
                          : run.relation <= TriangleRelation::kEdge12 ? 1
                                                                      : 2;
        ++visits.touched[pixel];
        if (run.owned) ++visits.owners[pixel];
      }
    }
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
      for (std::uint32_t column = 0; column < grid.columns; ++column) {
        EXPECT_EQ(relation[std::size_t{row} * grid.columns + column],
                  edges_touched(triangle, {grid.centre_x(column), grid.centre_y(row)}))
            << "row " << row << ", column " << column;
      }
    }
  }
  return visits;
}

/// Every pixel within the hull has one owner, those on the hull at most one, and all are found.
void expect_watertight(const PixelGrid& grid, const std::vector<Triangle>& triangles) {
  ASSERT_FALSE(triangles.empty());
  const Visits visits = scan(grid, triangles);
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const std::size_t pixel = std::size_t{row} * grid.columns + column;
      const Point<2> centre{grid.centre_x(column), grid.centre_y(row)};
      bool in_hull = false;
      // Within the hull, and not on it: what remains when moved a little to all sides.
      int sides_in_hull = 0;
      for (const Triangle& triangle : triangles) {
        in_hull = in_hull || edges_touched(triangle, centre) >= 0;
      }
      for (const Point<2>& moved :
           {Point<2>{centre[0] - 1e-6, centre[1]}, Point<2>{centre[0] + 1e-6, centre[1]},
            Point<2>{centre[0], centre[1] - 1e-6}, Point<2>{centre[0], centre[1] + 1e-6}}) {
        sides_in_hull += std::any_of(
            triangles.begin(), triangles.end(),
            [&](const Triangle& triangle) { return edges_touched(triangle, moved) >= 0; });
      }
      EXPECT_EQ(visits.touched[pixel] > 0, in_hull);
      EXPECT_LE(visits.owners[pixel], 1) << "two owners";
      if (sides_in_hull == 4) {
        EXPECT_EQ(visits.owners[pixel], 1) << "a hole";
      }
    }
  }
}

TEST(TrianglePixels, RandomPointsLeaveNoHolesAndNoPixelHasTwoOwners) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    expect_watertight({-0.5, 10.5, 0.37, 30, 30},
                      triangles_of(square_points(60, 10, false, seed), level));
  }
}

TEST(TrianglePixels, CentresOnVerticesAndEdgesOfALatticeHaveOneOwner) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto triangles = triangles_of(square_points(70, 9, true, seed), level);
    expect_watertight({-0.5, 9.5, 1, 10, 10}, triangles);      // centres are vertices
    expect_watertight({-0.25, 9.25, 0.5, 19, 19}, triangles);  // and midpoints of edges
    expect_watertight({0, 9, 1, 9, 9}, triangles);             // and midpoints of diagonals
  }
}

TEST(TrianglePixels, FullLattice) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 36; ++i) points.push_back({i % 6 * 1.0, i / 6 * 1.0});
  expect_watertight({-0.25, 5.25, 0.5, 11, 11}, triangles_of(points, level));
}

TEST(TrianglePixels, LargeOffsetsWithDecimalsThatAreNoDoubles) {
  auto points = square_points(50, 8, false, 9);
  for (Point<2>& p : points) {
    p = {std::round(p[0] * 10) / 10 + 600000.1, std::round(p[1] * 10) / 10 + 5400000.3};
  }
  expect_watertight({600000, 5400009, 0.1, 85, 88}, triangles_of(points, level));
}

TEST(TrianglePixels, NeedleTriangles) {
  std::vector<Point<2>> points = {{0, 0}, {1e6, 1}, {2e6, 0}, {1e6, -1e-9}, {5e5, 0.5}};
  expect_watertight({-1e5, 3, 1e5, 22, 1}, triangles_of(points, level));
  expect_watertight({-1e5, 0.5, 1e5, 22, 1}, triangles_of(points, level));
}

TEST(TrianglePixels, AWindowGivesThePixelsOfTheWholeThatLieInIt) {
  const PixelCentres centres({0, 40, 1, 40, 40}, std::nullopt);
  const Triangle canonical = in_canonical_order({{{1, 1, 0}, {38, 7, 0}, {11, 39, 0}}});
  const PixelWindow whole = box_of(centres, canonical);
  std::vector<PixelRun> runs;
  const auto count = [&](const PixelWindow& window) {
    find_pixels(centres, canonical, window, runs);
    std::uint32_t pixels = 0;
    for (const PixelRun& run : runs) pixels += run.end - run.begin;
    return pixels;
  };
  std::uint32_t parts = 0;
  for (std::uint32_t row = whole.row_begin; row < whole.row_end; row += 7) {
    for (std::uint32_t column = whole.column_begin; column < whole.column_end; column += 7) {
      parts += count(
          {row, std::min(row + 7, whole.row_end), column, std::min(column + 7, whole.column_end)});
    }
  }
  EXPECT_EQ(parts, count(whole));
}

TEST(TrianglePixels, ATriangleWithoutAreaHasNoPixels) {
  const PixelCentres centres({0, 4, 1, 4, 4}, std::nullopt);
  const Triangle canonical = in_canonical_order({{{0.5, 0.5, 0}, {1.5, 1.5, 0}, {2.5, 2.5, 0}}});
  std::vector<PixelRun> runs(1);
  find_pixels(centres, canonical, box_of(centres, canonical), runs);
  EXPECT_TRUE(runs.empty());
}

TEST(PixelCentres, CentresOfALatticeAreItsIntegersWhereTheyFallOnThem) {
  const IntegerLattice lattice{{0.01, 0.01, 0.01}, {600000, 5400000, 0}};
  const PixelCentres centres({600000.1, 5400010.1, 0.2, 20, 20}, lattice);
  for (std::uint32_t c = 0; c < 20; ++c) {
    EXPECT_EQ(centres.x()[c], 20.0 * (c + 1));
    EXPECT_EQ(centres.y()[c], 1000 - 20.0 * c);
  }
}

TEST(PixelCentres, TooFineAResolutionIsRefused) {
  EXPECT_THROW(PixelCentres({1e9, 1e9, 1e-9, 10, 10}, std::nullopt), InvalidArgument);
}

}  // namespace
}  // namespace spillway::test
