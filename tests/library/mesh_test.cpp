// What a mesh in memory shows, against CGAL and from first principles.

#include <gtest/gtest.h>
#include <spillway/delaunay.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <ranges>

#include "src/geometry/canonical_hash.h"
#include "src/geometry/predicates.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/geometry/exact_sphere.h"
#include "tests/library/point_sets.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class InMemoryMesh : public ::testing::Test {};
TYPED_TEST_SUITE(InMemoryMesh, Dimensions, DimensionNames);

static_assert(std::ranges::forward_range<Cells<2, std::int32_t>>);
static_assert(std::ranges::sized_range<Cells<3, std::int64_t>>);

template <int D, class Index>
std::vector<std::array<VertexId, D + 1>> sorted_cells(const Delaunay<D, Index>& mesh) {
  std::vector<std::array<VertexId, D + 1>> cells;
  for (const auto cell : mesh.cells()) {
    auto& vertices = cells.emplace_back();
    std::copy(cell.vertices.begin(), cell.vertices.end(), vertices.begin());
    std::sort(vertices.begin(), vertices.end());
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

template <typename Range>
auto copy_of(const Range& range) {
  return std::vector(range.begin(), range.end());
}

TYPED_TEST(InMemoryMesh, CellsAreThoseOfCgal) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    EXPECT_EQ(sorted_cells(mesh), cgal_simplices<D>(points));
    EXPECT_EQ(mesh.hull_cells().size(), cgal_hull_facets<D>(points));
    EXPECT_EQ(mesh.hull_facets().size(), D * mesh.hull_cells().size());
    EXPECT_EQ(copy_of(mesh.points()), points);
    EXPECT_EQ(mesh.cells().size(), mesh.cell_count());
    EXPECT_EQ(mesh.vertex_count() + mesh.duplicates().size(), mesh.point_count());
  }
}

TYPED_TEST(InMemoryMesh, CellsArePositiveAndNeighboursShareTheFacetOppositeTheVertex) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    const auto cells = mesh.cells();
    std::int32_t number = 0;
    for (const auto cell : cells) {
      std::array<Point<D>, D + 1> corners;
      for (int i = 0; i <= D; ++i) corners[i] = points[cell.vertices[i]];
      ASSERT_EQ(orientation<D>(corners), 1);
      for (int i = 0; i <= D; ++i) {
        if (cell.neighbours[i] < 0) continue;
        const auto other = cells[cell.neighbours[i]];
        EXPECT_EQ(std::ranges::count(other.neighbours, number), 1);
        EXPECT_EQ(std::ranges::count(other.vertices, cell.vertices[i]), 0);
        for (int j = 0; j <= D; ++j) {
          if (j == i) continue;
          EXPECT_EQ(std::ranges::count(other.vertices, cell.vertices[j]), 1);
        }
      }
      ++number;
    }
  }
}

TYPED_TEST(InMemoryMesh, HullFacetsLookOutwardsAndBelongToTheirCells) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    const auto facets = mesh.hull_facets();
    const auto cells = mesh.hull_cells();
    EXPECT_TRUE(std::ranges::is_sorted(cells));
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(mesh.cell_neighbours(), -1)),
              cells.size());
    for (std::size_t f = 0; f < cells.size(); ++f) {
      std::array<Point<D>, D + 1> seen;
      const auto facet = facets.subspan(f * D, D);
      for (int i = 0; i < D; ++i) {
        seen[i] = points[facet[i]];
        EXPECT_EQ(std::ranges::count(mesh.cells()[cells[f]].vertices, facet[i]), 1);
      }
      // In space the first three of a positive simplex run counter-clockwise seen from the last; in
      // the plane the last lies on the left: of a facet seen from outside no point lies beyond.
      for (const Point<D>& p : points) {
        seen[D] = p;
        ASSERT_TRUE(D == 2 ? orientation<D>(seen) >= 0 : orientation<D>(seen) <= 0);
      }
    }
  }
}

TYPED_TEST(InMemoryMesh, DuplicatesNameTheFirstOfEqualPoints) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    std::map<Point<D>, std::int32_t> first;
    std::vector<Duplicate<std::int32_t>> expected;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(points.size()); ++i) {
      const auto [place, is_new] = first.emplace(points[i], i);
      if (!is_new) expected.push_back({i, place->second});
    }
    EXPECT_EQ(copy_of(Delaunay<D>(points).duplicates()), expected);
  }
}

TYPED_TEST(InMemoryMesh, VertexCellsAreTheLowest) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    std::vector<std::int32_t> expected(points.size(), -1);
    for (auto c = static_cast<std::int32_t>(mesh.cell_count()) - 1; c >= 0; --c) {
      for (const std::int32_t v : mesh.cells()[c].vertices) expected[v] = c;
    }
    EXPECT_EQ(copy_of(mesh.vertex_cells()), expected);
  }
}

