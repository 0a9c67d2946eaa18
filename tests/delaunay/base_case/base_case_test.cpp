#include "src/delaunay/base_case/base_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace spillway::test {
namespace {

template <int D>
BaseCase<D> triangulated(const std::vector<Point<D>>& points,
                         std::vector<VertexId> input_index = {}) {
  if (input_index.empty()) {
    input_index.resize(points.size());
    std::iota(input_index.begin(), input_index.end(), VertexId{0});
  }
  return triangulate_base_case<D>(
      {.points = points, .input_index = input_index, .first_vertex = 100});
}

TEST(BaseCase, OfATriangleHasItsThreeInfiniteNeighbours) {
  const auto t = triangulated<2>({{0, 0}, {1, 0}, {0, 1}});
  EXPECT_EQ(t.dimension, 2);
  EXPECT_EQ(t.simplices.size(), 4U);
  EXPECT_EQ(t.hull.size(), 3U);
  for (const Simplex<2>& s : t.simplices) {
    for (const VertexId v : s.vertices) EXPECT_TRUE(v == kInfiniteVertex || (v >= 100 && v < 103));
  }
}

TEST(BaseCase, OfATetrahedronHasItsFourInfiniteNeighbours) {
  const auto t = triangulated<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_EQ(t.simplices.size(), 5U);
  EXPECT_EQ(t.hull.size(), 4U);
}

TEST(BaseCase, OfCollinearPointsHasNoSimplices) {
  const auto t = triangulated<3>({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}});
  EXPECT_EQ(t.dimension, 1);
  EXPECT_TRUE(t.simplices.empty());
  EXPECT_THAT(t.duplicates, ::testing::ElementsAre(DroppedDuplicate{103, 101}));
}

TEST(BaseCase, KeepsTheDuplicateOfLowestInputIndex) {
  const auto flat = triangulated<2>({{5, 5}, {5, 5}, {5, 5}}, {9, 3, 6});
  EXPECT_THAT(flat.duplicates,
              ::testing::ElementsAre(DroppedDuplicate{100, 101}, DroppedDuplicate{102, 101}));
  const auto full =
      triangulated<2>({{5, 5}, {0, 0}, {5, 5}, {9, 0}, {5, 5}, {5, 9}}, {8, 1, 4, 2, 0, 5});
  EXPECT_THAT(full.duplicates,
              ::testing::ElementsAre(DroppedDuplicate{100, 104}, DroppedDuplicate{102, 104}));
  for (const Simplex<2>& s : full.simplices) {
    EXPECT_THAT(s.vertices, ::testing::Not(::testing::Contains(::testing::AnyOf(100U, 102U))));
  }
}

TEST(BaseCase, IsFastForManyCollinearPointsAndOneBeside) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 200'000; ++i) points.push_back({static_cast<double>(i), 0});
  points.push_back({3, 1});
  const auto t = triangulated<2>(points);
  EXPECT_EQ(t.simplices.size(), 2 * points.size() - 2);
}

}  // namespace
}  // namespace spillway::test
