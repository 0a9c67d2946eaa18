#include "src/geometry/predicates.h"

#include <gtest/gtest.h>

#include <limits>

#include "src/error.h"
#include "src/geometry/predicate_stages.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

constexpr std::size_t kGroups = 2000;

template <typename Dimension>
class PredicatesTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(PredicatesTest, Dimensions);

// The groups of a family whose simplex is not degenerate, turned to be positively oriented.
template <int D>
std::vector<Group<D>> positive_groups(Hard family) {
  std::vector<Group<D>> positive;
  for (Group<D> group : hard_groups<D>(family, kGroups, 7)) {
    const int o = orientation<D>(simplex_of<D>(group));
    if (o < 0) std::swap(group[0], group[1]);
    if (o != 0) positive.push_back(group);
  }
  return positive;
}

template <int D>
bool distinct(Group<D> group) {
  std::sort(group.begin(), group.end());
  return std::adjacent_find(group.begin(), group.end()) == group.end();
}

TYPED_TEST(PredicatesTest, EveryStageAgreesWithTheExactOne) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : hard_groups<D>(family, kGroups, 1)) {
      const auto simplex = simplex_of<D>(group);
      const int exact_orientation = stages::exact<stages::Orientation<D>>(simplex);
      const int exact_side = stages::exact<stages::InSphere<D>>(group);
      EXPECT_EQ(stages::filtered<stages::Orientation<D>>(simplex).value_or(exact_orientation),
                exact_orientation);
      EXPECT_EQ(stages::integer<stages::Orientation<D>>(simplex).value_or(exact_orientation),
                exact_orientation);
      EXPECT_EQ(orientation<D>(simplex), exact_orientation);
      EXPECT_EQ(stages::filtered<stages::InSphere<D>>(group).value_or(exact_side), exact_side);
      EXPECT_EQ(stages::integer<stages::InSphere<D>>(group).value_or(exact_side), exact_side);
      EXPECT_EQ(side_of_sphere<D>(simplex, group[D + 1]), exact_side);
      if (exact_side != 0) {
        EXPECT_EQ(in_sphere<D>(simplex, group[D + 1]), exact_side);
      }
    }
  }
}

TYPED_TEST(PredicatesTest, FilterDecidesOrdinaryPoints) {
  constexpr int D = TypeParam::value;
  std::size_t decided = 0;
  for (const Group<D>& group : hard_groups<D>(Hard::kUniform, kGroups, 2)) {
    decided += stages::filtered<stages::InSphere<D>>(group).has_value() ? 1 : 0;
  }
  EXPECT_GT(decided, kGroups * 99 / 100);
}

TYPED_TEST(PredicatesTest, IntegerStageDecidesLidarLattices) {
  constexpr int D = TypeParam::value;
  for (const Hard family : {Hard::kSmallLattice, Hard::kLidarLattice}) {
    for (const Group<D>& group : hard_groups<D>(family, kGroups, 3)) {
      EXPECT_TRUE(stages::integer<stages::Orientation<D>>(simplex_of<D>(group)).has_value());
      EXPECT_TRUE(stages::integer<stages::InSphere<D>>(group).has_value());
    }
  }
}

TYPED_TEST(PredicatesTest, IntegerStageRefusesDifferencesThatAreRounded) {
  constexpr int D = TypeParam::value;
  // 2^40 - 2^-20 rounds to 2^40, an integer, but the difference is none.
  std::array<Point<D>, D + 1> simplex{};
  for (int k = 1; k < D; ++k) simplex[k + 1][k] = 1;
  for (auto& point : simplex) point[0] = 0x1p-20;
  simplex[1][0] = 0x1p40;
  EXPECT_FALSE(stages::integer<stages::Orientation<D>>(simplex).has_value());
}

TYPED_TEST(PredicatesTest, IntegerStageDoesNotOverflowAtItsLimit) {
  constexpr int D = TypeParam::value;
  Random random(4);
  for (int trial = 0; trial < 500; ++trial) {
    std::array<Point<D>, D + 1> simplex{};
    Group<D> group{};
    for (int k = 0; k < D; ++k) {
      for (int i = 1; i <= D; ++i) {
        simplex[i][k] =
            (random.integer(0, 1) == 0 ? -1 : 1) * stages::Orientation<D>::kLargestInteger;
      }
      for (int i = 0; i <= D; ++i) {
        group[i][k] = (random.integer(0, 1) == 0 ? -1 : 1) * stages::InSphere<D>::kLargestInteger;
      }
    }
    EXPECT_EQ(stages::integer<stages::Orientation<D>>(simplex),
              stages::exact<stages::Orientation<D>>(simplex));
    EXPECT_EQ(stages::integer<stages::InSphere<D>>(group),
              stages::exact<stages::InSphere<D>>(group));
  }
}