TYPED_TEST(InMemoryMesh, HashIsThatOfTheSetOfCells) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    CanonicalHash<D> expected;
    for (const auto& cell : cgal_simplices<D>(points)) {
      std::array<Point<D>, D + 1> corners;
      for (int i = 0; i <= D; ++i) corners[i] = points[cell[i]];
      expected.add(corners);
    }
    EXPECT_EQ(Delaunay<D>(points).canonical_hash(), expected.value());
  }
}

TYPED_TEST(InMemoryMesh, CircumcentresAreNearTheExactOnes) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    const auto centres = mesh.circumcentres();
    ASSERT_EQ(centres.size(), mesh.cell_count());
    const std::size_t step = std::max<std::size_t>(1, mesh.cell_count() / 100);
    for (std::size_t c = 0; c < mesh.cell_count(); c += step) {
      EXPECT_EQ(mesh.circumcentre(static_cast<std::int32_t>(c)), centres[c]);
      std::array<Point<D>, D + 1> corners;
      for (int i = 0; i <= D; ++i) corners[i] = points[mesh.cells()[c].vertices[i]];
      const ExactSphere<D> exact(corners);
      for (int k = 0; k < D; ++k) {
        const double ulp = std::max(std::abs(centres[c][k]) * 0x1p-52, 0x1p-1074);
        const Rational error = abs(exact.centre[k] - Rational(centres[c][k])) - Rational(ulp);
        EXPECT_TRUE(error <= 0 ||
                    error * error <= exact.squared_radius * Rational(0x1p-40) * Rational(0x1p-40));
      }
    }
  }
}

TYPED_TEST(InMemoryMesh, PointsMayLieAsTheyDoInAProgram) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(300, 8);
  const auto expected = copy_of(Delaunay<D>(points).cell_vertices());

  std::array<std::vector<double>, D> axes, backwards;
  for (const auto& point : points) {
    for (int k = 0; k < D; ++k) axes[k].push_back(point[k]);
  }
  std::array<const double*, D> first, last;
  for (int k = 0; k < D; ++k) {
    first[k] = axes[k].data();
    backwards[k].assign(axes[k].rbegin(), axes[k].rend());
    last[k] = &backwards[k].back();
  }
  EXPECT_EQ(copy_of(Delaunay<D>({first, points.size()}).cell_vertices()), expected);
  constexpr std::ptrdiff_t kBack = -static_cast<std::ptrdiff_t>(sizeof(double));
  EXPECT_EQ(copy_of(Delaunay<D>({last, points.size(), kBack}).cell_vertices()), expected);

  constexpr std::size_t kRecord = D * sizeof(double) + 5;  // nothing is aligned
  std::vector<std::byte> records(kRecord * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(&records[i * kRecord + 3], points[i].data(), sizeof points[i]);
  }
  for (int k = 0; k < D; ++k) {
    const std::byte* const place = &records[3 + k * sizeof(double)];
    first[k] = reinterpret_cast<const double*>(place);
  }
  const PointView<D> view(first, points.size(), kRecord);
  EXPECT_EQ(view[17], points[17]);
  EXPECT_EQ(copy_of(Delaunay<D>(view).cell_vertices()), expected);
}

TYPED_TEST(InMemoryMesh, ResultDependsNeitherOnThreadsNorOnTheTypeOfNumbers) {
  constexpr int D = TypeParam::value;
  // Several base cases, and several ranges of cells.
  const Points<D> points = random_points<D>(D == 2 ? 300'000 : 140'000, 9);
  const Delaunay<D> one(points, {.threads = 1});
  for (const unsigned threads : {2U, 4U}) {
    const Delaunay<D> other(points, {.threads = threads});
    EXPECT_TRUE(std::ranges::equal(one.cell_vertices(), other.cell_vertices()));
    EXPECT_TRUE(std::ranges::equal(one.cell_neighbours(), other.cell_neighbours()));
    EXPECT_TRUE(std::ranges::equal(one.hull_facets(), other.hull_facets()));
    EXPECT_TRUE(std::ranges::equal(one.vertex_cells(), other.vertex_cells()));
    EXPECT_EQ(one.canonical_hash(), other.canonical_hash());
  }
  const Delaunay<D, std::int64_t> wide(points);
  EXPECT_TRUE(std::ranges::equal(one.cell_vertices(), wide.cell_vertices()));
  EXPECT_TRUE(std::ranges::equal(one.cell_neighbours(), wide.cell_neighbours()));
  EXPECT_TRUE(std::ranges::equal(one.vertex_cells(), wide.vertex_cells()));
}

TYPED_TEST(InMemoryMesh, MovesWithItsSpans) {
  constexpr int D = TypeParam::value;
  Delaunay<D> mesh(random_points<D>(50, 1));
  const auto vertices = mesh.cell_vertices();
  Delaunay<D> moved = std::move(mesh);
  EXPECT_EQ(moved.cell_vertices().data(), vertices.data());
  mesh = Delaunay<D>(random_points<D>(60, 2));
  EXPECT_EQ(mesh.point_count(), 60);
}

}  // namespace
}  // namespace spillway::test
