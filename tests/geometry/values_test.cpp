// Boxes, lattices and the canonical hash.

#include <gtest/gtest.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/lattice.h"
#include "src/geometry/longest_edge.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
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
  const IntegerLattice lattice{{0.01, 0.01, 0.001}, {637000.1, 4850000, -33.3}};
  Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const int axis = trial % 3;
    const auto integer = static_cast<double>(random.integer(-2147483648LL, 2147483647LL));
    EXPECT_EQ(lattice.to_integer(axis, lattice.to_world(axis, integer)), integer);
  }
}

TEST(LatticeTest, CoordinatesOffTheLatticeHaveNoInteger) {
  const IntegerLattice lattice{{0.01, 0.01, 0.01}, {0, 0, 0}};
  EXPECT_FALSE(lattice.to_integer(0, 0.015).has_value());
  EXPECT_FALSE(lattice.to_integer(0, std::nextafter(lattice.to_world(0, 7), 1.0)).has_value());
  EXPECT_FALSE(lattice.to_integer(0, std::numeric_limits<double>::quiet_NaN()).has_value());
}

TEST(LatticeTest, IsotropyLooksAtTheFirstAxesOnly) {
  const IntegerLattice lattice{{0.01, 0.01, 0.001}, {0, 0, 0}};
  EXPECT_TRUE(lattice.isotropic(2));
  EXPECT_FALSE(lattice.isotropic(3));
}

/// Whether integers of a range are distinct in the world and come back, tried one by one.
bool are_apart(const IntegerLattice& lattice, double lo, double hi) {
  for (double n = lo; n <= hi; ++n) {
    const double world = lattice.to_world(0, n);
    if (!std::isfinite(world) || lattice.to_world(0, n + 1) == world ||
        lattice.to_integer(0, world) != n) {
      return false;
    }
  }
  return true;
}

TEST(LatticeTest, WhatIsSaidToKeepIntegersApartDoes) {
  Random random(7);
  int kept = 0;
  int refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double scale =
        std::ldexp(1.0 + random.uniform(), static_cast<int>(random.integer(-9, 3)));
    const double size =
        std::ldexp(1.0 + random.uniform(), static_cast<int>(random.integer(30, 60)));
    const double base = std::floor(size / scale) * static_cast<double>(random.integer(-1, 1));
    const IntegerLattice lattice{{trial % 2 == 0 ? scale : -scale, 1, 1},
                                 {trial % 3 == 0 ? 0 : size, 0, 0}};
    const bool says = std::abs(base) < 0x1p53 && lattice.keeps_apart(0, base, base + 200);
    (says ? kept : refused) += 1;
    if (says) {
      EXPECT_TRUE(are_apart(lattice, base, base + 200))
          << lattice.scale[0] << " " << lattice.offset[0] << " " << base;
    }
  }
  EXPECT_GT(kept, 2000);
  EXPECT_GT(refused, 2000);
}

TEST(LatticeTest, KeepsIntegersApartWhereThatIsExact) {
  const auto keeps = [](double scale, double offset, double lo, double hi) {
    return IntegerLattice{{scale, 1, 1}, {offset, 0, 0}}.keeps_apart(0, lo, hi);
  };
  EXPECT_TRUE(keeps(1, 0, -0x1p53 + 1, 0x1p53 - 1));
  EXPECT_TRUE(keeps(0.125, 0x1p49, 0, 1000));
  EXPECT_FALSE(keeps(0.125, 0x1p50, 0, 1000));
  EXPECT_TRUE(keeps(0.01, 1e13, -0x1p31, 0x1p31));
  EXPECT_TRUE(keeps(0.01, 500000, -0x1p31, 0x1p31));
  EXPECT_FALSE(keeps(0.01, 1e15, 0, 0));
  EXPECT_FALSE(keeps(0.001, 1e13, 0, 0));
  EXPECT_TRUE(keeps(1e305, 0, 0, 1000));
  EXPECT_FALSE(keeps(1e305, 0, 0, 2000));
  EXPECT_FALSE(keeps(1e305, 0, -1000, 1000));  // differences are infinite
  EXPECT_FALSE(keeps(0.01, 1e305, 0, 0));
  EXPECT_TRUE((IntegerLattice{{0.01, 1, 1}, {1e305, 0, 0}}.is_finite(0, -0x1p31, 0x1p31)));
}

template <typename Dimension>
class CanonicalHashTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(CanonicalHashTest, Dimensions);

TYPED_TEST(CanonicalHashTest, DependsNeitherOnSimplexNorVertexOrder) {
  constexpr int D = TypeParam::value;
  const auto groups = hard_groups<D>(Hard::kUniform, 50, 2);
  CanonicalHash<D> forwards;
  CanonicalHash<D> backwards;
  CanonicalHash<D> halves;
  CanonicalHash<D> second_half;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    forwards.add(simplex_of<D>(groups[i]));
    auto simplex = simplex_of<D>(groups[groups.size() - 1 - i]);
    std::reverse(simplex.begin(), simplex.end());
    backwards.add(simplex);
    (i < 20 ? halves : second_half).add(simplex_of<D>(groups[i]));
  }
  halves.add(second_half);
  EXPECT_EQ(forwards.value(), backwards.value());
  EXPECT_EQ(forwards.value(), halves.value());
  EXPECT_NE(forwards.value(), second_half.value());
}