TYPED_TEST(PredicatesTest, OrientationIsPositiveForTheUnitSimplex) {
  constexpr int D = TypeParam::value;
  std::array<Point<D>, D + 1> simplex{};
  for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
  EXPECT_EQ(orientation<D>(simplex), 1);
  Point<D> query{};
  query.fill(0.25);
  EXPECT_EQ(in_sphere<D>(simplex, query), 1);
  query.fill(2);
  EXPECT_EQ(in_sphere<D>(simplex, query), -1);
}

TYPED_TEST(PredicatesTest, SwappingTwoPointsNegatesOrientation) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : hard_groups<D>(family, kGroups / 10, 5)) {
      const auto simplex = simplex_of<D>(group);
      for (int i = 0; i <= D; ++i) {
        for (int j = 0; j < i; ++j) {
          auto swapped = simplex;
          std::swap(swapped[i], swapped[j]);
          EXPECT_EQ(orientation<D>(swapped), -orientation<D>(simplex));
        }
      }
    }
  }
}

TYPED_TEST(PredicatesTest, ExactTranslationKeepsAllAnswers) {
  constexpr int D = TypeParam::value;
  for (Group<D> group : positive_groups<D>(Hard::kSmallLattice)) {
    const int before = in_sphere<D>(simplex_of<D>(group), group[D + 1]);
    for (auto& point : group) {
      for (double& c : point) c += 0x1p50;
    }
    EXPECT_EQ(orientation<D>(simplex_of<D>(group)), 1);
    EXPECT_EQ(in_sphere<D>(simplex_of<D>(group), group[D + 1]), before);
  }
}

TYPED_TEST(PredicatesTest, InSphereIsZeroOnlyAtVertices) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : positive_groups<D>(family)) {
      const auto simplex = simplex_of<D>(group);
      if (distinct<D>(group)) {
        EXPECT_NE(in_sphere<D>(simplex, group[D + 1]), 0);
      }
      for (const auto& vertex : simplex) EXPECT_EQ(in_sphere<D>(simplex, vertex), 0);
    }
  }
}

TYPED_TEST(PredicatesTest, InSphereIsInvariantUnderEvenPermutations) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : positive_groups<D>(family)) {
      const auto simplex = simplex_of<D>(group);
      const int side = in_sphere<D>(simplex, group[D + 1]);
      for (int first = 0; first + 2 <= D; ++first) {
        auto turned = simplex;
        std::rotate(turned.begin() + first, turned.begin() + first + 1, turned.begin() + first + 3);
        EXPECT_EQ(in_sphere<D>(turned, group[D + 1]), side);
      }
    }
  }
}

TYPED_TEST(PredicatesTest, BothSimplicesAtAFacetAgreeOnIt) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const Group<D>& group : positive_groups<D>(family)) {
      const auto simplex = simplex_of<D>(group);
      const Point<D>& query = group[D + 1];
      for (int i = 0; i <= D; ++i) {
        auto across = simplex;  // query in place of vertex i: negative if beyond that facet
        across[i] = query;
        if (orientation<D>(across) >= 0) continue;
        std::swap(across[0], across[1]);
        EXPECT_EQ(in_sphere<D>(across, simplex[i]), in_sphere<D>(simplex, query));
      }
    }
  }
}

TEST(Predicates2DTest, ExactlyOneDiagonalOfACocircularQuadrilateralIsDelaunay) {
  int ties = 0;
  for (const Group<2>& group : positive_groups<2>(Hard::kCospherical)) {
    const auto& [a, b, c, d] = group;
    const bool convex = distinct<2>(group) && orientation<2>({a, c, d}) > 0 &&
                        orientation<2>({b, c, d}) > 0 && orientation<2>({a, b, d}) > 0;
    if (!convex || stages::exact<stages::InSphere<2>>(group) != 0) continue;
    ++ties;
    EXPECT_EQ(in_sphere<2>({a, b, c}, d), -in_sphere<2>({a, b, d}, c));
  }
  EXPECT_GT(ties, 50);
}

TEST(Predicates2DTest, UnitSquareIsCutThroughItsLargestPoint) {
  // The largest point is raised the most, so no circle through the other three contains it.
  EXPECT_EQ(in_sphere<2>({Point<2>{0, 0}, {1, 0}, {0, 1}}, {1, 1}), -1);
  EXPECT_EQ(in_sphere<2>({Point<2>{0, 0}, {1, 0}, {1, 1}}, {0, 1}), 1);
}

TYPED_TEST(PredicatesTest, NegativeZeroIsZero) {
  constexpr int D = TypeParam::value;
  std::array<Point<D>, D + 1> simplex{};
  for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
  Point<D> origin{};
  origin.fill(-0.0);
  EXPECT_EQ(in_sphere<D>(simplex, origin), 0);
}

TYPED_TEST(PredicatesTest, CoordinatesThatAreNotFiniteThrow) {
  constexpr int D = TypeParam::value;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::array<Point<D>, D + 1> simplex{};
    for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
    simplex[0][0] = bad;
    EXPECT_THROW(orientation<D>(simplex), Failure);
    EXPECT_THROW(in_sphere<D>(simplex, Point<D>{}), Failure);
  }
}

}  // namespace
}  // namespace spillway::test
