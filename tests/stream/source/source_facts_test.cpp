// What follows from the headers of all inputs: counts, bounds, what the points have.

#include "stream/source/source_facts.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

/// An input of `count` points in [lo, hi] of x and in [0, 10] of y.
SourceFacts::Input input(std::optional<std::uint64_t> count, double lo, double hi) {
  PointHeader header;
  header.count = count;
  header.extent = Box<3>{{lo, 0, 0}, {hi, 10, 5}};
  return {header, std::nullopt};
}

TEST(SourceFacts, CountsAddUpWhereAllHeadersTell) {
  SourceFacts facts{{input(100, 0, 10), input(20, 10, 20)}, ""};
  EXPECT_EQ(facts.records(), 120U);
  EXPECT_EQ(facts.expected({}), 120U);
  facts.inputs.push_back(input(std::nullopt, 0, 1));
  EXPECT_EQ(facts.records(), std::nullopt);
  EXPECT_EQ(facts.expected({}), std::nullopt);
}

TEST(SourceFacts, AFilterLeavesAShareOfTheRecordsRoundedUp) {
  const SourceFacts facts{{input(100, 0, 10), input(20, 10, 20)}, ""};
  EXPECT_EQ(facts.expected({.every = 7}), 18U);
  EXPECT_EQ(facts.expected({.bounds = Box<3>{{5, 0, 0}, {12, 10, 5}}}), 54U);
  EXPECT_EQ(facts.expected({.bounds = Box<3>{{30, 0, 0}, {40, 10, 5}}}), 0U);
}

TEST(SourceFacts, AFlatInputCountsAsAWholeInsideOfBounds) {
  const SourceFacts facts{{input(100, 3, 3)}, ""};
  EXPECT_EQ(facts.expected({.bounds = Box<3>{{0, 0, 0}, {5, 1, 5}}}), 100U);
}

TEST(SourceFacts, TheExtentIsThatOfAllInputsInsideOfTheBounds) {
  SourceFacts facts{{input(100, 0, 10), input(20, 15, 20)}, ""};
  EXPECT_EQ(facts.extent(std::nullopt), (Box<3>{{0, 0, 0}, {20, 10, 5}}));
  EXPECT_EQ(facts.extent(Box<3>{{5, -1, 1}, {30, 7, 9}}), (Box<3>{{5, 0, 1}, {20, 7, 5}}));
  EXPECT_EQ(facts.extent(Box<3>{{5, 11, 1}, {30, 12, 9}}), std::nullopt);
  facts.inputs.front().header.extent.reset();
  EXPECT_EQ(facts.extent(std::nullopt), std::nullopt);
}

TEST(SourceFacts, OneInputIsEnoughToHaveHeightsOrAttributes) {
  SourceFacts facts{{input(1, 0, 1), input(1, 0, 1)}, ""};
  facts.inputs[0].header.coordinates = 2;
  facts.inputs[1].header.coordinates = 2;
  EXPECT_FALSE(facts.has_heights());
  EXPECT_TRUE(facts.attributes().empty());
  facts.inputs[1].header.coordinates = 3;
  facts.inputs[1].header.attributes = AttributeLayout({{.name = "intensity"}});
  EXPECT_TRUE(facts.has_heights());
  EXPECT_NE(facts.attributes().find("intensity"), nullptr);
}

}  // namespace
}  // namespace spillway::test
