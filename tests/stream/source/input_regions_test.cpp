// What headers tell of where points lie, and what does not lie there.

#include "stream/source/input_regions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "src/error.h"
#include "stream/source/false_header.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::Pair;
using ::testing::SizeIs;

PointHeader header(const std::string& name, std::uint64_t count, double lo, double hi) {
  PointHeader header;
  header.name = name;
  header.format = "las";
  header.count = count;
  header.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {0, 0, 0}};
  header.extent.emplace();
  header.extent->expand(Point<3>{lo, lo, lo});
  header.extent->expand(Point<3>{hi, hi, hi});
  return header;
}

/// Regions of some inputs, and all they refer to.
struct Regions {
  explicit Regions(std::vector<PointHeader> headers, const PointFilter& filter = {}) {
    for (PointHeader& header : headers) facts.inputs.push_back({std::move(header), std::nullopt});
    coordinates.emplace(facts, 2, filter, [](std::string_view) {});
    regions.emplace(facts, *coordinates, filter);
  }

  [[nodiscard]] const std::vector<InputRegion>& all() const { return regions->all(); }

  SourceFacts facts;
  std::optional<SourceCoordinates> coordinates;
  std::optional<InputRegions> regions;
};

TEST(InputRegions, AreFilesWithTheirExtentOnTheCommonLattice) {
  const Regions two({header("a.las", 10, 1, 2), header("b.las", 20, 5, 8)});
  ASSERT_THAT(two.all(), SizeIs(2));
  EXPECT_EQ(two.all()[0].unit, 0U);
  EXPECT_EQ(two.all()[1].unit, 1U);
  EXPECT_EQ(two.all()[1].count, 20U);
  EXPECT_NEAR(two.all()[1].box.lo[0], 499, 1e-6) << "a step of the lattice less";
  EXPECT_NEAR(two.all()[1].box.hi[1], 801, 1e-6);
  EXPECT_EQ(two.regions->turns()[1].input, 1U);
  EXPECT_EQ(two.regions->turns()[1].piece, std::nullopt);
}

TEST(InputRegions, ThereAreNoneIfAnyInputDoesNotTell) {
  PointHeader silent = header("b.txt", 20, 5, 8);
  silent.extent.reset();
  EXPECT_THAT(Regions({header("a.las", 10, 1, 2), silent}).all(), IsEmpty());
  PointHeader not_filled_in = header("c.las", 20, 0, 0);
  EXPECT_THAT(Regions({header("a.las", 10, 1, 2), not_filled_in}).all(), IsEmpty());
  PointHeader empty = header("d.las", 0, 0, 0);
  empty.extent.reset();
  const Regions with_empty({header("a.las", 10, 1, 2), empty});
  ASSERT_THAT(with_empty.all(), SizeIs(2));
  EXPECT_TRUE(with_empty.all()[1].box.empty());
}

TEST(InputRegions, AreThePartsThatAHeaderTells) {
  PointHeader parts = header("a.spp", 30, 1, 9);
  parts.regions = {{*header("", 0, 1, 4).extent, 10}, {*header("", 0, 4, 9).extent, 20}};
  const Regions in_order({header("b.las", 5, 0, 1), parts});
  ASSERT_THAT(in_order.all(), SizeIs(3));
  EXPECT_EQ(in_order.all()[1].unit, in_order.all()[2].unit);
  EXPECT_EQ(in_order.regions->number(1, 1), 2U);
  Regions by_pieces({parts});
  by_pieces.facts.inputs[0].pieces = 2;
  const InputRegions nodes(by_pieces.facts, *by_pieces.coordinates, {});
  EXPECT_NE(nodes.all()[0].unit, nodes.all()[1].unit);
  EXPECT_EQ(nodes.turns()[1].piece, 1U);
}

PointHeader sorted_header() {
  PointHeader sorted = header("a.spp", 30, 1, 9);
  sorted.format = "spp";
  sorted.regions = {{*header("", 0, 1, 4).extent, 10}, {*header("", 0, 4.01, 9).extent, 20}};
  sorted.regions_are_exact = true;
  return sorted;
}

/// Where the first cell ends and the second one begins, on the first axis.
std::pair<double, double> sides(const Regions& regions) {
  return {regions.all()[0].box.hi[0], regions.all()[1].box.lo[0]};
}

TEST(InputRegions, AreExactWhereTheyAreCellsOfASortedStream) {
  PointHeader sorted = sorted_header();
  EXPECT_THAT(sides(Regions({sorted})), Pair(400, 401));
  sorted.lattice.reset();
  EXPECT_THAT(sides(Regions({sorted})), Pair(4, 4.01));
  sorted.regions_are_exact = false;
  EXPECT_THAT(sides(Regions({sorted})), Pair(Gt(4), Lt(4.01)));
}

