// More than three dimensions: the sets of simplices are CGAL's where no points are cospherical, and
// where they are, one set whatever the way and the order.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/delaunay/verify.h"
#include "tests/geometry/exact_sphere.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

template <int D>
using Points = std::vector<Point<D>>;
template <int D>
using Simplices = std::vector<std::array<VertexId, D + 1>>;

/// The finite simplices by numbers of the input, sorted.
template <int D>
Simplices<D> simplices_of(const Triangulation<D>& t) {
  Simplices<D> simplices;
  t.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    auto& s = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) s[i] = t.input_index[simplex.vertices[i]];
    std::ranges::sort(s);
  });
  std::ranges::sort(simplices);
  return simplices;
}

const std::vector<DivideAndConquerOptions> all_ways = {
    {.threads = 1},
    {.threads = 2, .leaf_points = 12},
    {.threads = 2, .leaf_points = 30, .children = 4},
    {.threads = 4, .leaf_points = 60, .division = Division::kCyclingAxis},
};

/// About normally distributed.
double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

template <int D>
struct Family {
  std::string name;
  std::function<Point<D>(Random&)> point;
};

template <int D>
Point<D> filled(const std::function<double()>& coordinate) {
  Point<D> p;
  for (double& c : p) c = coordinate();
  return p;
}

template <int D>
Point<D> on_sphere(Random& random) {
  Point<D> p = filled<D>([&] { return normal(random); });
  const double length = std::sqrt(squared_length(p));
  for (double& c : p) c /= length;
  return p;
}

/// Of points in general position, though some nearly are not.
template <int D>
std::vector<Family<D>> general_families() {
  return {
      {"uniform", [](Random& r) { return filled<D>([&] { return r.uniform(-3, 5); }); }},
      {"normal", [](Random& r) { return filled<D>([&] { return normal(r); }); }},
      {"sphere", on_sphere<D>},
      {"far", [](Random& r) { return filled<D>([&] { return 4e6 + r.uniform(); }); }},
      {"clusters",
       [](Random& r) {
         const double corner = 100.0 * static_cast<double>(r.integer(0, 2));
         return filled<D>([&] { return corner + r.uniform() * 1e-3; });
       }},
      {"nearly flat",
       [](Random& r) {
         Point<D> p = filled<D>([&] { return r.uniform(); });
         p[D - 1] = p[0] - p[1] + r.uniform() * 1e-9;
         return p;
       }},
      {"long",  // as parameters of different units are
       [](Random& r) {
         Point<D> p = filled<D>([&] { return r.uniform(); });
         p[1] *= 1e7;
         p[2] *= 1e-5;
         return p;
       }},
  };
}

template <typename Dimension>
class KernelOfHigherDimension : public ::testing::Test {
 protected:
  static constexpr int kD = Dimension::value;
  /// What CGAL takes a second for or less.
  static constexpr std::size_t kMany = kD == 4 ? 600 : kD == 5 ? 120 : 45;

  static Points<kD> points_of(const Family<kD>& family, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Points<kD> points(count);
    for (auto& p : points) p = family.point(random);
    return points;
  }

  static Points<kD> lattice(std::size_t count, std::int64_t side, std::uint64_t seed) {
    Random random(seed);
    Points<kD> points(count);
    for (auto& p : points) {
      for (double& c : p) c = static_cast<double>(random.integer(0, side - 1));
    }
    return points;
  }

  /// Every way gives the same set, and one that is right by itself. Returns it.
  static Simplices<kD> set_of_every_way(const Points<kD>& points) {
    Simplices<kD> first = simplices_of(delaunay_triangulation<kD>(points, all_ways[0]));
    for (const DivideAndConquerOptions& way : all_ways) {
      const Triangulation<kD> t = delaunay_triangulation<kD>(points, way);
      EXPECT_TRUE(simplices_of(t) == first) << "base cases of " << way.leaf_points;
      EXPECT_THAT(verify(t), ::testing::IsEmpty()) << "base cases of " << way.leaf_points;
    }
    return first;
  }
};