TYPED_TEST(CanonicalHashTest, ChangesWithOneBitOfOneCoordinate) {
  constexpr int D = TypeParam::value;
  const auto groups = hard_groups<D>(Hard::kUniform, 1, 3);
  auto simplex = simplex_of<D>(groups[0]);
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

// The sum of single hashes is what a set of simplices is known by.
template <int D>
std::uint64_t hash_of(const std::vector<std::array<Point<D>, D + 1>>& simplices) {
  CanonicalHash<D> hash;
  for (const auto& simplex : simplices) hash.add(simplex);
  return hash.value();
}

TYPED_TEST(CanonicalHashTest, IsTheSumOfTheLibrarysHashes) {
  constexpr int D = TypeParam::value;
  std::uint64_t sum = 0x0123456789ABCDEFU;
  std::uint64_t expected = 0;
  CanonicalHash<D> hash;
  for (int i = 0; i < 10'000; ++i) {
    hash.add(sum);
    expected += XXH3_64bits(&sum, sizeof sum);
    ASSERT_EQ(hash.value(), expected);
    sum = std::rotl(sum, 5) * 0x9E3779B97F4A7C15U;
  }
}

TYPED_TEST(CanonicalHashTest, EveryBitOfEveryCoordinateCounts) {
  constexpr int D = TypeParam::value;
  const auto simplex = simplex_of<D>(hard_groups<D>(Hard::kLidarLattice, 1, 4)[0]);
  std::set<std::uint64_t> seen{hash_of<D>({simplex})};
  for (int i = 0; i <= D; ++i) {
    for (int k = 0; k < D; ++k) {
      for (int bit = 0; bit < 64; ++bit) {
        auto changed = simplex;
        changed[i][k] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(simplex[i][k]) ^
                                              std::uint64_t{1} << bit);
        if (changed[i][k] != changed[i][k]) continue;
        EXPECT_TRUE(seen.insert(hash_of<D>({changed})).second) << i << ' ' << k << ' ' << bit;
      }
    }
  }
}

TYPED_TEST(CanonicalHashTest, ChangesWhenSimplicesExchangeCornersOrCoordinates) {
  constexpr int D = TypeParam::value;
  for (const auto& group : hard_groups<D>(Hard::kUniform, 200, 5)) {
    const auto first = simplex_of<D>(group);
    auto second = first;
    for (auto& corner : second) corner[0] += 10;
    const std::uint64_t before = hash_of<D>({first, second});
    auto third = first;
    auto fourth = second;
    std::swap(third[0], fourth[1]);
    EXPECT_NE(hash_of<D>({third, fourth}), before);
    fourth = second;
    third = first;
    std::swap(third[0][0], fourth[0][0]);  // the same numbers, elsewhere
    EXPECT_NE(hash_of<D>({third, fourth}), before);
    third = first;
    std::swap(third[0][0], third[1][0]);
    EXPECT_NE(hash_of<D>({third}), hash_of<D>({first}));
    third = first;
    std::swap(third[0][0], third[0][1]);
    EXPECT_NE(hash_of<D>({third}), hash_of<D>({first}));
  }
}

TEST(CanonicalHashValueTest, TellsTheDiagonalsOfAGridApart) {
  // All ways to cut the cells of a grid in two have the same corners, a cell's two ways as often.
  constexpr int kCells = 12;
  std::set<std::uint64_t> seen;
  for (unsigned diagonals = 0; diagonals < 1U << kCells; ++diagonals) {
    CanonicalHash<2> hash;
    for (int cell = 0; cell < kCells; ++cell) {
      const double x = cell % 4;
      const double y = cell / 4;
      const Point<2> a{x, y};
      const Point<2> b{x + 1, y};
      const Point<2> c{x + 1, y + 1};
      const Point<2> d{x, y + 1};
      if ((diagonals >> cell & 1U) != 0) {
        hash.add({a, b, c});
        hash.add({a, c, d});
      } else {
        hash.add({a, b, d});
        hash.add({b, c, d});
      }
    }
    EXPECT_TRUE(seen.insert(hash.value()).second) << diagonals;
  }
}

TEST(CanonicalHashValueTest, TellsTheTwoAndThreeTetrahedraOfFivePointsApart) {
  const Point<3> top{0.1, 0.1, 1};
  const Point<3> bottom{0.1, 0.1, -1};
  const Point<3> a{1, 0, 0};
  const Point<3> b{0, 1, 0};
  const Point<3> c{-1, -1, 0};
  EXPECT_NE(hash_of<3>({{a, b, c, top}, {a, b, c, bottom}}),
            hash_of<3>({{a, b, top, bottom}, {b, c, top, bottom}, {c, a, top, bottom}}));
}

TYPED_TEST(CanonicalHashTest, FingerprintsOfVerticesMakeTheSameHash) {
  constexpr int D = TypeParam::value;
  CanonicalHash<D> one_by_one;
  CanonicalHash<D> listed;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint64_t> vertices;
  for (const auto& group : hard_groups<D>(Hard::kSmallLattice, 100, 6)) {
    for (const auto& corner : simplex_of<D>(group)) {
      corners.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(vertex_hash<D>(corner));
    }
    one_by_one.add(simplex_of<D>(group));
  }
  listed.add(corners, vertices);
  EXPECT_EQ(listed.value(), one_by_one.value());
}

TEST(CanonicalHashValueTest, IsPartOfTheFormatAndNeverChanges) {
  CanonicalHash<2> hash;
  EXPECT_EQ(hash_to_hex(hash.value()), "0000000000000000");
  hash.add({Point<2>{0, 0}, {1, 0}, {0, 1}});
  EXPECT_EQ(hash_to_hex(hash.value()), "c7f69e3eeb8bb3b9");
  EXPECT_EQ(hash_to_hex(hash_of<3>({{Point<3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})),
            "4ea8ee3f5a86838e");
}

}  // namespace
}  // namespace spillway::test
