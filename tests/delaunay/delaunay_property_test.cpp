// The contract: for every input one triangulation, CGAL's, whatever the options.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/delaunay/verify.h"
#include "tests/generators/family_cases.h"

namespace spillway::test {
namespace {

template <int D>
std::vector<std::array<VertexId, D + 1>> finite_simplices(const Triangulation<D>& t) {
  std::vector<std::array<VertexId, D + 1>> simplices;
  t.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    auto& s = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) s[i] = t.input_index[simplex.vertices[i]];
    std::sort(s.begin(), s.end());
  });
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// Triangulates in several ways and compares each with CGAL's set of simplices.
template <int D>
void expect_equal_to_cgal(const std::vector<Point<D>>& points,
                          const std::vector<DivideAndConquerOptions>& ways) {
  const auto expected = cgal_simplices<D>(points);
  const std::size_t hull_facets = cgal_hull_facets<D>(points);
  for (const DivideAndConquerOptions& options : ways) {
    SCOPED_TRACE(::testing::Message()
                 << points.size() << " points, base case " << options.leaf_points << ", "
                 << options.threads << " threads, " << options.children << " children, division "
                 << static_cast<int>(options.division));
    const Triangulation<D> t = delaunay_triangulation<D>(points, options);
    ASSERT_TRUE(finite_simplices(t) == expected)
        << t.finite_count() << " simplices, CGAL has " << expected.size();
    EXPECT_EQ(t.hull.size(), hull_facets);
    if (points.size() <= 3000) {
      EXPECT_THAT(verify(t), ::testing::IsEmpty());
    }
  }
}

const std::vector<DivideAndConquerOptions> kManyWays = {
    {.threads = 1, .leaf_points = 10},
    {.threads = 2, .leaf_points = 10, .children = 8},
    {.threads = 4, .leaf_points = 25, .division = Division::kCyclingAxis},
    {.threads = 2, .leaf_points = 40, .division = Division::kConstantAxis, .children = 3},
    {.threads = 4, .leaf_points = 300, .children = 4},
};

std::uint64_t large_count(const FamilyCase& tested) {
  if (tested.family == Family::kCollinear) return 2'000;  // CGAL takes quadratic time
  const bool dense = tested.family == Family::kLines && tested.dimension == 3;
  return dense ? 1'000 : 100'000;  // lines in space have n^2/4 tetrahedra
}

class DelaunayOfFamily : public ::testing::TestWithParam<FamilyCase> {};

TEST_P(DelaunayOfFamily, EqualsCgalForSmallSets) {
  for (const std::uint64_t n : {0, 1, 2, 3, 4, 5, 7, 12, 30, 100, 500, 2000}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const GeneratorOptions generate{GetParam().family, n, GetParam().dimension, seed};
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      if (GetParam().dimension == 2) {
        expect_equal_to_cgal<2>(generated_points<2>(generate), kManyWays);
      } else if (n <= 100 || seed == 1) {
        expect_equal_to_cgal<3>(generated_points<3>(generate), kManyWays);
      }
    }
  }
}

TEST_P(DelaunayOfFamily, EqualsCgalForLargeSets) {
  const std::vector<DivideAndConquerOptions> ways = {
      {.threads = 2},
      {.threads = 1, .leaf_points = 3000},
      {.threads = 4, .leaf_points = 500, .children = 4}};
  for (const std::uint64_t seed : {7, 8}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const GeneratorOptions generate{GetParam().family, large_count(GetParam()),
                                    GetParam().dimension, seed};
    if (GetParam().dimension == 2) {
      expect_equal_to_cgal<2>(generated_points<2>(generate), ways);
    } else {
      expect_equal_to_cgal<3>(generated_points<3>(generate), ways);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, DelaunayOfFamily, ::testing::ValuesIn(all_family_cases()),
                         family_case_name);

/// Degenerate sets that no generator makes.
template <typename Dimension>
class DelaunayOfDegenerateSet : public ::testing::Test {
 protected:
  static constexpr int kD = Dimension::value;
  using Points = std::vector<Point<kD>>;

  static Points random_integers(std::size_t n, std::array<int, 3> extent, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Points points(n);
    for (auto& p : points) {
      for (int k = 0; k < kD; ++k) {
        p[k] = static_cast<double>(random() % static_cast<std::uint64_t>(extent[k]));
      }
    }
    return points;
  }
};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DelaunayOfDegenerateSet, Dimensions);

TYPED_TEST(DelaunayOfDegenerateSet, EqualsCgalOnTinyLatticesWithDuplicates) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const int side = 2 + static_cast<int>(seed % 5);
    expect_equal_to_cgal<TestFixture::kD>(
        TestFixture::random_integers(5 + 3 * seed, {side, side, side}, seed), kManyWays);
  }
}

TYPED_TEST(DelaunayOfDegenerateSet, EqualsCgalWhenPartsAreSingleLinesOrPlanes) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    expect_equal_to_cgal<TestFixture::kD>(TestFixture::random_integers(300, {3, 40, 40}, seed),
                                          kManyWays);
    expect_equal_to_cgal<TestFixture::kD>(TestFixture::random_integers(300, {2, 2, 300}, seed),
                                          kManyWays);
  }
}

TYPED_TEST(DelaunayOfDegenerateSet, EqualsCgalAtHugeOffsets) {
  auto points = TestFixture::random_integers(2000, {50, 50, 50}, 5);
  for (auto& p : points) {
    for (double& x : p) x = x * 0.125 + 4'123'456'789.0;
  }
  expect_equal_to_cgal<TestFixture::kD>(points, kManyWays);
}

