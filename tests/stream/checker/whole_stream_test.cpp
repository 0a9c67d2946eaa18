// A periodic mesh in memory: the proof of streams is its proof, too.

#include "stream/checker/whole_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>

#include "src/error.h"
#include "stream/checker/checker.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 5;

/// A grid of squares in a box that repeats along x and, unless it is open, y: each of two triangles.
Mesh torus(bool open = false, double step = 1) {
  Mesh mesh;
  mesh.header.dimension = 2;
  const double side = kSide * step;
  mesh.header.periodic =
      PeriodicBox{.box = {{0, 0, 0}, {side, open ? 0 : side, 0}}, .periodic = {true, !open, false}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) mesh.vertices.push_back({x * step, y * step, 0});
  }
  const auto add = [&](int x, int y) {
    mesh.corners.push_back(static_cast<std::uint64_t>(y % kSide * kSide + x % kSide));
    mesh.offsets.push_back(corner_offset(std::array{x / kSide, y / kSide}));
  };
  for (int y = 0; y < (open ? kSide - 1 : kSide); ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (const auto& [dx, dy] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
        add(x + dx, y + dy);
      }
    }
  }
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / 3;
  return mesh;
}

CheckReport check(const Mesh& mesh) {
  CheckerOptions options;
  options.any_delaunay = true;
  return check_mesh(mesh, options);
}

TEST(WholeStream, PeriodicMeshesAreProved) {
  for (const bool open : {false, true}) {
    const CheckReport report = check(torus(open));
    EXPECT_EQ(report.fault_count, 0U) << ::testing::PrintToString(report.faults);
    EXPECT_THAT(report.proved, ::testing::Contains(HasSubstr("in the periodic box")));
    EXPECT_EQ(report.vertices, 25U);
    EXPECT_EQ(report.simplices, open ? 40U : 50U);
    EXPECT_EQ(report.hull_facets, open ? 10U : 0U);
    EXPECT_EQ(report.hull_facets, count_periodic_hull(torus(open)));
    EXPECT_EQ(report.canonical_hash, canonical_hash(torus(open)));
    EXPECT_EQ(report.peak_live_vertices, 0U);
  }
}

TEST(WholeStream, OnTheLatticeOfTheMesh) {
  Mesh mesh = torus(false, 0.1);
  EXPECT_GT(check(mesh).fault_count, 0U) << "copies of tenths are not exact";
  mesh.header.lattice = IntegerLattice{{0.1, 0.1, 0.1}, {0, 0, 0}};
  const CheckReport report = check(mesh);
  EXPECT_EQ(report.fault_count, 0U) << ::testing::PrintToString(report.faults);
  EXPECT_TRUE(report.on_lattice);
  mesh.vertices[7][0] += 0.01;
  EXPECT_GT(check(mesh).off_lattice, 0U);
}

TEST(WholeStream, FaultsNameTheSimplicesOfTheFile) {
  Mesh mesh = torus();
  std::swap(mesh.corners[3 * 9 + 1], mesh.corners[3 * 9 + 2]);
  std::swap(mesh.offsets[3 * 9 + 1], mesh.offsets[3 * 9 + 2]);
  const CheckReport report = check(mesh);
  EXPECT_GT(report.fault_count, 0U);
  EXPECT_THAT(report.faults, ::testing::Contains(HasSubstr("triangle 9 ")));
}

TEST(WholeStream, WrongOffsetsAreRefuted) {
  Mesh mesh = torus();
  mesh.offsets[3 * 20 + 2] = corner_offset(std::array{0, 1});
  EXPECT_GT(check(mesh).fault_count, 0U);
  mesh = torus();
  mesh.header.periodic->box.high[1] = 4;
  EXPECT_GT(check(mesh).fault_count, 0U);
}

TEST(WholeStream, MeshesThatDoNotFitAreErrors) {
  Mesh mesh = torus();
  mesh.offsets.pop_back();
  EXPECT_THROW(check(mesh), Failure);
  mesh = torus();
  mesh.corners[4] = 25;
  try {
    check(mesh);
    FAIL();
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), HasSubstr("triangle 1 names vertex 25"));
  }
}

TEST(WholeStream, OffsetsBeginWithTheFirstSimplexThatHasAny) {
  const Mesh mesh = torus();
  WholeStream stream(mesh);
  MeshStreamBlock block;
  ASSERT_TRUE(stream.read(block));
  EXPECT_EQ(block.corners.size(), mesh.corners.size());
  EXPECT_EQ(block.offsets.size(), mesh.corners.size() - 3U * 8);
  EXPECT_FALSE(stream.read(block));
}

}  // namespace
}  // namespace spillway::test
