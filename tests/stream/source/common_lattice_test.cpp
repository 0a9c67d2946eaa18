// The lattice that several inputs have in common: exact, the same for any order of the inputs, and
// refused where integers would not fit.

#include "stream/source/common_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace spillway::test {
namespace {

IntegerLattice lattice(double scale, double offset = 0) {
  return {{scale, scale, scale}, {offset, offset, offset}};
}

TEST(CommonLattice, OfOneInputIsItsOwn) {
  const IntegerLattice own{{0.01, 0.01, 0.001}, {500000, 4100000.5, -3}};
  const auto common = find_common_lattice(std::vector{own}, 2);
  ASSERT_TRUE(common);
  EXPECT_EQ(common->lattice, own);
  EXPECT_TRUE(common->heights);
  EXPECT_TRUE(common->maps[0].is_identity());
}

TEST(CommonLattice, OffsetsMayDifferByWholeSteps) {
  const std::vector<IntegerLattice> lattices = {{{0.01, 0.01, 0.01}, {100, 200, 0}},
                                                {{0.01, 0.01, 0.01}, {100.5, 100, 0.07}}};
  const auto common = find_common_lattice(lattices, 3);
  ASSERT_TRUE(common);
  EXPECT_EQ(common->lattice.offset, (std::array<double, 3>{100, 100, 0}));
  EXPECT_EQ(common->maps[0].shift, (std::array<double, 3>{0, 10000, 0}));
  EXPECT_EQ(common->maps[1].shift, (std::array<double, 3>{50, 0, 7}));
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(0.01), lattice(0.01, 0.005)}, 3));
}

TEST(CommonLattice, TakesTheFinestScaleOfWhichOthersAreMultiples) {
  const auto common =
      find_common_lattice(std::vector{lattice(0.01), lattice(0.001), lattice(0.25)}, 3);
  ASSERT_TRUE(common);
  EXPECT_EQ(common->lattice.scale[0], 0.001);
  EXPECT_EQ(common->maps[0].factor[0], 10);
  EXPECT_EQ(common->maps[1].factor[0], 1);
  EXPECT_EQ(common->maps[2].factor[0], 250);
}

TEST(CommonLattice, TakesTheLargestPartOfAllScalesWhereNoneIsAMultiple) {
  const auto common = find_common_lattice(std::vector{lattice(0.25), lattice(0.1)}, 2);
  ASSERT_TRUE(common);
  EXPECT_EQ(common->lattice.scale[0], 0.05);
  EXPECT_EQ(common->maps[0].factor[0], 5);
  EXPECT_EQ(common->maps[1].factor[0], 2);
}

TEST(CommonLattice, JoinsTheAxesOfOneInput) {
  const IntegerLattice flat{{0.01, 0.01, 1e-5}, {0, 0, 0}};
  const auto space = find_common_lattice(std::vector{flat}, 3);
  ASSERT_TRUE(space);
  EXPECT_EQ(space->lattice.scale[0], 1e-5);
  EXPECT_EQ(space->maps[0].factor, (std::array<double, 3>{1000, 1000, 1}));
  const auto plane = find_common_lattice(std::vector{flat}, 2);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->lattice, flat);
}

TEST(CommonLattice, LeavesOutHeightsThatDoNotFit) {
  const std::vector<IntegerLattice> lattices = {{{0.01, 0.01, 0.01}, {0, 0, 0}},
                                                {{0.01, 0.01, 0.01}, {0, 0, -0.0033}}};
  const auto common = find_common_lattice(lattices, 2);
  ASSERT_TRUE(common);
  EXPECT_FALSE(common->heights);
  EXPECT_EQ(common->lattice.scale[2], 1);
  EXPECT_EQ(common->lattice.offset[2], 0);
  EXPECT_EQ(common->maps, std::vector<LatticeMap>(2));
  EXPECT_FALSE(find_common_lattice(lattices, 3));
}

TEST(CommonLattice, IsRefusedWhereScalesHaveNoCommonStep) {
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(0.01), lattice(0.0030480061)}, 2));
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(0.01), lattice(std::sqrt(1e-4) / M_PI)}, 2));
}

TEST(CommonLattice, IsRefusedWhereASmallErrorOfTheScaleAddsUpToSteps) {
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(0.001), lattice(0.01 * (1 + 1e-9))}, 2));
}

TEST(CommonLattice, IsRefusedWhereIntegersWouldNotFit) {
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(1e-9), lattice(0.01)}, 2));
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(1e-9), lattice(1e-9, 1e7)}, 2));
}

