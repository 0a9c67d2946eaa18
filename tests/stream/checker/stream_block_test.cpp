// What one block of a stream shows by itself: orientation, inner facets, and what stays open.

#include "stream/checker/stream_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/error.h"
#include "src/geometry/canonical_hash.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

StreamCoordinates<2> plain() { return {MeshStreamHeader{}, std::nullopt}; }

/// A block whose vertices are all new, after ten vertices and five simplices of other blocks.
template <int D>
StreamBlock<D> block_of(const std::vector<Point<D>>& points, std::vector<std::uint32_t> corners) {
  StreamBlock<D> block;
  block.first_vertex = 10;
  block.first_simplex = 5;
  block.points = points;
  block.block.vertices.resize(points.size());
  block.block.corners = std::move(corners);
  return block;
}

const std::vector<Point<2>> kKite = {{0, 0}, {2, -1}, {3, 0}, {2, 1}};
const std::vector<std::uint32_t> kKiteCorners = {0, 1, 3, 1, 2, 3};

TEST(SortedFacet, IsOddToOneSideAndEvenToTheOther) {
  const std::array<std::uint32_t, 6> triangles = {0, 1, 3, 1, 2, 3};
  const SortedFacet<2> left(triangles.data(), 0);
  const SortedFacet<2> right(triangles.data() + 3, 1);
  EXPECT_THAT(left.vertices, ElementsAre(1, 3));
  EXPECT_EQ(left.vertices, right.vertices);
  EXPECT_NE(left.odd, right.odd);
  const std::array<std::uint32_t, 4> tetrahedron = {9, 4, 6, 2};
  const SortedFacet<3> facet(tetrahedron.data(), 0);
  EXPECT_THAT(facet.vertices, ElementsAre(2, 4, 6));
  const std::array<std::uint32_t, 4> turned = {9, 6, 4, 2};
  EXPECT_NE(SortedFacet<3>(turned.data(), 0).odd, facet.odd);
}

TEST(StreamBlock, ProvesInnerFacetsAndLeavesTheOthersOpen) {
  StreamBlock<2> block = block_of<2>(kKite, kKiteCorners);
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_EQ(block.found.fault_count, 0U);
  EXPECT_EQ(block.inner_facets, 1U);
  EXPECT_EQ(block.not_delaunay, 0U);
  EXPECT_THAT(block.open, UnorderedElementsAre(1, 2, 3, 5));
  EXPECT_THAT(block.positive, ElementsAre(true, true));
  EXPECT_THAT(block.used, ElementsAre(true, true, true, true));
  CanonicalHash<2> hash;
  hash.add({kKite[0], kKite[1], kKite[3]});
  hash.add({kKite[1], kKite[2], kKite[3]});
  EXPECT_EQ(block.canonical_hash, hash.value());
}

TEST(StreamBlock, FindsAFacetThatIsNotDelaunay) {
  StreamBlock<2> block = block_of<2>(kKite, {0, 1, 2, 0, 2, 3});
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_EQ(block.not_delaunay, 1U);
  EXPECT_THAT(block.found.faults, ElementsAre(HasSubstr("triangle 6 (vertices 10, 12, 13")));
  EXPECT_THAT(block.found.faults, ElementsAre(HasSubstr("is not Delaunay: vertex 11 (2, -1)")));
}

TEST(StreamBlock, FindsSimplicesThatAreTurnedOrFlat) {
  StreamBlock<2> block = block_of<2>({{0, 0}, {1, 0}, {0, 1}, {2, 0}}, {1, 0, 2, 0, 1, 3});
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_EQ(block.not_positive, 2U);
  EXPECT_THAT(block.positive, ElementsAre(false, false));
  EXPECT_EQ(block.inner_facets, 0U) << "their facets prove nothing";
  EXPECT_THAT(block.found.faults,
              ElementsAre(HasSubstr("negatively oriented"), HasSubstr("degenerate")));
}

TEST(StreamBlock, FindsSimplicesOnOneSideOfTheirFacet) {
  StreamBlock<2> block = block_of<2>({{0, 0}, {1, 0}, {0, 1}, {0.2, 0.5}}, {0, 1, 2, 0, 1, 3});
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_THAT(block.found.faults, ElementsAre(HasSubstr("overlap: they lie on the same side")));
}

TEST(StreamBlock, NamesATwinOnce) {
  StreamBlock<3> block =
      block_of<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 3, 1, 2, 0, 3});
  block.examine({MeshStreamHeader{}, std::nullopt}, {}, StreamTask::kProve);
  EXPECT_THAT(block.found.faults, ElementsAre(HasSubstr("has the same vertices as tetrahedron 5")));
  EXPECT_THAT(block.open, SizeIs(4)) << "those of the first one, as if it were alone";
}

TEST(StreamBlock, DescribesOnlyTheFirstFaults) {
  StreamBlock<2> block = block_of<2>({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, {0, 1, 2, 1, 2, 3, 0, 1, 3});
  CheckerOptions options;
  options.most_faults = 2;
  block.examine(plain(), options, StreamTask::kProve);
  EXPECT_THAT(block.found.faults, SizeIs(2));
  EXPECT_EQ(block.found.fault_count, 3U);
}

TEST(StreamBlock, CountsWithoutLookingAtOrientation) {
  StreamBlock<2> block = block_of<2>(kKite, {0, 1, 2, 0, 3, 2});
  block.examine(plain(), {}, StreamTask::kCount);
  EXPECT_EQ(block.found.fault_count, 0U);
  EXPECT_EQ(block.inner_facets, 0U);
  EXPECT_THAT(block.open, SizeIs(4));
}

TEST(StreamBlock, CanBeUsedAgainForASmallerOne) {
  StreamBlock<2> block = block_of<2>(kKite, kKiteCorners);
  block.examine(plain(), {}, StreamTask::kProve);
  block.points = {{0, 0}, {1, 0}, {0, 1}, {5, 5}};
  block.block.corners = {0, 1, 2};
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_THAT(block.open, SizeIs(3));
  EXPECT_EQ(block.inner_facets, 0U);
  EXPECT_THAT(block.used, ElementsAre(true, true, true, false));
  block.block.corners.clear();
  block.examine(plain(), {}, StreamTask::kProve);
  EXPECT_THAT(block.open, IsEmpty());
}

TEST(StreamBlock, HashesOutputCoordinates) {
  MeshStreamHeader header;
  header.lattice = IntegerLattice{{0.5, 0.5, 1}, {10, 20, 0}};
  StreamBlock<2> block = block_of<2>({{0, 0}, {2, 0}, {0, 2}}, {0, 1, 2});
  block.examine({header, std::nullopt}, {}, StreamTask::kProve);
  CanonicalHash<2> hash;
  hash.add({Point<2>{10, 20}, Point<2>{11, 20}, Point<2>{10, 21}});
  EXPECT_EQ(block.canonical_hash, hash.value());
}

TEST(StreamBlock, RefusesCornersThatAreNoSimplices) {
  StreamBlock<2> block = block_of<2>(kKite, {0, 1, 3, 1});
  EXPECT_THROW(block.examine(plain(), {}, StreamTask::kProve), Failure);
}

}  // namespace
}  // namespace spillway::test
