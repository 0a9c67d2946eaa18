// The library's questions in four to six dimensions, against brute force with exact signs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/delaunay.h>
#include <spillway/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <type_traits>
#include <vector>

#include "src/geometry/distance.h"
#include "src/geometry/predicates.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class HigherDimension : public ::testing::Test {
 protected:
  static constexpr int kD = Dimension::value;
  using Points = std::vector<Point<kD>>;

  static Points random_points(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Points points(count);
    for (auto& p : points) {
      for (double& c : p) c = random.uniform(-3, 5);
    }
    return points;
  }
  /// A lattice with some points that come again.
  static Points lattice_points() {
    Random random(3);
    Points points(kD == 4 ? 120 : 60);
    for (auto& p : points) {
      for (double& c : p) c = static_cast<double>(random.integer(0, 2));
    }
    return points;
  }
  static std::vector<Points> sets() { return {random_points(20 * (8 - kD), 1), lattice_points()}; }
};

using Dimensions = ::testing::Types<std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(HigherDimension, Dimensions);

template <int D, class Index>
std::array<Point<D>, D + 1> corners_of(const Delaunay<D, Index>& mesh, std::size_t cell) {
  std::array<Point<D>, D + 1> corners;
  for (int i = 0; i <= D; ++i) corners[i] = mesh.points()[mesh.cells()[cell].vertices[i]];
  return corners;
}

TYPED_TEST(HigherDimension, CellsArePositiveEmptyAndKnowTheirNeighbours) {
  constexpr int D = TypeParam::value;
  for (const auto& points : TestFixture::sets()) {
    const Delaunay<D> mesh(points);
    const auto cells = mesh.cells();
    std::size_t hull = 0;
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
      const auto corners = corners_of(mesh, c);
      ASSERT_GT(orientation<D>(corners), 0);
      if (c % (D == 6 ? 97 : 7) == 0) {
        for (const Point<D>& p : points) ASSERT_LE(side_of_sphere<D>(corners, p), 0);
      }
      for (int i = 0; i <= D; ++i) {
        const std::int32_t other = cells[c].neighbours[i];
        if (other < 0) {
          ++hull;
          continue;
        }
        const auto theirs = cells[other].neighbours;
        const auto back = std::ranges::find(theirs, static_cast<std::int32_t>(c));
        ASSERT_NE(back, theirs.end());
        std::multiset<std::int32_t> facet(cells[c].vertices.begin(), cells[c].vertices.end());
        facet.erase(cells[c].vertices[i]);
        std::multiset<std::int32_t> same(cells[other].vertices.begin(),
                                         cells[other].vertices.end());
        same.erase(cells[other].vertices[back - theirs.begin()]);
        ASSERT_EQ(facet, same);
      }
    }
    ASSERT_EQ(mesh.hull_facets().size(), hull * D);
    for (std::size_t f = 0; f < hull; f += 11) {
      std::array<Point<D>, D + 1> seen;
      for (int i = 0; i < D; ++i) seen[i] = points[mesh.hull_facets()[f * D + i]];
      for (const Point<D>& p : points) {
        seen[D] = p;
        const int side = orientation<D>(seen);
        ASSERT_GE(D % 2 == 0 ? side : -side, 0);
      }
    }
  }
}

TYPED_TEST(HigherDimension, LocateAndNearestVertexAreExact) {
  constexpr int D = TypeParam::value;
  for (const auto& points : TestFixture::sets()) {
    const Delaunay<D> mesh(points);
    auto places = TestFixture::random_points(12, 9);
    places.push_back(points[3]);
    places.push_back(mesh.circumcentre(0));
    places.emplace_back().fill(1);  // a point of the lattice, or on many facets
    places.emplace_back().fill(1e9);
    const std::vector<std::int32_t> cells = mesh.locate(PointView<D>(places));
    const std::vector<std::int32_t> nearest = mesh.nearest_vertex(PointView<D>(places));
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::int32_t lowest = -1;
      for (std::size_t c = 0; c < mesh.cell_count() && lowest < 0; ++c) {
        bool inside = true;
        for (int k = 0; k <= D && inside; ++k) {
          auto replaced = corners_of(mesh, c);
          replaced[k] = places[i];
          inside = orientation<D>(replaced) >= 0;
        }
        if (inside) lowest = static_cast<std::int32_t>(c);
      }
      EXPECT_EQ(cells[i], lowest);
      std::int32_t best = 0;
      for (std::size_t v = 1; v < points.size(); ++v) {
        if (compare_distances<D>(places[i], points[v], points[best]) < 0) {
          best = static_cast<std::int32_t>(v);
        }
      }
      EXPECT_EQ(nearest[i], best);
    }
  }
}

TYPED_TEST(HigherDimension, InterpolationReproducesLinearFunctions) {
  constexpr int D = TypeParam::value;
  const auto function = [](const Point<D>& p) {
    double value = 2;
    for (int k = 0; k < D; ++k) value += (k - 2.5) * p[k];
    return value;
  };
  for (const auto& points : TestFixture::sets()) {
    const Delaunay<D> mesh(points);
    std::vector<double> values(points.size());
    std::ranges::transform(points, values.begin(), function);
    auto places = TestFixture::random_points(200, 5);
    for (auto& p : places) {
      for (double& c : p) c = 1 + (c - 1) / 10;  // most of them inside
    }
    places.push_back(points[5]);
    const auto found = mesh.interpolate(values, PointView<D>(places));
    std::size_t inside = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (mesh.locate(places[i]) < 0) {
        EXPECT_TRUE(std::isnan(found[i]));
        continue;
      }
      ++inside;
      EXPECT_NEAR(found[i], function(places[i]), 1e-9);
    }
    EXPECT_GT(inside, 20U);
    EXPECT_EQ(found.back(), function(points[5]));
  }
}

TYPED_TEST(HigherDimension, ThreadsAndWiderNumbersChangeNothing) {
  constexpr int D = TypeParam::value;
  const auto points = TestFixture::random_points(D == 4 ? 2000 : D == 5 ? 200 : 60, 2);
  const Delaunay<D> one(points, {.threads = 1});
  const Delaunay<D> two(points, {.threads = 2});
  const Delaunay<D, std::int64_t> wide(points);
  EXPECT_THAT(two.cell_vertices(), ::testing::ElementsAreArray(one.cell_vertices()));
  EXPECT_EQ(wide.canonical_hash(), one.canonical_hash());
  const auto centres = one.circumcentres();
  ASSERT_EQ(centres.size(), one.cell_count());
  for (std::size_t c = 0; c < centres.size(); c += 101) {
    EXPECT_EQ(centres[c], one.circumcentre(static_cast<std::int32_t>(c)));
  }
}

TYPED_TEST(HigherDimension, PointsOfAHyperplaneAreRefusedByName) {
  constexpr int D = TypeParam::value;
  auto points = TestFixture::lattice_points();
  for (auto& p : points) p[D - 1] = p[0];
  try {
    const Delaunay<D> mesh(points);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDegenerateInput);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("in " + std::to_string(D - 1) + " dimensions"));
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("no simplex of " + std::to_string(D) + " dimensions"));
  }
}

}  // namespace
}  // namespace spillway::test