TEST(CommonLattice, NegativeScalesMirrorTheIntegers) {
  const IntegerLattice mirrored{{0.01, -0.01, -0.01}, {100, 200, 7}};
  const auto own = find_common_lattice(std::vector{mirrored}, 3);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->lattice, (IntegerLattice{{0.01, 0.01, 0.01}, {100, 200, 7}}));
  EXPECT_EQ(own->maps[0].factor, (std::array<double, 3>{1, -1, -1}));
  EXPECT_EQ(own->lattice.to_world(1, own->maps[0].map(1, 12345)), mirrored.to_world(1, 12345));
  const auto both = find_common_lattice(std::vector{lattice(-0.02, 1), lattice(0.01)}, 2);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->maps[0], (LatticeMap{{-2, -2, -2}, {100, 100, 100}}));
  EXPECT_FALSE(find_common_lattice(std::vector{lattice(-0.01 * (1 + 1e-9)), lattice(0.001)}, 2));
}

TEST(CommonLattice, LargeIntegersAreRefusedWhereTheyWouldNotFit) {
  const std::vector lattices = {lattice(0.01), lattice(0.01, 1)};
  const std::vector<double> all_of_spp = {0x1p31, 0x1p53};
  EXPECT_TRUE(find_common_lattice(lattices, 2));
  EXPECT_FALSE(find_common_lattice(lattices, 2, all_of_spp));
  EXPECT_TRUE(find_common_lattice(lattices, 2, std::vector<double>{0x1p31, 0x1p51}));
  const std::vector unmoved = {lattice(0.01), lattice(0.01)};
  EXPECT_TRUE(find_common_lattice(unmoved, 2, all_of_spp));
}

TEST(CommonLattice, LargeIntegersCarryAnErrorOfTheScaleFurther) {
  const double next = std::nextafter(0.01, 1);
  const std::vector lattices = {lattice(0.01), lattice(next)};
  EXPECT_TRUE(find_common_lattice(lattices, 2));
  EXPECT_FALSE(find_common_lattice(lattices, 2, std::vector<double>{0x1p31, 0x1p50}));
}

TEST(CommonLattice, LargestIntegerIsThatOfTheFormatOrTheExtent) {
  PointHeader header;
  header.format = "laz";
  header.lattice = lattice(-0.5, 10);
  EXPECT_EQ(largest_integer(header), 0x1p31);
  header.format = "spp";
  EXPECT_EQ(largest_integer(header), 0x1p53);
  header.extent = Box<3>{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(largest_integer(header), 0x1p31);
  header.extent->hi[2] = 0x1p40;
  EXPECT_NEAR(largest_integer(header), 0x1p41, 30);
}

TEST(CommonLattice, DoesNotDependOnTheOrderOfTheInputs) {
  std::vector<IntegerLattice> lattices = {lattice(0.25, 10), lattice(0.1, 4), lattice(0.01, 7.02)};
  std::sort(lattices.begin(), lattices.end(),
            [](const IntegerLattice& a, const IntegerLattice& b) { return a.scale < b.scale; });
  const IntegerLattice first = find_common_lattice(lattices, 3)->lattice;
  do {
    EXPECT_EQ(find_common_lattice(lattices, 3)->lattice, first);
  } while (std::next_permutation(
      lattices.begin(), lattices.end(),
      [](const IntegerLattice& a, const IntegerLattice& b) { return a.scale < b.scale; }));
}

/// Both coordinates are decimal numbers that the doubles stand for; they may differ in their last
/// place, as both are rounded.
TEST(CommonLattice, OutputCoordinatesAreThoseOfTheInputUpToTheLastPlace) {
  std::mt19937 random(11);
  const std::vector<IntegerLattice> lattices = {lattice(0.01, 500000), lattice(0.001, 4100000),
                                                lattice(0.25, 636001.75), lattice(0.01, 0)};
  const auto common = find_common_lattice(lattices, 3);
  ASSERT_TRUE(common);
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    for (int n = 0; n < 10'000; ++n) {
      const double integer = static_cast<std::int32_t>(random());
      const double own = lattices[i].to_world(0, integer);
      const double out = common->lattice.to_world(0, common->maps[i].map(0, integer));
      const double largest = std::max(std::abs(own), std::abs(lattices[i].offset[0]));
      EXPECT_NEAR(own, out, std::numeric_limits<double>::epsilon() * (largest + 500000))
          << i << ", " << integer;
    }
  }
}

}  // namespace
}  // namespace spillway::test
