// Boxes, lattices and the canonical hash.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/geometry/box.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/lattice.h"
#include "src/geometry/longest_edge.h"
#include "tests/geometry/point_families.h"

namespace spillway {
namespace {

TEST(LongestEdgeTest, EveryEdgeIsMeasuredInTheFirstCoordinatesOnly) {
  const std::array<Point<3>, 3> triangle = {{{0, 0, 0}, {3, 4, 9}, {0, 1, 0}}};
  EXPECT_FALSE(has_longer_edge<2>(triangle, 5));
  EXPECT_TRUE(has_longer_edge<2>(triangle, std::nextafter(5, 0)));
  EXPECT_TRUE(has_longer_edge<3>(triangle, 5));
  const std::array<Point<3>, 4> tetrahedron = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}}};
  EXPECT_TRUE(has_longer_edge<3>(tetrahedron, 2));
  EXPECT_FALSE(has_longer_edge<3>(tetrahedron, 2.25));
}

TEST(BoxTest, DefaultBoxIsEmptyAndContainsNothing) {
  const Box<3> box;
  EXPECT_TRUE(box.empty());
  EXPECT_FALSE(box.contains({0, 0, 0}));
  EXPECT_EQ(box.extent(1), 0);
}

TEST(BoxTest, ExpandingByPointsGivesTheirTightClosedBox) {
  Box<2> box;
  box.expand(Point<2>{1, 5});
  EXPECT_FALSE(box.empty());
  EXPECT_TRUE(box.contains({1, 5}));
  box.expand(Point<2>{-2, 7});
  EXPECT_EQ(box, (Box<2>{{-2, 5}, {1, 7}}));
  EXPECT_TRUE(box.contains({-2, 7}));
  EXPECT_FALSE(box.contains({-2, std::nextafter(7.0, 8.0)}));
}

TEST(BoxTest, ExpandingByAnEmptyBoxChangesNothing) {
  Box<2> box{{0, 0}, {1, 2}};
  const Box<2> before = box;
  box.expand(Box<2>{});
  EXPECT_EQ(box, before);
  Box<2> nothing;
  nothing.expand(before);
  EXPECT_EQ(nothing, before);
}

TEST(BoxTest, LongestAxisIsTheLowestAmongEquals) {
  EXPECT_EQ((Box<3>{{0, 0, 0}, {1, 2, 2}}.longest_axis()), 1);
  EXPECT_EQ((Box<3>{{0, 0, 0}, {1, 1, 1}}.longest_axis()), 0);
  EXPECT_EQ((Box<2>{}.longest_axis()), 0);
}

TEST(LatticeTest, IntegersComeBackFromWorldCoordinates) {
  const Lattice lattice{{0.01, 0.01, 0.001}, {637000.1, 4850000, -33.3}};
  testing::Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const int axis = trial % 3;
    const auto integer = static_cast<double>(random.integer(-2147483648LL, 2147483647LL));
    EXPECT_EQ(lattice.to_integer(axis, lattice.to_world(axis, integer)), integer);
  }
}

TEST(LatticeTest, CoordinatesOffTheLatticeHaveNoInteger) {
  const Lattice lattice{{0.01, 0.01, 0.01}, {0, 0, 0}};
  EXPECT_FALSE(lattice.to_integer(0, 0.015).has_value());
  EXPECT_FALSE(lattice.to_integer(0, std::nextafter(lattice.to_world(0, 7), 1.0)).has_value());
  EXPECT_FALSE(lattice.to_integer(0, std::numeric_limits<double>::quiet_NaN()).has_value());
}

TEST(LatticeTest, IsotropyLooksAtTheFirstAxesOnly) {
  const Lattice lattice{{0.01, 0.01, 0.001}, {0, 0, 0}};
  EXPECT_TRUE(lattice.isotropic(2));
  EXPECT_FALSE(lattice.isotropic(3));
}

template <typename Dimension>
class CanonicalHashTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CanonicalHashTest, Dimensions);

TYPED_TEST(CanonicalHashTest, DependsNeitherOnSimplexNorVertexOrder) {
  constexpr int D = TypeParam::value;
  const auto groups = testing::hard_groups<D>(testing::Hard::kUniform, 50, 2);
  CanonicalHash<D> forwards;
  CanonicalHash<D> backwards;
  CanonicalHash<D> halves;
  CanonicalHash<D> second_half;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    forwards.add(testing::simplex_of<D>(groups[i]));
    auto simplex = testing::simplex_of<D>(groups[groups.size() - 1 - i]);
    std::reverse(simplex.begin(), simplex.end());
    backwards.add(simplex);
    (i < 20 ? halves : second_half).add(testing::simplex_of<D>(groups[i]));
  }
  halves.add(second_half);
  EXPECT_EQ(forwards.value(), backwards.value());
  EXPECT_EQ(forwards.value(), halves.value());
  EXPECT_NE(forwards.value(), second_half.value());
}

TYPED_TEST(CanonicalHashTest, ChangesWithOneBitOfOneCoordinate) {
  constexpr int D = TypeParam::value;
  const auto groups = testing::hard_groups<D>(testing::Hard::kUniform, 1, 3);
  auto simplex = testing::simplex_of<D>(groups[0]);
  CanonicalHash<D> before;
  before.add(simplex);
  simplex[1][D - 1] = std::nextafter(simplex[1][D - 1], 2.0);
  CanonicalHash<D> after;
  after.add(simplex);
  EXPECT_NE(before.value(), after.value());
}

TYPED_TEST(CanonicalHashTest, NegativeZeroCountsAsZero) {
  constexpr int D = TypeParam::value;
  std::array<Point<D>, D + 1> simplex{};
  for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
  CanonicalHash<D> plus;
  plus.add(simplex);
  simplex[0].fill(-0.0);
  CanonicalHash<D> minus;
  minus.add(simplex);
  EXPECT_EQ(plus.value(), minus.value());
}

TEST(CanonicalHashValueTest, IsPartOfTheFormatAndNeverChanges) {
  CanonicalHash<2> hash;
  EXPECT_EQ(hash_to_hex(hash.value()), "0000000000000000");
  hash.add({Point<2>{0, 0}, {1, 0}, {0, 1}});
  EXPECT_EQ(hash_to_hex(hash.value()), "6e566e50aa3c0b36");
}

}  // namespace
}  // namespace spillway