TEST(InputRegions, AreExactOnALatticeThatOthersShare) {
  PointHeader quarters = sorted_header();
  quarters.lattice->scale = {0.25, 0.25, 0.25};
  quarters.regions[1].box.lo = {4.25, 4.25, 4.25};
  PointHeader eighths = header("b.las", 5, 0, 1);
  eighths.lattice->scale = {0.125, 0.125, 0.125};
  EXPECT_THAT(sides(Regions({quarters, eighths})), Pair(32, 34));
  PointHeader without = header("b.txt", 5, 0, 1);
  without.lattice.reset();
  EXPECT_THAT(sides(Regions({sorted_header(), without})), Pair(4, 4.01));
  PointHeader downwards = sorted_header();
  downwards.lattice->scale[0] = -0.01;
  const auto [first_side, second_side] = sides(Regions({downwards}));
  EXPECT_EQ(std::abs(first_side - second_side), 1);
}

TEST(InputRegions, AnExactOneEndsAtTheBoundsOfAFilterAtTheMost) {
  PointFilter filter;
  filter.bounds = *header("", 0, 0, 3.14159).extent;
  const Regions cut({sorted_header()}, filter);
  EXPECT_NEAR(cut.all()[0].box.hi[0], 315.159, 1e-6);
  EXPECT_EQ(cut.all()[0].box.lo[0], 100);
  EXPECT_TRUE(cut.all()[1].box.empty());
}

TEST(InputRegions, PointsOnTheSidesOfAnExactOneAreInside) {
  const Regions sorted({sorted_header()});
  PointBlock block;
  block.points = {{100, 100, 0}, {400, 100, 0}, {100, 400, 0}, {400, 400, 0}};
  block.index = {0, 1, 2, 3};
  EXPECT_NO_THROW(sorted.regions->check(block, 0));
  EXPECT_THROW(sorted.regions->check(block, 1), Failure);
}

TEST(InputRegions, AFilterLeavesAPartOfThem) {
  PointFilter filter;
  filter.every = 5;
  filter.bounds = *header("", 0, 1.5, 4).extent;
  const Regions some({header("a.las", 10, 1, 2), header("b.las", 20, 5, 8)}, filter);
  EXPECT_EQ(some.all()[0].count, 2U);
  EXPECT_NEAR(some.all()[0].box.lo[0], 149, 1e-6);
  EXPECT_TRUE(some.all()[1].box.empty());
}

TEST(InputRegions, APointOutsideIsAnErrorThatNamesFileAndPoint) {
  const Regions two({header("a.las", 10, 1, 2), header("b.las", 20, 5, 8)});
  PointBlock block;
  block.points = {{500, 600, 0}, {801, 800, 1e9}, {499, 700, -1e9}};
  block.index = {7, 8, 9};
  EXPECT_NO_THROW(two.regions->check(block, 1))
      << "a step is no lie, and heights are not looked at";
  block.points.push_back({802, 700, 0});
  block.index.push_back(12);
  try {
    two.regions->check(block, 1);
    FAIL() << "no error";
  } catch (const FalseHeader& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("b.las: point 12 at (8.02, 7)"), HasSubstr("outside")));
    EXPECT_EQ(error.facts().remedy, Remedy::kDistrustHeaders);
    EXPECT_EQ(error.facts().place.number, 12U);
    EXPECT_THAT(error.finding(),
                AllOf(HasSubstr(error.what()), HasSubstr("from (5, 5) to (8, 8)")));
    EXPECT_EQ(error.extent(), std::nullopt);
  }
  EXPECT_NO_THROW(two.regions->check({}, 0));
}

/// Coordinates as they are in the field, of which sums with a step are not exact.
TEST(InputRegions, ABoxThatIsAStepOffIsNotFalse) {
  PointHeader north = header("a.las", 10, 1, 2);
  north.extent = Box<3>{{500'313.19, 4'100'225.17, 0}, {500'360.22, 4'100'289.47, 0}};
  const Regions one({north});
  PointBlock block;
  block.points = {{50'036'023, 410'028'948, 0}, {50'031'318, 410'022'516, 0}};
  block.index = {0, 1};
  EXPECT_NO_THROW(one.regions->check(block, 0));
  block.points = {{50'036'024, 410'028'948, 0}};
  EXPECT_THROW(one.regions->check(block, 0), FalseHeader);
}

}  // namespace
}  // namespace spillway::test