using Dimensions = ::testing::Types<std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(KernelOfHigherDimension, Dimensions);

TYPED_TEST(KernelOfHigherDimension, EqualsCgalOnPointsInGeneralPosition) {
  constexpr int D = TypeParam::value;
  for (const Family<D>& family : general_families<D>()) {
    for (const std::size_t count : {std::size_t{D + 1}, std::size_t{D + 2}, std::size_t{D + 3},
                                    std::size_t{3} * D, TestFixture::kMany}) {
      SCOPED_TRACE(family.name + ", " + std::to_string(count) + " points");
      const Points<D> points = TestFixture::points_of(family, count, 7 + count);
      EXPECT_TRUE(TestFixture::set_of_every_way(points) == cgal_simplices<D>(points));
    }
  }
}

TYPED_TEST(KernelOfHigherDimension, EqualsCgalWithDuplicates) {
  constexpr int D = TypeParam::value;
  Points<D> points = TestFixture::points_of(general_families<D>()[0], TestFixture::kMany / 2, 3);
  Random random(5);
  for (std::size_t i = 0, count = points.size(); i < count; ++i) {
    points.push_back(points[random.bits() % points.size()]);
  }
  const Triangulation<D> t = delaunay_triangulation<D>(points, all_ways[1]);
  EXPECT_EQ(t.vertex_count(), TestFixture::kMany / 2);
  EXPECT_TRUE(TestFixture::set_of_every_way(points) == cgal_simplices<D>(points));
}

/// A point in the midst of a sphere is a neighbour of all on it: the kernel has three ways to join
/// stars of up to 64, up to 128 and more vertices.
TYPED_TEST(KernelOfHigherDimension, EqualsCgalWhereStarsHaveManyVertices) {
  constexpr int D = TypeParam::value;
  for (const std::size_t count : {std::size_t{90}, std::size_t{D == 6 ? 130 : 300}}) {
    SCOPED_TRACE(count);
    Random random(8);
    Points<D> points(count);
    for (auto& p : points) p = on_sphere<D>(random);
    for (int i = 0; i < 4; ++i) {
      points.push_back(filled<D>([&] { return random.uniform(-1e-3, 1e-3); }));
    }
    EXPECT_TRUE(simplices_of(delaunay_triangulation<D>(points)) == cgal_simplices<D>(points));
  }
}

TYPED_TEST(KernelOfHigherDimension, LatticesHaveOneTriangulationWhateverTheWayAndTheOrder) {
  constexpr int D = TypeParam::value;
  for (const std::int64_t side : {2, 3, 5}) {
    SCOPED_TRACE(side);
    Points<D> points = TestFixture::lattice(D == 4 ? 150 : D == 5 ? 90 : 60, side, 11);
    const auto coordinates_of = [&](const Simplices<D>& simplices) {
      std::vector<std::array<Point<D>, D + 1>> all;
      for (const auto& simplex : simplices) {
        auto& corners = all.emplace_back();
        for (int i = 0; i <= D; ++i) corners[i] = points[simplex[i]];
        std::ranges::sort(corners);
      }
      std::ranges::sort(all);
      return all;
    };
    const auto expected = coordinates_of(TestFixture::set_of_every_way(points));
    EXPECT_FALSE(expected.empty());
    std::ranges::reverse(points);
    EXPECT_TRUE(coordinates_of(TestFixture::set_of_every_way(points)) == expected);
    std::rotate(points.begin(), points.begin() + 17, points.end());
    EXPECT_TRUE(coordinates_of(TestFixture::set_of_every_way(points)) == expected);
  }
}

