// The coordinates in which several inputs come together, and what lattices do not keep apart.

#include "stream/source/source_coordinates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Inputs a, b, ... of one format, each on a lattice or on none.
SourceFacts inputs_on(const std::vector<std::optional<IntegerLattice>>& lattices,
                      const std::string& format = "las") {
  SourceFacts facts;
  for (const std::optional<IntegerLattice>& lattice : lattices) {
    PointHeader header;
    header.name = std::string(1, static_cast<char>('a' + facts.inputs.size()));
    header.format = format;
    header.lattice = lattice;
    facts.inputs.push_back({header, std::nullopt});
  }
  return facts;
}

IntegerLattice lattice(double scale, double offset = 0, double z_offset = 0) {
  return {{scale, scale, scale}, {offset, offset, z_offset}};
}

class SourceCoordinatesTest : public ::testing::Test {
 protected:
  SourceCoordinates coordinates(const SourceFacts& facts, const PointFilter& filter = {}) {
    return {facts, 2, filter, [this](std::string_view text) { said_ += std::string(text) + "\n"; }};
  }

  static LatticePoint brought(const SourceCoordinates& coordinates, std::size_t input,
                              const LatticePoint& point) {
    PointBlock block;
    block.points = {point};
    coordinates.bring(input, {}, block);
    return block.points.front();
  }

  std::string said_;
};

TEST_F(SourceCoordinatesTest, OneInputKeepsItsIntegers) {
  const SourceFacts facts = inputs_on({lattice(0.01, 5)});
  const SourceCoordinates all = coordinates(facts);
  EXPECT_EQ(all.lattice(), lattice(0.01, 5));
  EXPECT_TRUE(all.heights_on_lattice());
  EXPECT_EQ(brought(all, 0, {1, 2, 3}), (LatticePoint{1, 2, 3}));
  EXPECT_EQ(said_, "");
}

TEST_F(SourceCoordinatesTest, SeveralLatticesBecomeOne) {
  const SourceFacts facts = inputs_on({lattice(0.5, 10), lattice(0.25, 8, 1)});
  const SourceCoordinates all = coordinates(facts);
  ASSERT_EQ(all.lattice(), (IntegerLattice{{0.25, 0.25, 0.25}, {8, 8, 0}}));
  EXPECT_EQ(brought(all, 0, {1, 2, 3}), (LatticePoint{10, 12, 6}));
  EXPECT_EQ(brought(all, 1, {1, 2, 3}), (LatticePoint{1, 2, 7}));
  EXPECT_EQ(said_, "points come on a lattice of step 0.25, heights on it, too\n");
}

TEST_F(SourceCoordinatesTest, HeightsThatDoNotFitComeInOutputUnits) {
  const SourceFacts facts = inputs_on({lattice(0.5), lattice(0.5, 0, 0.3)});
  const SourceCoordinates all = coordinates(facts);
  ASSERT_TRUE(all.lattice());
  EXPECT_FALSE(all.heights_on_lattice());
  EXPECT_EQ(brought(all, 0, {1, 2, 3}), (LatticePoint{1, 2, 1.5}));
  EXPECT_EQ(brought(all, 1, {1, 2, 3}), (LatticePoint{1, 2, 1.8}));
  EXPECT_THAT(said_, HasSubstr("heights as they are"));
}

TEST_F(SourceCoordinatesTest, WithoutACommonLatticePointsComeInOutputCoordinates) {
  const SourceFacts facts = inputs_on({lattice(0.5, 10), std::nullopt});
  const SourceCoordinates all = coordinates(facts);
  EXPECT_EQ(all.lattice(), std::nullopt);
  EXPECT_EQ(brought(all, 0, {1, 2, 3}), (LatticePoint{10.5, 11, 1.5}));
  EXPECT_EQ(brought(all, 1, {1, 2, 3}), (LatticePoint{1, 2, 3}));
  EXPECT_EQ(said_,
            "b: not on one lattice with the first input, so points come in output coordinates\n");
}

TEST_F(SourceCoordinatesTest, ABoxIsBroughtAlong) {
  const Box<3> world = {{10, 12, 1}, {11, 13, 2}};
  const SourceFacts plain = inputs_on({std::nullopt});
  EXPECT_EQ(coordinates(plain).of_world(world), world);
  const SourceFacts facts = inputs_on({lattice(0.5, 10)});
  EXPECT_EQ(coordinates(facts).of_world(world), (Box<3>{{0, 4, 2}, {2, 6, 4}}));
}

/// 0.01 n + 0.25 runs into its neighbours above 2^51 or so.
TEST_F(SourceCoordinatesTest, PointsThatFallTogetherAreRefusedInTheirBlock) {
  const SourceFacts facts = inputs_on({IntegerLattice{{0.01, 0.01, 0.01}, {0.25, 0, 0}}}, "spp");
  const SourceCoordinates all = coordinates(facts);
  EXPECT_EQ(brought(all, 0, {0x1p40, 0, 0})[0], 0x1p40);
  EXPECT_THROW(brought(all, 0, {-0x1p52, 0, 0}), Failure);
}

TEST_F(SourceCoordinatesTest, PointsThatAreDroppedMayFallTogether) {
  const SourceFacts facts = inputs_on({IntegerLattice{{0.01, 0.01, 0.01}, {0.25, 0, 0}}}, "spp");
  PointBlock block;
  block.points = {{-0x1p52, 0, 0}, {5, 5, 5}};
  block.index = {0, 1};
  const SourceCoordinates all =
      coordinates(facts, {.bounds = Box<3>{{-100, -100, -100}, {100, 100, 100}}});
  EXPECT_NO_THROW(all.bring(0, {}, block));
  EXPECT_EQ(block.size(), 2U);  // to drop them is the filter's work
}

TEST_F(SourceCoordinatesTest, AHeaderThatTellsOfSuchPointsIsEnough) {
  SourceFacts facts = inputs_on({IntegerLattice{{0.01, 0.01, 0.01}, {0.25, 0, 0}}}, "spp");
  facts.inputs[0].header.extent = Box<3>{{-5e13, 0, 0}, {0, 0, 0}};
  EXPECT_THROW(coordinates(facts), Failure);
  EXPECT_NO_THROW(coordinates(facts, {.every = 2}));
  EXPECT_NO_THROW(coordinates(facts, {.bounds = Box<3>{{-9, -9, -9}, {9, 9, 9}}}));
}

}  // namespace
}  // namespace spillway::test
