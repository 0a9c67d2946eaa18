#include "src/geometry/torus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/error.h"
#include "src/geometry/torus_simplex.h"

namespace spillway::geometry {
namespace {

PeriodicBox square(double low, double high) {
  return {.box = {{low, low, low}, {high, high, high}}};
}

TEST(Torus, PointsAreBroughtIntoTheBoxByWholePeriods) {
  const Torus torus(square(-1, 3), 2);
  Point<2> point{3, -1};
  Wrapping wrapping = torus.wrap(point);
  EXPECT_EQ(point, (Point<2>{-1, -1}));
  EXPECT_TRUE(wrapping.moved);
  EXPECT_FALSE(wrapping.rounded);
  point = {-1 - 4 * 1e9, 2.5 + 4 * 1e6};
  EXPECT_TRUE(torus.wrap(point).moved);
  EXPECT_EQ(point, (Point<2>{-1, 2.5}));
  point = {0, 2.5};
  wrapping = torus.wrap(point);
  EXPECT_EQ(point, (Point<2>{0, 2.5}));
  EXPECT_FALSE(wrapping.moved);
}

TEST(Torus, WhatLiesJustBelowALowSideIsRoundedIntoTheBox) {
  const Torus torus(square(0, 1), 2);
  Point<2> point{-1e-30, std::nextafter(1.0, 0)};
  const Wrapping wrapping = torus.wrap(point);
  EXPECT_TRUE(wrapping.moved);
  EXPECT_TRUE(wrapping.rounded);
  for (const double x : point) {
    EXPECT_GE(x, 0);
    EXPECT_LT(x, 1);
  }
}

TEST(Torus, CopiesOfWrappedPointsAreExact) {
  std::mt19937_64 random(1);
  for (const auto& [low, high] :
       {std::pair{0.0, 1.0}, {-7.3, 1e3}, {1e6, 1e6 + 0.1}, {0.0, 2 * M_PI}, {-1e-3, 1e-9}}) {
    const Torus torus(square(low, high), 2);
    std::uniform_real_distribution<double> coordinate(low, high);
    for (int i = 0; i < 2000; ++i) {
      Point<2> point{coordinate(random), coordinate(random)};
      torus.wrap(point);
      for (const int periods : {-1, 1}) {
        const double copy = torus.moved(0, point[0], periods);
        EXPECT_EQ(torus.moved(0, copy, -periods), point[0]);
        EXPECT_EQ(copy - periods * torus.period(0), point[0]);
        EXPECT_EQ(torus.periods_along(0, copy), periods);
      }
    }
  }
}

TEST(Torus, WrappingAgainChangesNothing) {
  std::mt19937_64 random(2);
  const Torus torus(square(0.1, 0.7), 2);
  std::uniform_real_distribution<double> coordinate(-5, 5);
  for (int i = 0; i < 1000; ++i) {
    Point<2> point{coordinate(random), coordinate(random)};
    torus.wrap(point);
    const Point<2> once = point;
    const Wrapping again = torus.wrap(point);
    EXPECT_EQ(point, once);
    EXPECT_FALSE(again.moved || again.rounded);
  }
}

TEST(Torus, TheRoundedBoxMakesTheSameTorus) {
  const Torus torus(square(0.1, 0.7), 3);
  const Torus again(torus.box(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(again.low(k), torus.low(k));
    EXPECT_EQ(again.period(k), torus.period(k));
  }
}

TEST(Torus, SidesOnALatticeMayBeDecimals) {
  const IntegerLattice lattice{.scale = {0.01, 0.01, 0.01}, .offset = {0, 0, 0}};
  const Torus torus(square(0.1, 0.7), 3, lattice);
  EXPECT_EQ(torus.low(0), 10);
  EXPECT_EQ(torus.period(0), 60);
  EXPECT_THROW(Torus(square(0.1, 0.705), 3, lattice), Failure);
}

template <int D>
std::array<Point<D>, D + 1> random_simplex(std::mt19937_64& random, double size) {
  std::uniform_int_distribution<int> step(0, 1 << 20);
  std::array<Point<D>, D + 1> corners;
  for (auto& corner : corners) {
    for (double& x : corner) x = std::ldexp(step(random), -20) * size;
  }
  return corners;
}

template <int D>
void expect_one_of_all_copies_chosen() {
  std::mt19937_64 random(3);
  const Torus torus(square(0, 1), D);
  for (int i = 0; i < 3000; ++i) {
    const std::array<Point<D>, D + 1> corners = random_simplex<D>(random, 0.4);
    int chosen = 0;
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = D == 3 ? -2 : 0; z <= (D == 3 ? 2 : 0); ++z) {
          std::array<Point<D>, D + 1> copy = corners;
          for (auto& corner : copy) {
            corner[0] += x;
            corner[1] += y;
            if constexpr (D == 3) corner[2] += z;
          }
          std::swap(copy[0], copy[static_cast<std::size_t>(random() % (D + 1))]);
          const SimplexPlace<D> place = place_simplex<D>(torus, copy);
          chosen += place.stands_for_all() ? 1 : 0;
        }
      }
    }
    // Spheres of flat ones may have their centres farther away than these copies go.
    EXPECT_LE(chosen, 1);
    if (place_simplex<D>(torus, corners).radius < 1) {
      EXPECT_EQ(chosen, 1);
    }
  }
}

TEST(TorusSimplex, OneOfAllCopiesStandsForThem) {
  expect_one_of_all_copies_chosen<2>();
  expect_one_of_all_copies_chosen<3>();
}

TEST(TorusSimplex, HullFacetsLieAlongThePeriodicAxes) {
  PeriodicBox box = square(0, 1);
  box.periodic = {true, false, true};
  const Torus slab(box, 3);
  EXPECT_TRUE(is_chosen_hull_facet<3>(slab, {{{0, 7, 0}, {1, 7, 0}, {0, 7, 1}}}));
  EXPECT_FALSE(is_chosen_hull_facet<3>(slab, {{{0, 7, 0}, {1, 7, 0}, {0, 6, 1}}}));
  EXPECT_FALSE(is_chosen_hull_facet<3>(slab, {{{1, 7, 0}, {2, 7, 0}, {1, 7, 1}}}));
  box.periodic = {true, false, false};
  const Torus wire(box, 3);
  EXPECT_TRUE(is_chosen_hull_facet<3>(wire, {{{0, 1, 1}, {1, 1, 1}, {0.5, 2, 3}}}));
  EXPECT_FALSE(is_chosen_hull_facet<3>(wire, {{{0, 1, 1}, {1, 1, 2}, {0.5, 2, 2}}}));
}

}  // namespace
}  // namespace spillway::geometry
