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

/// To the last bit, whatever the heights and however many they are.
void expect_what_is_chosen_of_points_in_memory(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(-1e3, 1e9);
  std::vector<LatticePoint> points(count);
  std::vector<double> heights(count);
  std::vector<std::uint64_t> index(count);
  std::iota(index.begin(), index.end(), 7);
  std::shuffle(index.begin(), index.end(), random);
  for (std::size_t i = 0; i < count; ++i) {
    heights[i] = std::round(height(random) / 1e7) * 0.1;
    points[i] = {1, 1, heights[i]};
  }
  for (const Heights choice :
       {Heights::kFirst, Heights::kLowest, Heights::kHighest, Heights::kMean}) {
    std::vector<DroppedDuplicate> duplicates;
    for (std::size_t i = 1; i < count; ++i) {
      DroppedDuplicate& duplicate = duplicates.emplace_back();
      duplicate.dropped = static_cast<VertexId>(i);
      duplicate.kept = 0;
    }
    std::vector<VertexId> places(count);
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

TEST(EqualPoints, ChooseWhatIsChosenOfPointsInMemory) {
  expect_what_is_chosen_of_points_in_memory(1000);
  expect_what_is_chosen_of_points_in_memory(10'000);
}

TEST(MeanHeight, OfVeryManyIsExactInAnyOrder) {
  constexpr int kPairs = 100'000;
  MeanHeight up;
  MeanHeight down;
  for (int i = 0; i < kPairs; ++i) {
    up.add(i);
    up.add(1e17);
    down.add(1e17);
    down.add(kPairs - 1 - i);
  }
  const double mean = up.take();
  EXPECT_EQ(mean, down.take());
  EXPECT_DOUBLE_EQ(mean, (1e17 + (kPairs - 1) / 2.0) / 2);
}

TEST(MeanHeight, BeginsAnewOnceTaken) {
  MeanHeight mean;
  for (int i = 0; i < 5000; ++i) mean.add(3);
  EXPECT_EQ(mean.take(), 3);
  mean.add(1);
  mean.add(2);
  EXPECT_EQ(mean.take(), 1.5);
}

}  // namespace
}  // namespace spillway::test
