// Points of different coordinates are not taken for each other, which costs nothing.

#include "src/geometry/framed_point.h"

#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::test {
namespace {

template <typename A, typename B>
constexpr bool kAreApart = !std::is_constructible_v<A, B> && !std::is_constructible_v<B, A> &&
                           !std::is_assignable_v<A&, B> && !std::equality_comparable_with<A, B>;

static_assert(kAreApart<LatticePoint, WorldPoint>);
static_assert(kAreApart<LatticePoint, PlacedPoint>);
static_assert(kAreApart<WorldPoint, PlacedPoint>);

static_assert(!std::is_convertible_v<Point<3>, LatticePoint>, "only where that is said");
static_assert(std::is_constructible_v<LatticePoint, Point<3>>);

static_assert(sizeof(WorldPoint) == sizeof(Point<3>));
static_assert(std::is_trivially_copyable_v<WorldPoint>);
static_assert(std::is_trivially_default_constructible_v<WorldPoint>);

TEST(FramedPoint, IsReadAsThreeNumbers) {
  const LatticePoint point{1, 2, 3};
  EXPECT_EQ(point[2], 3);
  EXPECT_EQ(point.numbers(), (Point<3>{1, 2, 3}));
  Box<3> box;
  box.expand(point);
  EXPECT_EQ(box.hi, (Point<3>{1, 2, 3}));
}

TEST(FramedPoint, PointsOfOneKindAreCompared) {
  EXPECT_EQ((WorldPoint{1, 2, 3}), (WorldPoint{1, 2, 3}));
  EXPECT_NE((WorldPoint{1, 2, 3}), (WorldPoint{1, 2, 4}));
  EXPECT_LT((WorldPoint{1, 2, 3}), (WorldPoint{1, 2, 4}));
}

TEST(FramedPoint, ALatticeMapsPointsToOutputCoordinates) {
  const IntegerLattice lattice{{0.5, 0.25, 2}, {10, 20, 30}};
  EXPECT_EQ(in_world(lattice, {2, 4, 1}), (WorldPoint{11, 21, 32}));
  EXPECT_EQ(in_world(std::nullopt, {2, 4, 1}), (WorldPoint{2, 4, 1}));
}

}  // namespace
}  // namespace spillway::test
