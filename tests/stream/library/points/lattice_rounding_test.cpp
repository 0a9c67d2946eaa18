// Points that are rounded to a lattice: which one that is, and how far they move.

#include "stream/library/points/lattice_rounding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Box<3> kUtm{{430'000, 5'700'000, 40}, {431'000, 5'701'000, 90}};
const Box<3> kDegrees{{13.0, 52.3, 30}, {13.8, 52.7, 120}};

TEST(ChosenLattice, IsTheChoiceWhereThereIsOne) {
  const IntegerLattice source{{0.25, 0.5, 1}, {7, 8, 9}};
  const IntegerLattice one = chosen_lattice({{0.01}, {100}}, source, kUtm);
  EXPECT_THAT(one.scale, ElementsAre(0.01, 0.01, 0.01));
  EXPECT_THAT(one.offset, ElementsAre(100, 100, 100));
  const IntegerLattice three = chosen_lattice({{0.1, 0.2, 0.3}, {1, 2, 3}}, source, kUtm);
  EXPECT_THAT(three.scale, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(three.offset, ElementsAre(1, 2, 3));
}

TEST(ChosenLattice, KeepsOfTheSourcesLatticeWhatTheChoiceLeavesOpen) {
  const IntegerLattice source{{0.25, 0.5, 1}, {7, 8, 9}};
  EXPECT_EQ(chosen_lattice({}, source, kUtm), source);
  EXPECT_EQ(chosen_lattice({{0.01}, {}}, source, kUtm),
            (IntegerLattice{{0.01, 0.01, 0.01}, {7, 8, 9}}));
  EXPECT_EQ(chosen_lattice({{}, {0}}, source, kUtm), (IntegerLattice{{0.25, 0.5, 1}, {0, 0, 0}}));
}

TEST(ChosenLattice, IsOfMillimetresOrOfTinyPartsOfDegrees) {
  EXPECT_THAT(chosen_lattice({}, std::nullopt, kUtm).scale, ElementsAre(0.001, 0.001, 0.001));
  EXPECT_THAT(chosen_lattice({}, std::nullopt, kDegrees).scale, ElementsAre(1e-7, 1e-7, 0.001));
}

TEST(ChosenLattice, CountsFromZeroOrFromARoundNumberNearTheCentre) {
  const IntegerLattice utm = chosen_lattice({}, std::nullopt, kUtm);
  EXPECT_EQ(utm.offset[0], 0) << "430,000 m are 430 million mm";
  EXPECT_EQ(utm.offset[2], 0);
  EXPECT_NEAR(utm.offset[1], 5'700'500, 1000) << "5,700 million mm are no 32-bit integers";
  EXPECT_EQ(std::fmod(utm.offset[1], 1000), 0);
}

/// The extents of points far and near, small and large, as long as 32 bits reach over them.
TEST(ChosenLattice, ReachesAllPointsOfTheExtent) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-3, 6);
  std::uniform_real_distribution<double> sign(-1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    Box<3> extent;
    for (int axis = 0; axis < 3; ++axis) {
      const double centre = std::copysign(std::pow(10, exponent(random) + 2), sign(random));
      const double half = std::pow(10, exponent(random));
      extent.lo[axis] = centre - half;
      extent.hi[axis] = centre + half;
    }
    const IntegerLattice lattice = chosen_lattice({{}, {}}, std::nullopt, extent);
    LatticeRounding rounding("out.las", lattice, std::nullopt, extent);
    std::vector<LatticePoint> corners = {LatticePoint(extent.lo), LatticePoint(extent.hi)};
    const std::vector<std::uint64_t> index = {0, 1};
    EXPECT_FALSE(thrown_by([&] { rounding.round(corners, index); })) << "trial " << trial;
  }
}

std::vector<LatticePoint> random_points(std::size_t count, double from, double to) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(from, to);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

std::vector<std::uint64_t> counted(std::size_t count) {
  std::vector<std::uint64_t> index(count);
  std::iota(index.begin(), index.end(), 0);
  return index;
}

