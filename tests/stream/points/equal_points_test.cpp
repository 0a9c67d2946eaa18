#include "stream/points/equal_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "stream/output/heights.h"

namespace spillway::test {
namespace {

const std::vector<LatticePoint> kPoints = {{1, 2, 5}, {1, 2, 3}, {1, 2, 9}, {1, 2, 3}, {1, 2, 9}};
const std::vector<std::uint64_t> kIndex = {40, 30, 20, 10, 50};
const std::vector<std::byte> kAttributes = {std::byte{40}, std::byte{30}, std::byte{20},
                                            std::byte{10}, std::byte{50}};

PointBlock chosen(Heights choice, bool index, int dimension = 2) {
  EqualPoints equal(dimension, choice);
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    PointsView point = PointsView{kPoints, kIndex, kAttributes}.subview(i, 1);
    if (!index) point.index = {};
    equal.add(point);
  }
  EXPECT_EQ(equal.count(), kPoints.size());
  return equal.choose();
}

TEST(EqualPoints, ChoosesByHeightAndThenByThePlaceInTheInput) {
  EXPECT_EQ(chosen(Heights::kFirst, false).points[0][2], 5);
  EXPECT_EQ(chosen(Heights::kFirst, true).index[0], 10U);
  EXPECT_EQ(chosen(Heights::kFirst, true).points[0][2], 3);
  EXPECT_EQ(chosen(Heights::kLowest, true).index[0], 10U);
  EXPECT_EQ(chosen(Heights::kHighest, true).index[0], 20U);
  EXPECT_EQ(chosen(Heights::kHighest, true).points[0][2], 9);
  EXPECT_EQ(chosen(Heights::kMean, true).points[0][2], 29.0 / 5);
  EXPECT_EQ(chosen(Heights::kMean, true).index[0], 10U);
}

TEST(EqualPoints, KeepTheAttributesOfTheChosenOne) {
  for (const Heights choice :
       {Heights::kFirst, Heights::kLowest, Heights::kHighest, Heights::kMean}) {
    const PointBlock one = chosen(choice, true);
    ASSERT_EQ(one.attributes.size(), 1U);
    EXPECT_EQ(std::to_integer<std::uint64_t>(one.attributes[0]), one.index[0]);
  }
}

TEST(EqualPoints, OfSpaceAreTheFirst) {
  EXPECT_EQ(chosen(Heights::kHighest, true, 3).index[0], 10U);
  EXPECT_EQ(chosen(Heights::kMean, false, 3).points[0][2], 5);
}

/// To the last bit, whatever the heights.
TEST(EqualPoints, ChoosesWhatIsChosenOfPointsInMemory) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(-1e3, 1e9);
  constexpr std::size_t kCount = 1000;
  std::vector<LatticePoint> points(kCount);
  std::vector<double> heights(kCount);
  std::vector<std::uint64_t> index(kCount);
  std::iota(index.begin(), index.end(), 7);
  std::shuffle(index.begin(), index.end(), random);
  for (std::size_t i = 0; i < kCount; ++i) {
    heights[i] = std::round(height(random) / 1e7) * 0.1;
    points[i] = {1, 1, heights[i]};
  }
  for (const Heights choice :
       {Heights::kFirst, Heights::kLowest, Heights::kHighest, Heights::kMean}) {
    std::vector<DroppedDuplicate> duplicates;
    for (std::size_t i = 1; i < kCount; ++i) {
      DroppedDuplicate& duplicate = duplicates.emplace_back();
      duplicate.dropped = static_cast<VertexId>(i);
      duplicate.kept = 0;
    }
    std::vector<VertexId> places(kCount);
    std::iota(places.begin(), places.end(), VertexId{0});
    std::vector<double> chosen_heights = heights;
    choose_heights(duplicates, choice, places, chosen_heights, index);
    EqualPoints equal(2, choice);
    equal.add({points, index});
    const PointBlock chosen = equal.choose();
    EXPECT_EQ(chosen.index[0], index[places[0]]);
    EXPECT_EQ(chosen.points[0][2], chosen_heights[places[0]]);
  }
}

}  // namespace
}  // namespace spillway::test
