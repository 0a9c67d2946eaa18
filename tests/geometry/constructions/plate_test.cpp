#include "src/geometry/constructions/plate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class PlateTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(PlateTest, Dimensions);

template <int D>
Point<D> random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Point<D> p;
  for (double& x : p) x = unit(random);
  return p;
}

template <int D>
Point<D> unit_vector(Point<D> v) {
  double squared = 0;
  for (const double x : v) squared += x * x;
  for (double& x : v) x /= std::sqrt(squared);
  return v;
}

/// Some points near a hyperplane, far from the origin, and a plate of them.
template <int D>
struct FlatSet {
  std::vector<Point<D>> points;
  Plate<D> plate;

  FlatSet(std::mt19937_64& random, double noise, double offset) {
    plate.normal = unit_vector<D>(random_point<D>(random));
    for (double& x : plate.centre) x = offset;
    for (int i = 0; i < 20; ++i) {
      Point<D> p = random_point<D>(random);
      double along = 0;
      for (int k = 0; k < D; ++k) along += p[k] * plate.normal[k];
      for (int k = 0; k < D; ++k) p[k] += plate.centre[k] - (1 - noise) * along * plate.normal[k];
      points.push_back(p);
    }
    for (const Point<D>& p : points) plate.expand(p);
  }
};

/// Calls visit(plate, points in it) for plates of all kinds.
template <int D, typename Visit>
void for_each_plate(const Visit& visit) {
  std::mt19937_64 random(1);
  for (const double offset : {0.0, 1.0, 4.5e6, 1e12}) {
    for (const double noise : {0.0, 1e-9, 1e-3, 1.0}) {
      for (int i = 0; i < 20; ++i) {
        const FlatSet<D> set(random, noise, offset);
        visit(set.plate, set.points, random);
        Plate<D> around = FlatSet<D>(random, noise, offset).plate;
        around.expand(set.plate);
        visit(around, set.points, random);
      }
    }
  }
}

TYPED_TEST(PlateTest, IsMetByEveryBallAndHalfSpaceThatHasAPointOfIt) {
  constexpr int D = TypeParam::value;
  std::size_t apart = 0, asked = 0;
  for_each_plate<D>([&](const Plate<D>& plate, const auto& points, std::mt19937_64& random) {
    for (const Point<D>& p : points) {
      // Spheres and hyperplanes through the point, of which most are as large as the plate.
      std::array<Point<D>, D + 1> simplex;
      simplex.fill(p);
      const double size = std::exp2(static_cast<double>(random() % 40) - 30);
      for (int i = 1; i <= D; ++i) {
        const Point<D> step = random_point<D>(random);
        for (int k = 0; k < D; ++k) simplex[i][k] += size * step[k];
      }
      EXPECT_TRUE(may_meet<D>(certified_ball<D>(simplex), plate));
      std::array<Point<D>, D> facet;
      std::copy(simplex.begin(), simplex.end() - 1, facet.begin());
      EXPECT_TRUE(may_meet<D>(HalfSpace<D>(facet), plate));
      for (Point<D>& corner : simplex) corner[0] += 8;
      ++asked;
      apart += may_meet<D>(certified_ball<D>(simplex), plate) ? 0 : 1;
    }
  });
  EXPECT_GT(apart, asked / 20);
}

TYPED_TEST(PlateTest, IsThinWhereABoxIsNot) {
  constexpr int D = TypeParam::value;
  Point<D> diagonal;
  diagonal.fill(1);
  Plate<D> plate{.normal = unit_vector<D>(diagonal)};
  Box<D> box;
  for (const double x : {-1.0, 1.0}) {
    Point<D> p{};
    p[0] = x;
    p[1] = -x;
    plate.expand(p);
    box.expand(p);
  }
  // A ball above the middle of the plate, in the box.
  std::array<Point<D>, D + 1> simplex;
  simplex.fill(diagonal);
  for (double& x : simplex[0]) x *= 0.1;
  for (int i = 1; i <= D; ++i) {
    simplex[i] = simplex[0];
    simplex[i][i - 1] += 1e-2;
  }
  const CertifiedBall<D> ball = certified_ball<D>(simplex);
  EXPECT_TRUE(may_meet<D>(ball, box) || D > 2);
  EXPECT_FALSE(may_meet<D>(ball, plate));
  EXPECT_LT(plate.thickness, 1e-9);
}

TYPED_TEST(PlateTest, OfWhatOverflowsOrIsNotCertifiedIsAlwaysMet) {
  constexpr int D = TypeParam::value;
  Plate<D> plate;
  plate.normal[0] = 1;
  Point<D> far;
  far.fill(std::numeric_limits<double>::max());
  plate.expand(far);
  for (double& x : far) x = -x;
  plate.expand(far);
  std::array<Point<D>, D + 1> simplex{};
  for (int i = 1; i <= D; ++i) simplex[i][i - 1] = 1;
  EXPECT_TRUE(may_meet<D>(certified_ball<D>(simplex), plate));
  const Plate<D> small{.normal = plate.normal};
  EXPECT_TRUE(may_meet<D>(CertifiedBall<D>{}, small));
  EXPECT_TRUE(may_meet<D>(HalfSpace<D>(std::array<Point<D>, D>{}), small));
}

}  // namespace
}  // namespace spillway::test