TEST(LatticeRounding, TakesTheNearestPointAndRemembersHowFarTheyMoved) {
  const std::vector<LatticePoint> points = random_points(2000, -5000, 5000);
  const IntegerLattice target{{0.25, 0.01, 3}, {1000, -7, 0.5}};
  LatticeRounding rounding("out.las", target, std::nullopt, {});
  std::vector<LatticePoint> rounded = points;
  rounding.round(rounded, counted(points.size()));
  double farthest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double integer = rounded[i][axis];
      EXPECT_EQ(integer, std::nearbyint(integer));
      const double moved = std::abs(target.to_world(axis, integer) - points[i][axis]);
      EXPECT_LE(moved, target.scale[axis] / 2 + 1e-9);
      farthest = std::max(farthest, moved);
    }
  }
  EXPECT_EQ(rounding.farthest(), farthest);

  std::vector<LatticePoint> near = {{1000, -7, 0.5}};
  rounding.round(near, std::vector<std::uint64_t>{2000});
  EXPECT_EQ(rounding.farthest(), farthest) << "over all calls";
}

TEST(LatticeRounding, LeavesPointsOfTheSameLatticeWhereTheyAre) {
  const IntegerLattice lattice{{0.001, 0.001, 0.01}, {430'000, 5'700'000, -3.3}};
  std::vector<LatticePoint> points = random_points(2000, -2e9, 2e9);
  for (LatticePoint& point : points) {
    for (double& x : point) x = std::round(x);
  }
  std::vector<LatticePoint> rounded = points;
  LatticeRounding rounding("out.las", lattice, lattice, {});
  rounding.round(rounded, counted(points.size()));
  EXPECT_TRUE(rounded == points);
  EXPECT_EQ(rounding.farthest(), 0);
}

TEST(LatticeRounding, ReadsIntegersOfTheSourcesLattice) {
  const IntegerLattice source{{0.5, 0.5, 0.5}, {10, 20, 30}};
  LatticeRounding rounding("out.las", IntegerLattice{}, source, {});
  std::vector<LatticePoint> points = {{2, 4, 7}};
  rounding.round(points, std::vector<std::uint64_t>{0});
  EXPECT_EQ(points[0], (LatticePoint{11, 22, 34})) << "33.5 is half-way, away from 0";
  EXPECT_EQ(rounding.farthest(), 0.5);
}

TEST(LatticeRounding, NamesTheFirstPointThat32BitsDoNotReach) {
  const IntegerLattice target{{0.001, 0.001, 0.001}, {0, 0, 0}};
  LatticeRounding rounding("out.las", target, std::nullopt, {});
  std::vector<LatticePoint> points = {
      {2'147'483.647, -2'147'483.648, 0}, {0, 2'147'483.648, 0}, {1e9, 0, 0}};
  const auto error = thrown_by([&] {
    rounding.round(points, std::vector<std::uint64_t>{3, 5, 9});
  });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("out.las"));
  EXPECT_THAT(error->what(), HasSubstr("point 5 is at (0, 2147483.648, 0)"));
  EXPECT_EQ(error->facts().place.unit, PlaceUnit::kRecord);
  EXPECT_EQ(error->facts().place.number, 5U);
  EXPECT_EQ(error->facts().remedy, Remedy::kPointLattice);
}

TEST(LatticeRounding, RefusesCoordinatesThatAreNone) {
  LatticeRounding rounding("out.las", IntegerLattice{}, std::nullopt, {});
  std::vector<LatticePoint> points = {{0, std::numeric_limits<double>::quiet_NaN(), 0}};
  EXPECT_TRUE(thrown_by([&] { rounding.round(points, std::vector<std::uint64_t>{0}); }));
}

/// Doubles near 10^9 are 10^-7 apart.
TEST(LatticeRounding, RefusesALatticeWhoseNeighboursWouldBecomeOnePoint) {
  const IntegerLattice fine{{1e-8, 1, 1}, {1e9, 0, 0}};
  const Box<3> extent{{1e9 - 1, 0, 0}, {1e9 + 1, 1, 1}};
  const auto error = thrown_by([&] { LatticeRounding("out.las", fine, std::nullopt, extent); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->facts().remedy, Remedy::kPointLattice);

  LatticeRounding later("out.las", fine, std::nullopt, {});
  std::vector<LatticePoint> points = {{1e9, 0, 0}};
  const auto of_points = thrown_by([&] { later.round(points, std::vector<std::uint64_t>{0}); });
  ASSERT_TRUE(of_points) << "the extent was not known before";
  EXPECT_EQ(of_points->facts().remedy, Remedy::kPointLattice);
}

}  // namespace
}  // namespace spillway::test
