#include "stream/triangulate/settle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Triangle = std::array<VertexId, 3>;

/// A merge of a strip of triangles between the corners (0, 0), (0, 1), (1, 0), (1, 1), (2, 0), ...
Border<2> strip(VertexId vertices) {
  Border<2> border;
  border.dimension = 2;
  for (VertexId v = 0; v < vertices; ++v) {
    BorderVertex<2> vertex;
    vertex.position = {double(v / 2), double(v % 2)};
    vertex.height = 10.0 * v;
    vertex.input_index = 100 + v;
    border.vertices.push_back(vertex);
  }
  for (VertexId v = 0; v + 2 < vertices; ++v) border.simplices.push_back({v, v + 1, v + 2});
  return border;
}

Settled<2> settled(const Border<2>& merged, const std::vector<Fate>& fates,
                   const OutputOptions& output = {}) {
  return settle<2>(MergeToSettle<2>{.block = {7, 1}, .merged = merged, .fates = fates}, output);
}

TEST(Settle, FinalSimplicesAnnounceTheirVerticesAndOthersStay) {
  const Border<2> merged = strip(5);
  const Settled<2> result =
      settled(merged, {Fate::kFinal, Fate::kKept, Fate::kKept}, {.input_index = true});
  EXPECT_THAT(result.mesh.vertices,
              ElementsAre(LatticePoint{0, 0, 0}, LatticePoint{0, 1, 10}, LatticePoint{1, 0, 20}));
  EXPECT_THAT(result.mesh.input_index, ElementsAre(100, 101, 102));
  EXPECT_THAT(result.mesh.corners, ElementsAre(0, 1, 2));
  EXPECT_THAT(result.mesh.finalized, ElementsAre(0));
  EXPECT_THAT(result.imported, IsEmpty());
  EXPECT_EQ(result.final_simplices, 1U);
  ASSERT_EQ(result.border.vertices.size(), 4U);
  EXPECT_THAT(result.border.simplices, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 2, 3}));
  EXPECT_EQ(result.border.vertices[0].place.block, (BlockPlace{7, 1}));
  EXPECT_EQ(result.border.vertices[0].place.vertex, 1U);
  EXPECT_EQ(result.border.vertices[1].place.vertex, 2U);
  EXPECT_FALSE(result.border.vertices[2].place.announced());
}

TEST(Settle, VerticesCarryTheirAttributes) {
  Border<2> merged = strip(5);
  merged.vertices[0].place = {{2, 0}, 40};
  for (const int b : {10, 11, 20, 21, 30, 31, 40, 41, 50, 51}) {
    merged.attributes.push_back(static_cast<std::byte>(b));
  }
  const auto numbers = [](const std::vector<std::byte>& bytes) {
    std::vector<int> values;
    for (const std::byte b : bytes) values.push_back(std::to_integer<int>(b));
    return values;
  };
  const Settled<2> result = settled(merged, {Fate::kFinal, Fate::kKept, Fate::kKept},
                                    {.record_size = 2, .imported_vertices = true});
  EXPECT_THAT(numbers(result.mesh.attributes), ElementsAre(20, 21, 30, 31));
  EXPECT_THAT(numbers(result.imported_attributes), ElementsAre(10, 11));
  EXPECT_THAT(numbers(result.border.attributes), ElementsAre(20, 21, 30, 31, 40, 41, 50, 51));
  EXPECT_EQ(result.border.bytes(), strip(4).bytes() + 8);
}

TEST(Settle, VerticesThatAreInTheStreamAreImported) {
  Border<2> merged = strip(4);
  merged.vertices[1].place = {{2, 0}, 40};
  merged.vertices[3].place = {{3, 5}, 60};
  const Settled<2> result =
      settled(merged, {Fate::kFinal, Fate::kFinal}, {.imported_vertices = true});
  EXPECT_EQ(result.mesh.vertices.size(), 2U);
  ASSERT_EQ(result.imported.size(), 2U);
  EXPECT_EQ(result.imported[0].block, (BlockPlace{2, 0}));
  EXPECT_EQ(result.imported[0].vertex, 40U);
  EXPECT_EQ(result.imported[1].vertex, 60U);
  EXPECT_THAT(result.imported_vertices,
              ElementsAre(LatticePoint{0, 1, 10}, LatticePoint{1, 1, 30}));
  EXPECT_THAT(result.mesh.corners, ElementsAre(0, 2, 1, 2, 1, 3));
  EXPECT_THAT(result.mesh.finalized, ElementsAre(0, 2, 1, 3));
  EXPECT_THAT(result.border.vertices, IsEmpty());
}

TEST(Settle, AnInfiniteSimplexThatIsFinalIsAFacetOfTheHull) {
  Border<2> merged = strip(3);
  merged.simplices.push_back({1, 0, kInfiniteVertex});
  merged.simplices.push_back({2, 1, kInfiniteVertex});
  const Settled<2> result = settled(merged, {Fate::kFinal, Fate::kFinalFacet, Fate::kKept});
  EXPECT_EQ(result.hull_facets, 1U);
  EXPECT_EQ(result.final_simplices, 2U);
  EXPECT_THAT(result.mesh.corners, ElementsAre(0, 1, 2));
  EXPECT_THAT(result.border.simplices, ElementsAre(Triangle{1, 0, kInfiniteVertex}));
}

TEST(Settle, TooLongSimplicesAreLeftOutButTheirVerticesAreNot) {
  const Border<2> merged = strip(3);
  const Settled<2> result = settled(merged, {Fate::kFinal}, {.max_edge = 1.2});
  EXPECT_EQ(result.left_out, 1U);
  EXPECT_THAT(result.mesh.corners, IsEmpty());
  EXPECT_EQ(result.mesh.vertices.size(), 3U);
  EXPECT_THAT(result.mesh.finalized, ElementsAre(0, 1, 2));
}

TEST(Settle, EdgesAreMeasuredInOutputUnits) {
  const Border<2> merged = strip(3);
  const IntegerLattice lattice{{0.01, 0.01, 0.01}, {5, 5, 5}};
  const Settled<2> result = settled(merged, {Fate::kFinal}, {.lattice = lattice, .max_edge = 1.2});
  EXPECT_EQ(result.left_out, 0U);
  EXPECT_EQ(result.mesh.vertices[2], (LatticePoint{1, 0, 20})) << "vertices stay on the lattice";
}

}  // namespace
}  // namespace spillway::test