TYPED_TEST(DelaunayOfDegenerateSet, EqualsCgalOnTightClustersFarApart) {
  auto points = TestFixture::random_integers(2000, {1000, 1000, 1000}, 6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (double& x : points[i]) x = x * 1e-9 + static_cast<double>(i % 7) * 1000;
  }
  expect_equal_to_cgal<TestFixture::kD>(points, kManyWays);
}

TYPED_TEST(DelaunayOfDegenerateSet, HasNoSimplicesIfAllPointsLieOnOneLine) {
  std::vector<Point<TestFixture::kD>> points(200);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].fill(static_cast<double>(i / 2));
  for (const DivideAndConquerOptions& options : kManyWays) {
    const auto t = delaunay_triangulation<TestFixture::kD>(points, options);
    EXPECT_EQ(t.dimension, 1);
    EXPECT_EQ(t.finite_count(), 0U);
    EXPECT_EQ(t.vertex_count(), 100U);
  }
}

TYPED_TEST(DelaunayOfDegenerateSet, SurvivesAllPointsEqual) {
  const std::vector<Point<TestFixture::kD>> points(100);
  for (const DivideAndConquerOptions& options : kManyWays) {
    const auto t = delaunay_triangulation<TestFixture::kD>(points, options);
    EXPECT_EQ(t.dimension, 0);
    EXPECT_EQ(t.vertex_count(), 1U);
    ASSERT_EQ(t.duplicates.size(), 99U);
    EXPECT_EQ(t.input_index[t.duplicates.front().kept], 0U);
  }
}

TYPED_TEST(DelaunayOfDegenerateSet, KeepsTheFirstOfEqualPoints) {
  const auto points = TestFixture::random_integers(1000, {6, 6, 6}, 3);
  const auto t = delaunay_triangulation<TestFixture::kD>(points, {.leaf_points = 20});
  for (const DroppedDuplicate& d : t.duplicates) {
    const auto first = std::find(points.begin(), points.end(), t.points[d.kept]);
    EXPECT_EQ(t.input_index[d.kept], static_cast<VertexId>(first - points.begin()));
    EXPECT_EQ(t.points[d.kept], t.points[d.dropped]);
  }
  EXPECT_THAT(verify(t), ::testing::IsEmpty());
}

TYPED_TEST(DelaunayOfDegenerateSet, ListsTheSameSimplicesInTheSameOrderForAnyThreadCount) {
  const auto points = TestFixture::random_integers(20000, {400, 400, 400}, 9);
  const auto once =
      delaunay_triangulation<TestFixture::kD>(points, {.threads = 1, .leaf_points = 500});
  for (const unsigned threads : {2U, 4U}) {
    const auto again =
        delaunay_triangulation<TestFixture::kD>(points, {.threads = threads, .leaf_points = 500});
    ASSERT_EQ(once.lists.size(), again.lists.size());
    EXPECT_TRUE(std::ranges::equal(once.input_index, again.input_index));
    EXPECT_EQ(once.hull, again.hull);
    for (std::size_t b = 0; b < once.lists.size(); ++b) {
      ASSERT_EQ(once.lists[b].simplices.size(), again.lists[b].simplices.size());
      for (std::size_t i = 0; i < once.lists[b].simplices.size(); ++i) {
        ASSERT_EQ(once.lists[b].simplices[i].vertices, again.lists[b].simplices[i].vertices);
      }
    }
  }
}

/// Triangulates points twice, the second time with the memory of the first. Returns how many slabs
/// the second one took over.
template <int D>
std::size_t slabs_taken_over(const DivideAndConquerOptions& options) {
  const auto points = generated_points<D>({.family = Family::kUniform, .count = 30'000});
  Triangulation<D> first = delaunay_triangulation<D>(points, options);
  const auto expected = finite_simplices(first);
  std::set<const void*> places;
  for (const SimplexList<D>& list : first.lists) places.insert(list.simplices.data());
  recycle(std::move(first));
  EXPECT_TRUE(places.contains(BorrowedSlab(SlabUse::kSimplices, 1)->data()));
  const Triangulation<D> second = delaunay_triangulation<D>(points, options);
  EXPECT_TRUE(finite_simplices(second) == expected);
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 1)->capacity(), 0U);
  return std::count_if(second.lists.begin(), second.lists.end(),
                       [&](const auto& list) { return places.contains(list.simplices.data()); });
}

TEST(RecycledTriangulation, LeavesItsMemoryToTheNextOne) {
  EXPECT_EQ(slabs_taken_over<2>({.threads = 1}), 1);
  EXPECT_EQ(slabs_taken_over<3>({.threads = 1}), 1);
}

TEST(RecycledTriangulation, OfManyBaseCasesLeavesItsMemoryToTheNextOne) {
  EXPECT_GE(slabs_taken_over<2>({.threads = 1, .leaf_points = 4'000}), 5);
  EXPECT_GE(slabs_taken_over<3>({.threads = 1, .leaf_points = 4'000}), 5);
}

TEST(RecycledTriangulation, IsGivenBackByARefusedCall) {
  const auto points = generated_points<2>({.family = Family::kUniform, .count = 1'000});
  recycle(delaunay_triangulation<2>(points));
  const std::span<const Point<2>> too_many(points.data(), kMaxVertices + std::size_t{1});
  EXPECT_THROW(delaunay_triangulation<2>(too_many), Failure);
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 1)->capacity(), 0U);
}

}  // namespace
}  // namespace spillway::test
