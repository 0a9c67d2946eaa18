#include "src/delaunay/common/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

class ConcurrentIndexTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(ConcurrentIndexTest, FindsAllItemsInsertedAtOnceInspiteOfEqualHashes) {
  with_threads(GetParam(), [] {
    constexpr std::size_t kCount = 20'000;
    ConcurrentIndex index(kCount);
    const auto hash = [](std::size_t i) { return mix64(i / 3); };
    parallel_for(kCount, 100, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        index.insert(hash(i), static_cast<std::uint32_t>(i));
      }
    });
    for (std::uint32_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(index.find(hash(i), [&](std::uint32_t item) { return item == i; }), i);
    }
    EXPECT_EQ(index.find(hash(0), [](std::uint32_t) { return false; }), ConcurrentIndex::kNotFound);
  });
}

INSTANTIATE_TEST_SUITE_P(Threads, ConcurrentIndexTest, ::testing::Values(1, 2, 4));

TEST(SimplexHash, SimplexesAreTheSameUpToEvenPermutationsOnly) {
  const std::array<VertexId, 4> simplex{7, 3, kInfiniteVertex, 0};
  std::array<int, 4> places{0, 1, 2, 3};
  do {
    int inversions = 0;
    std::array<VertexId, 4> other{};
    for (int i = 0; i < 4; ++i) {
      other[i] = simplex[places[i]];
      for (int j = 0; j < i; ++j) inversions += places[j] > places[i] ? 1 : 0;
    }
    EXPECT_EQ(same_simplex(simplex, other), inversions % 2 == 0);
    EXPECT_EQ(simplex_hash(simplex), simplex_hash(other));
    EXPECT_EQ(SortedVertices<4>(other).vertices,
              (std::array<VertexId, 4>{0, 3, 7, kInfiniteVertex}));
  } while (std::next_permutation(places.begin(), places.end()));
  EXPECT_FALSE(same_simplex<4>(simplex, {7, 3, kInfiniteVertex, 1}));
}

}  // namespace
}  // namespace spillway::test
