// What each filter keeps, which of them counts a point that several would drop.

#include "stream/source/point_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bitset>
#include <limits>
#include <string>
#include <vector>

#include "src/error.h"
#include "tests/formats/points/las_flags_layout.h"

namespace spillway::test {
namespace {

TEST(ReturnFilter, FirstLastAndSingle) {
  const ReturnFilter first{.first = true};
  const ReturnFilter last{.last = true};
  const ReturnFilter single{.single = true};
  EXPECT_TRUE(first.keeps(1, 3));
  EXPECT_FALSE(first.keeps(2, 3));
  EXPECT_TRUE(last.keeps(3, 3));
  EXPECT_FALSE(last.keeps(2, 3));
  EXPECT_TRUE(single.keeps(1, 1));
  EXPECT_FALSE(single.keeps(1, 2));
  EXPECT_FALSE(single.keeps(2, 2));
}

TEST(ReturnFilter, AnUnknownReturnIsFirstAndLast) {
  for (const ReturnFilter& filter :
       {ReturnFilter{.first = true}, ReturnFilter{.last = true}, ReturnFilter{.single = true}}) {
    EXPECT_TRUE(filter.keeps(0, 0));
  }
  EXPECT_FALSE(ReturnFilter{.numbers = 1 << 1}.keeps(0, 0));
}

TEST(ReturnFilter, NumbersAreAnyOfTheList) {
  const ReturnFilter filter{.numbers = 1 << 2 | 1 << 15};
  EXPECT_TRUE(filter.keeps(2, 2));
  EXPECT_TRUE(filter.keeps(15, 15));
  EXPECT_FALSE(filter.keeps(1, 2));
}

/// Points (i, 0, 10 i) of class i and of return 1 + i % 2 of 2.
PointBlock twelve_points() {
  PointBlock block;
  std::vector<LasFlags> flags;
  for (std::uint8_t i = 0; i < 12; ++i) {
    block.points.push_back({1.0 * i, 0, 10.0 * i});
    block.index.push_back(100 + i);
    flags.push_back({.classification = i,
                     .return_number = static_cast<std::uint8_t>(1 + i % 2),
                     .return_count = 2});
  }
  block.attributes = records_of(flags);
  return block;
}

PointCounts apply(const PointFilter& filter, PointBlock& block,
                  const std::optional<IntegerLattice>& lattice = std::nullopt) {
  PointCounts counts;
  counts.read = block.size();
  apply_filter(filter, lattice, flags_layout(), block, counts);
  EXPECT_EQ(counts.kept(), block.size());
  EXPECT_EQ(block.index.size(), block.size());
  return counts;
}

TEST(PointFilter, EachPointIsCountedWhereItIsDroppedFirst) {
  PointFilter filter;
  filter.every = 2;                                  // 0, 2, ... 10 stay
  filter.classes = std::bitset<256>("11111111100");  // without 0
  filter.returns = ReturnFilter{.first = true};      // all of these
  filter.bounds = Box<3>{{4, 0, 0}, {8, 0, 1000}};   // without 2, 10
  PointBlock block = twelve_points();
  const PointCounts counts = apply(filter, block);
  EXPECT_EQ(counts, (PointCounts{.read = 12,
                                 .skipped = 6,
                                 .classes = 1,
                                 .bounds = 2,
                                 .other_classes = std::bitset<256>("1")}));
  EXPECT_EQ(block.index, (std::vector<std::uint64_t>{104, 106, 108}));
  EXPECT_EQ(flags_of(block.attributes)[1].classification, 6);
  EXPECT_EQ(describe(counts),
            "12 points read, 6 skipped, 1 of other classes, 2 outside the bounds, 3 "
            "kept");
}

TEST(PointFilter, EveryCountsRecordsNotPointsThatWereKept) {
  PointBlock block = twelve_points();
  apply({.every = 5}, block);
  EXPECT_EQ(block.index, (std::vector<std::uint64_t>{100, 105, 110}));
}

TEST(PointFilter, BoundsAreClosedAndInOutputCoordinates) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const IntegerLattice lattice{{0.5, 0.5, 0.1}, {1000, 0, 0}};
  PointBlock plane = twelve_points();
  apply({.bounds = Box<3>{{1001, 0, -kAll}, {1002, 0, kAll}}}, plane, lattice);
  EXPECT_EQ(plane.index, (std::vector<std::uint64_t>{102, 103, 104}));
  PointBlock space = twelve_points();
  apply({.bounds = Box<3>{{1001, 0, 3}, {1002, 0, 3}}}, space, lattice);
  EXPECT_EQ(space.index, std::vector<std::uint64_t>{103});
}

TEST(PointFilter, AFilterThatLeavesNoPointsNamesTheClassesThatThereAre) {
  const auto message = [](const std::vector<int>& classes) {
    PointBlock block;
    std::vector<LasFlags> flags;
    PointFilter filter;
    filter.classes.emplace().set(2);
    for (const int c : classes) {
      block.points.push_back({0, 0, 0});
      block.index.push_back(block.index.size());
      flags.push_back({.classification = static_cast<std::uint8_t>(c)});
    }
    block.attributes = records_of(flags);
    const PointCounts counts = apply(filter, block);
    try {
      refuse_empty_input(counts);
    } catch (const Failure& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message({9, 3, 0, 4, 255, 5, 3}),
            "the filters leave no points: 7 points read, 7 of other classes (0, 3-5, 9, 255), 0 "
            "kept");
  EXPECT_THAT(message({1}), ::testing::EndsWith("1 of other classes (1), 0 kept"));
  EXPECT_THAT(message({}), ::testing::EndsWith("the input has no points"));
}

TEST(PointCounts, AddUp) {
  PointCounts sum{.read = 5, .withheld = 1, .other_classes = std::bitset<256>("10")};
  sum += {.read = 7, .returns = 2, .thinned = 3, .other_classes = std::bitset<256>("101")};
  EXPECT_EQ(sum.other_classes, std::bitset<256>("111"));
  EXPECT_EQ(sum.kept(), 6U);
  EXPECT_EQ(describe(sum), "12 points read, 1 withheld, 2 of other returns, 3 thinned, 6 kept");
}

}  // namespace
}  // namespace spillway::test
