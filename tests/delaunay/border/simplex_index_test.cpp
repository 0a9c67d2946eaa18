#include "src/delaunay/border/simplex_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

using Index = SimplexIndex<3>;
using Corners = Index::Corners;

/// Triangles in which each vertex is in many.
std::vector<Corners> triangles(VertexId count) {
  std::vector<Corners> all;
  for (VertexId v = 0; v < count; ++v) {
    all.push_back({v, v + 1, v + 2});
    all.push_back({v + 2, v + 1, kInfiniteVertex});
  }
  return all;
}

TEST(SimplexIndex, FindsEachByItsNumberInBatchesOfAnySize) {
  const std::vector<Corners> simplices = triangles(5000);
  with_threads(3, [&] {
    const Index index(simplices);
    std::size_t size = 1;
    for (std::size_t first = 0; first < simplices.size(); first += size) {
      size = std::min(first % Index::kBatch + 1, simplices.size() - first);
      const auto found = index.find(std::span(simplices).subspan(first, size));
      for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(found[i], first + i);
    }
  });
}

TEST(SimplexIndex, LooksForTheSameSimplexThatFacesTheSameWay) {
  const std::vector<Corners> simplices = triangles(10);
  const Index index(simplices);
  const std::vector<Corners> wanted{
      {2, 0, 1}, {1, 0, 2}, {kInfiniteVertex, 2, 1}, {1, 2, kInfiniteVertex}, {0, 1, 3}, {0, 2, 3}};
  const auto found = index.find(wanted);
  EXPECT_EQ(found[0], 0U);
  EXPECT_EQ(found[1], Index::kNotFound);
  EXPECT_EQ(found[2], 1U);
  EXPECT_EQ(found[3], Index::kNotFound);
  EXPECT_EQ(found[4], Index::kNotFound);
  EXPECT_EQ(found[5], Index::kNotFound);
}

TEST(SimplexIndex, OfNothingFindsNothing) {
  const Index index({});
  EXPECT_EQ(index.find(std::vector<Corners>{{0, 1, 2}})[0], Index::kNotFound);
}

}  // namespace
}  // namespace spillway::test
