// What pictures of tetrahedra are made of is the same whether a mesh comes as one block or as many,
// and in output coordinates.

#include "stream/sinks/tetrahedron_writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/stream/checker/mesh_streaming.h"

namespace spillway::test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A row of cubes of side 1 from x = 0 on, each cut into the six tetrahedra around its diagonal.
Mesh cubes(std::uint64_t count) {
  Mesh mesh;
  mesh.header.dimension = 3;
  for (std::uint64_t x = 0; x <= count; ++x) {
    for (const double y : {0.0, 1.0}) {
      for (const double z : {0.0, 1.0}) mesh.vertices.push_back({static_cast<double>(x), y, z});
    }
  }
  std::array<std::uint64_t, 3> steps = {1, 2, 4};  // along z, y, x
  for (std::uint64_t cube = 0; cube < count; ++cube) {
    do {
      std::uint64_t corner = 4 * cube;
      mesh.corners.push_back(corner);
      for (const std::uint64_t step : steps) mesh.corners.push_back(corner += step);
    } while (std::next_permutation(steps.begin(), steps.end()));
  }
  return mesh;
}

void write(TetrahedronWriter& writer, const Mesh& mesh, std::size_t simplices_in_block) {
  StreamInMemory stream = stream_of(mesh, simplices_in_block);
  for (MeshStreamBlock& block : stream.blocks) writer.write(std::move(block));
  writer.finish(stream.stream_totals);
}

std::set<std::array<Point<3>, 3>> facets_of(const HullWriter& hull) {
  std::set<std::array<Point<3>, 3>> facets;
  for (auto facet : hull.facets()) {
    std::sort(facet.begin(), facet.end());
    EXPECT_TRUE(facets.insert(facet).second) << "a facet twice";
  }
  return facets;
}

double area(const std::array<Point<2>, 4>& corners, int count) {
  double twice = 0;
  for (int i = 0; i < count; ++i) {
    const Point<2>& a = corners[i];
    const Point<2>& b = corners[(i + 1) % count];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(twice) / 2;
}

double area(const std::vector<CellCut>& cuts) {
  double sum = 0;
  for (const CellCut& cell : cuts) sum += area(cell.cut.corners, cell.cut.count);
  return sum;
}

TEST(HullWriter, KeepsTheFacetsOfOneTetrahedronOnly) {
  const Mesh mesh = cubes(3);
  for (const std::size_t block : {1, 4, 1000}) {
    HullWriter hull(std::nullopt, std::nullopt);
    write(hull, mesh, block);
    const auto facets = facets_of(hull);
    EXPECT_THAT(facets, SizeIs(2 * (2 + 4 * 3))) << "two triangles for each outer square";
    for (const auto& facet : facets) {
      const auto all = [&facet](int axis, double value) {
        return std::all_of(facet.begin(), facet.end(),
                           [&](const Point<3>& p) { return p[axis] == value; });
      };
      EXPECT_TRUE(all(0, 0) || all(0, 3) || all(1, 0) || all(1, 1) || all(2, 0) || all(2, 1));
    }
  }
}

TEST(HullWriter, OfNothingIsEmpty) {
  HullWriter hull(std::nullopt, std::nullopt);
  hull.finish({});
  EXPECT_THAT(hull.facets(), IsEmpty());
  EXPECT_TRUE(hull.extent().empty());
}

/// More vertices than are kept before inner ones are thrown away.
TEST(HullWriter, ForgetsInnerVerticesOnly) {
  constexpr std::uint64_t kCubes = 40'000;
  HullWriter hull(std::nullopt, std::nullopt);
  write(hull, cubes(kCubes), 1000);
  EXPECT_THAT(hull.facets(), SizeIs(2 * (2 + 4 * kCubes)));
}

TEST(HullWriter, LeavesOutTetrahedraWithTooLongAnEdge) {
  Mesh mesh = cubes(2);
  for (WorldPoint& vertex : mesh.vertices) {
    if (vertex[0] == 2) vertex[0] = 10;
  }
  HullWriter hull(std::nullopt, 3.0);
  write(hull, mesh, 3);
  EXPECT_EQ(hull.left_out(), 6U);
  EXPECT_THAT(facets_of(hull), SizeIs(12)) << "the hull of the first cube";
  EXPECT_EQ(hull.extent().hi[0], 10) << "vertices count, used or not";
}

TEST(HullWriter, MeasuresEdgesInOutputUnits) {
  const IntegerLattice lattice{{10, 10, 10}, {100, 0, 0}};
  HullWriter hull(lattice, 3.0);
  write(hull, cubes(1), 10);
  EXPECT_EQ(hull.left_out(), 6U);
  EXPECT_EQ(hull.extent().lo, (Point<3>{100, 0, 0}));
  EXPECT_EQ(hull.extent().hi, (Point<3>{110, 10, 10}));
}

TEST(SliceWriter, CutsCoverTheSectionOnce) {
  const Mesh mesh = cubes(4);
  for (const std::size_t block : {1, 5, 1000}) {
    SliceWriter lengthwise(std::nullopt, std::nullopt, {.axis = 2, .value = 0.25});
    write(lengthwise, mesh, block);
    EXPECT_NEAR(area(lengthwise.cuts()), 4, 1e-12);
    SliceWriter across(std::nullopt, std::nullopt, {.axis = 0, .value = 2});
    write(across, mesh, block);
    EXPECT_NEAR(area(across.cuts()), 1, 1e-12) << "a face on the plane is cut from one side only";
    SliceWriter beyond(std::nullopt, std::nullopt, {.axis = 1, .value = 1.5});
    write(beyond, mesh, block);
    EXPECT_THAT(beyond.cuts(), IsEmpty());
  }
}

TEST(SliceWriter, TellsTheSizeOfACell) {
  SliceWriter slice(IntegerLattice{{2, 2, 2}, {0, 0, 0}}, std::nullopt, {.axis = 0, .value = 1});
  write(slice, cubes(1), 1);
  ASSERT_FALSE(slice.cuts().empty());
  for (const CellCut& cell : slice.cuts()) {
    EXPECT_FLOAT_EQ(cell.size, static_cast<float>(std::cbrt(8.0 / 6)));
  }
}

}  // namespace
}  // namespace spillway::test