TYPED_TEST(KernelOfHigherDimension, TheCubeHasCoordinatesOfAnySizeAndPlace) {
  constexpr int D = TypeParam::value;
  Points<D> points(std::size_t{1} << D);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < D; ++k) points[i][k] = static_cast<double>(i >> k & 1);
  }
  const Simplices<D> expected = TestFixture::set_of_every_way(points);
  for (const double scale : {0x1p-1040, 0.25, 0x1p1000}) {
    if (D == 6 && scale < 0x1p-1000) continue;  // all of it in big integers takes long
    Points<D> scaled = points;
    for (auto& p : scaled) {
      for (double& c : p) c = c * scale;
    }
    EXPECT_TRUE(TestFixture::set_of_every_way(scaled) == expected) << scale;
  }
  for (auto& p : points) {
    for (double& c : p) c += 0x1p50;
  }
  EXPECT_TRUE(TestFixture::set_of_every_way(points) == expected);
}

TYPED_TEST(KernelOfHigherDimension, PointsOfFewerDimensionsHaveNoSimplices) {
  constexpr int D = TypeParam::value;
  for (int dimension = 0; dimension < D; ++dimension) {
    Points<D> points = TestFixture::lattice(100, 4, 2);
    for (auto& p : points) {
      for (int k = dimension; k < D; ++k) {  // sums of the others
        p[k] = 7;
        for (int j = 0; j < dimension; ++j) p[k] += (j + k) * p[j];
      }
    }
    for (const DivideAndConquerOptions& way : all_ways) {
      const auto t = delaunay_triangulation<D>(points, way);
      EXPECT_EQ(t.dimension, dimension);
      EXPECT_EQ(t.finite_count(), 0U);
    }
  }
}

TYPED_TEST(KernelOfHigherDimension, ClaimsOnlySpheresInsideTheSafeBox) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kStep = D == 4 ? 16 : D == 5 ? 64 : 1024;  // rationals take long
  for (const Family<D>& family : general_families<D>()) {
    SCOPED_TRACE(family.name);
    const Points<D> points = TestFixture::points_of(family, 12 * D, 4);
    std::vector<VertexId> index(points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    Box<D> box;
    for (const auto& p : points) box.expand(p);
    for (const double margin : {-0.2, 0.0, 0.3, std::numeric_limits<double>::infinity()}) {
      Box<D> safe_box = box;
      for (int k = 0; k < D; ++k) {
        safe_box.lo[k] -= margin * box.extent(k);
        safe_box.hi[k] += margin * box.extent(k);
      }
      const BaseCase<D> base_case =
          triangulate_base_case<D>({.points = points, .input_index = index, .safe_box = safe_box});
      ASSERT_TRUE(base_case.not_inside.has_value());
      std::vector<bool> claimed(base_case.simplices.size(), true);
      for (const std::uint32_t s : *base_case.not_inside) claimed[s] = false;
      std::size_t count = 0;
      for (std::size_t s = 0; s < claimed.size(); ++s) {
        const Simplex<D>& simplex = base_case.simplices[s];
        if (simplex.infinite()) {
          EXPECT_FALSE(claimed[s]);
          continue;
        }
        count += claimed[s] ? 1 : 0;
        if (!claimed[s] || s % kStep != 0) continue;
        std::array<Point<D>, D + 1> corners;
        for (int i = 0; i <= D; ++i) corners[i] = points[simplex.vertices[i]];
        EXPECT_TRUE(ExactSphere<D>(corners).inside(safe_box));
      }
      if (std::isinf(margin)) {
        EXPECT_GT(count, 0U);
      }
      const BaseCase<D> corners_only = triangulate_base_case<D>(
          {.points = points, .input_index = index, .safe_box = safe_box, .corners_only = true});
      EXPECT_EQ(corners_only.not_inside, base_case.not_inside);
      ASSERT_EQ(corners_only.corners.size(), claimed.size());
      for (std::size_t s = 0; s < claimed.size(); ++s) {
        EXPECT_EQ(corners_only.corners[s], base_case.simplices[s].vertices);
      }
    }
  }
}

TYPED_TEST(KernelOfHigherDimension, RefusesCgalsKernel) {
  constexpr int D = TypeParam::value;
  const Points<D> points = TestFixture::lattice(50, 3, 2);
  EXPECT_THROW(delaunay_triangulation<D>(points, {.kernel = Kernel::kCgal}), Failure);
}

}  // namespace
}  // namespace spillway::test
