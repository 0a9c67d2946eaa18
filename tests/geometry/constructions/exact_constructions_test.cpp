// Distances, circumcentres and barycentric coordinates against exact rational arithmetic.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/error.h"
#include "src/geometry/constructions/barycentric.h"
#include "src/geometry/constructions/circumcentre.h"
#include "src/geometry/distance.h"
#include "src/geometry/predicates.h"
#include "tests/geometry/exact_sphere.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class ConstructionsTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(ConstructionsTest, Dimensions);

constexpr std::size_t kGroups = 60;  // exact rational arithmetic is slow

/// Half a unit in the last place, and what is left of subnormal numbers.
Rational rounding(double value) { return Rational(std::max(std::abs(value) * 0x1p-53, 0x1p-1074)); }

template <int D>
Rational squared_distance(const Point<D>& a, const Point<D>& b) {
  Rational sum = 0;
  for (int k = 0; k < D; ++k) {
    const Rational difference = Rational(a[k]) - Rational(b[k]);
    sum += difference * difference;
  }
  return sum;
}

TYPED_TEST(ConstructionsTest, DistancesCompareAsTheirExactSquares) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& g : hard_groups<D>(family, kGroups, 21)) {
      const Rational a = squared_distance<D>(g[0], g[1]), b = squared_distance<D>(g[0], g[2]);
      const int expected = a > b ? 1 : a < b ? -1 : 0;
      EXPECT_EQ(compare_distances<D>(g[0], g[1], g[2]), expected);
      EXPECT_EQ(compare_distances<D>(g[0], g[2], g[1]), -expected);
      EXPECT_EQ(distance_stages::exact<D>(g[0], g[1], g[2]), expected);
      EXPECT_EQ(distance_stages::filtered<D>(g[0], g[1], g[2]).value_or(expected), expected);
    }
  }
}

TYPED_TEST(ConstructionsTest, EqualDistancesAreEqual) {
  constexpr int D = TypeParam::value;
  Point<D> a{}, b{}, place{};
  a[0] = 3;
  a[1] = 4;
  b[D - 1] = -5;
  EXPECT_EQ(compare_distances<D>(place, a, b), 0);
  b[D - 1] = std::nextafter(-5.0, 0.0);
  EXPECT_EQ(compare_distances<D>(place, a, b), 1);
}

TYPED_TEST(ConstructionsTest, FilterDecidesOrdinaryDistances) {
  constexpr int D = TypeParam::value;
  for (const Group<D>& g : hard_groups<D>(Hard::kUniform, 1000, 22)) {
    EXPECT_TRUE(distance_stages::filtered<D>(g[0], g[1], g[2]).has_value());
  }
}

TYPED_TEST(ConstructionsTest, CircumcentresKeepTheirPromise) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : hard_groups<D>(family, kGroups, 23)) {
      const auto simplex = simplex_of<D>(group);
      if (orientation<D>(simplex) == 0) continue;
      const ExactSphere<D> sphere(simplex);
      const Point<D> centre = circumcentre<D>(simplex);
      const Point<D> exact = exact_circumcentre<D>(simplex);
      for (int k = 0; k < D; ++k) {
        if (std::isinf(exact[k])) {
          EXPECT_GE(abs(sphere.centre[k]), Rational(std::numeric_limits<double>::max()));
          continue;
        }
        EXPECT_LE(abs(sphere.centre[k] - Rational(exact[k])), rounding(exact[k]));
        const Rational error =
            abs(sphere.centre[k] - Rational(centre[k])) - 2 * rounding(centre[k]);
        EXPECT_TRUE(error <= 0 || error * error <= sphere.squared_radius * Rational(0x1p-80));
      }
    }
  }
}

TYPED_TEST(ConstructionsTest, CircumcentreBeyondTheLargestDoubleIsInfinite) {
  constexpr int D = TypeParam::value;
  std::array<Point<D>, D + 1> flat{};
  for (int k = 0; k < D; ++k) flat[k + 1][k] = 1e300;
  flat[D][0] = 5e299;
  flat[D][D - 1] = 1e-300;
  EXPECT_TRUE(std::isinf(circumcentre<D>(flat)[D - 1]));
}

TYPED_TEST(ConstructionsTest, BarycentricCoordinatesAreNearTheExactOnes) {
  constexpr int D = TypeParam::value;
  Random random(24);
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : hard_groups<D>(family, kGroups, 25)) {
      auto simplex = simplex_of<D>(group);
      const int sign = orientation<D>(simplex);
      if (sign == 0) continue;
      if (sign < 0) std::swap(simplex[0], simplex[1]);
      Point<D> place{};
      for (const auto& corner : simplex) {
        for (int k = 0; k < D; ++k) place[k] += corner[k] * (1.0 / (D + 1));
      }
      if (random.integer(0, 2) == 0) place = simplex[random.integer(0, D)];
      bool inside = true;
      for (int i = 0; i <= D; ++i) {
        auto replaced = simplex;
        replaced[i] = place;
        inside = inside && orientation<D>(replaced) >= 0;
      }
      if (!inside) continue;
      Vectors<D, D + 1, Rational> v;
      for (int i = 0; i <= D; ++i) {
        for (int k = 0; k < D; ++k) v[i][k] = Rational(simplex[i][k]) - Rational(place[k]);
      }
      const auto weights = barycentric_determinants<D>(v);
      Rational sum = 0;
      for (const Rational& weight : weights) sum += weight;
      const auto rounded = barycentric_coordinates<D>(simplex, place);
      const auto exact = exact_barycentric_coordinates<D>(simplex, place);
      for (int i = 0; i <= D; ++i) {
        const Rational share = weights[i] / sum;
        EXPECT_LE(abs(share - Rational(rounded[i])), Rational(0x1p-36));
        EXPECT_LE(abs(share - Rational(exact[i])), rounding(exact[i]));
        EXPECT_EQ(rounded[i] == 0, exact[i] == 0);
      }
    }
  }
}

TYPED_TEST(ConstructionsTest, CoordinatesThatAreNotFiniteThrow) {
  constexpr int D = TypeParam::value;
  Point<D> bad{};
  bad[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(compare_distances<D>(bad, Point<D>{}, Point<D>{}), Failure);
  std::array<Point<D>, D + 1> simplex{};
  simplex[0] = bad;
  EXPECT_THROW(circumcentre<D>(simplex), Failure);
}

}  // namespace
}  // namespace spillway::test
