// A mesh in memory as a stream of one block.

#include "stream/library/meshes/whole_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace spillway::test {
namespace {

TEST(WholeMesh, CountsFacetsThatOneSimplexHasAlone) {
  Mesh square;
  square.header.dimension = 2;
  square.corners = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(count_boundary_facets(square), 4U);
  Mesh tetrahedra;
  tetrahedra.header.dimension = 3;
  tetrahedra.corners = {0, 1, 2, 3, 1, 2, 3, 4};
  EXPECT_EQ(count_boundary_facets(tetrahedra), 6U);
}

TEST(WholeMesh, GivesWhatItsVerticesCarry) {
  Mesh mesh;
  mesh.header.attributes = AttributeLayout({{.name = "height", .type = NumberType::kUint8}});
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.corners = {0, 1, 2};
  mesh.attributes = {std::byte{7}, std::byte{8}, std::byte{9}};
  const std::vector<std::byte> expected = mesh.attributes;
  WholeMesh stream(std::move(mesh), "a", false);
  EXPECT_NE(stream.header().attributes.find("height"), nullptr);
  MeshStreamBlock block;
  ASSERT_TRUE(stream.read(block));
  EXPECT_EQ(block.attributes, expected);
  EXPECT_FALSE(stream.read(block));
}

TEST(WholeMesh, HasSimplicesAcrossThePeriodicBoxAtTheEnd) {
  // A row of four squares whose ends are one, each of two triangles; it is open along y.
  Mesh mesh;
  mesh.header.dimension = 2;
  mesh.header.periodic =
      PeriodicBox{.box = {{0, 0, 0}, {4, 0, 0}}, .periodic = {true, false, false}};
  for (std::uint64_t x = 0; x < 4; ++x) {
    mesh.vertices.push_back({double(x), 0, 0});
    mesh.vertices.push_back({double(x), 1, 0});
  }
  const CornerOffset beyond = corner_offset(std::array{1, 0});
  for (std::uint64_t square = 3; square < 7; ++square) {
    const std::uint64_t x = square % 4;
    const std::uint64_t next = (x + 1) % 4;
    const CornerOffset there = x == 3 ? beyond : kNoOffset;
    mesh.corners.insert(mesh.corners.end(),
                        {2 * x, 2 * next, 2 * next + 1, 2 * x, 2 * next + 1, 2 * x + 1});
    mesh.offsets.insert(mesh.offsets.end(), {kNoOffset, there, there, kNoOffset, there, kNoOffset});
  }
  EXPECT_EQ(count_boundary_facets(mesh), 8U);
  WholeMesh stream(mesh, "a", true);
  EXPECT_EQ(stream.totals().hull_facets, 8U);
  EXPECT_EQ(stream.header().periodic, mesh.header.periodic);
  MeshStreamBlock block;
  ASSERT_TRUE(stream.read(block));
  EXPECT_EQ(block.corners.size(), 24U);
  EXPECT_EQ(block.offsets, (std::vector{kNoOffset, beyond, beyond, kNoOffset, beyond, kNoOffset}));
  EXPECT_EQ(std::vector(block.corners.end() - 6, block.corners.end()),
            (std::vector<std::uint32_t>{6, 0, 1, 6, 1, 7}));
}

TEST(WholeMesh, ComesInSeveralBlocksWhereOneWouldBeTooLarge) {
  // Each vertex carries a page, and all together more than a block holds.
  constexpr std::size_t kVertices = 40'000;
  Mesh mesh;
  mesh.header.attributes =
      AttributeLayout({{.name = "page", .type = NumberType::kUint8, .elements = 4096}});
  for (std::size_t i = 0; i < kVertices; ++i) mesh.vertices.push_back({double(i), 0, 0});
  mesh.corners = {0, 20'000, 39'999};
  mesh.attributes.resize(kVertices * mesh.header.attributes.record_size());
  WholeMesh stream(std::move(mesh), "a", false);
  MeshStreamBlock block;
  std::size_t vertices = 0;
  std::size_t blocks = 0;
  for (; stream.read(block); ++blocks) vertices += block.vertices.size();
  EXPECT_EQ(vertices, kVertices);
  EXPECT_GT(blocks, 1U);
  EXPECT_EQ(block.corners.size(), 3U) << "the last block has the triangle";
}

}  // namespace
}  // namespace spillway::test
