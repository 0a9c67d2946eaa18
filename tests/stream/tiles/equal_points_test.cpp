#include "stream/tiles/equal_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "stream/output/heights.h"

namespace spillway::detail {
namespace {

const std::vector<LatticePoint> kPoints = {{1, 2, 5}, {1, 2, 3}, {1, 2, 9}, {1, 2, 3}, {1, 2, 9}};
const std::vector<std::uint64_t> kIndex = {40, 30, 20, 10, 50};

EqualPoints::Chosen chosen(Heights choice, bool index, int dimension = 2) {
  EqualPoints equal(dimension, choice);
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    equal.add(std::span(kPoints).subspan(i, 1),
              index ? std::span(kIndex).subspan(i, 1) : std::span<const std::uint64_t>());
  }
  EXPECT_EQ(equal.count(), kPoints.size());
  return equal.choose();
}

TEST(EqualPoints, ChoosesByHeightAndThenByThePlaceInTheInput) {
  EXPECT_EQ(chosen(Heights::kFirst, false).point[2], 5);
  EXPECT_EQ(chosen(Heights::kFirst, true).index, 10U);
  EXPECT_EQ(chosen(Heights::kFirst, true).point[2], 3);
  EXPECT_EQ(chosen(Heights::kLowest, true).index, 10U);
  EXPECT_EQ(chosen(Heights::kHighest, true).index, 20U);
  EXPECT_EQ(chosen(Heights::kHighest, true).point[2], 9);
  EXPECT_EQ(chosen(Heights::kMean, true).point[2], 29.0 / 5);
  EXPECT_EQ(chosen(Heights::kMean, true).index, 10U);
}

TEST(EqualPoints, OfSpaceAreTheFirst) {
  EXPECT_EQ(chosen(Heights::kHighest, true, 3).index, 10U);
  EXPECT_EQ(chosen(Heights::kMean, false, 3).point[2], 5);
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
    std::vector<Duplicate> duplicates;
    for (std::size_t i = 1; i < kCount; ++i) {
      Duplicate& duplicate = duplicates.emplace_back();
      duplicate.dropped = static_cast<VertexId>(i);
      duplicate.kept = 0;
    }
    std::vector<VertexId> places(kCount);
    std::iota(places.begin(), places.end(), VertexId{0});
    std::vector<double> chosen_heights = heights;
    choose_heights(duplicates, choice, places, chosen_heights, index);
    EqualPoints equal(2, choice);
    equal.add(points, index);
    const EqualPoints::Chosen chosen = equal.choose();
    EXPECT_EQ(chosen.index, index[places[0]]);
    EXPECT_EQ(chosen.point[2], chosen_heights[places[0]]);
  }
}

}  // namespace
}  // namespace spillway::detail
