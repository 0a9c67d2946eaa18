// Where ranks are parted, by a sample: in equal numbers, and where few simplices are cut.

#include "stream/tiles/cuts/sample_division.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Coordinates of one seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// In a box around a place.
  LatticePoint near(const LatticePoint& middle, const LatticePoint& size) {
    LatticePoint point;
    for (int k = 0; k < 3; ++k) {
      point[k] = middle[k] + between(-0.5 * size[k], 0.5 * size[k]);
    }
    return point;
  }
  void shuffle(std::vector<LatticePoint>& points) { std::ranges::shuffle(points, engine_); }

 private:
  std::mt19937 engine_;
};

std::vector<LatticePoint> boxful(std::size_t count, const LatticePoint& size, unsigned seed) {
  Random random(seed);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& point : points) point = random.near({0, 0, 0}, size);
  return points;
}

/// A layer without height, and one of a hundred points far above and below.
std::vector<LatticePoint> layer_with_strays(std::size_t count, int height_axis) {
  LatticePoint size{1, 1, 1};
  size[height_axis] = 0.001;
  std::vector<LatticePoint> points = boxful(count, size, 2);
  Random random(3);
  for (std::size_t i = 0; i < count; i += 100) points[i][height_axis] = random.between(-9, 9);
  return points;
}

std::vector<std::size_t> points_of_parts(int dimension, const std::vector<DivisionCut>& cuts,
                                         const std::vector<LatticePoint>& points) {
  CutTree tree(dimension);
  tree.split(0, cuts);
  std::vector<std::uint32_t> tiles(points.size());
  tree.find_tiles(points, tiles);
  std::vector<std::size_t> counts(tree.tiles());
  for (const std::uint32_t tile : tiles) ++counts[tile];
  return counts;
}

/// Within 5 % for all.
void expect_even(const std::vector<std::size_t>& counts, std::size_t points, std::size_t parts) {
  EXPECT_EQ(counts.size(), parts);
  const double even = static_cast<double>(points) / static_cast<double>(parts);
  for (const std::size_t count : counts) EXPECT_NEAR(static_cast<double>(count), even, 0.05 * even);
}

TEST(SampleDivision, GivesAllPartsAsManyPoints) {
  for (const std::size_t parts : {1, 2, 3, 5, 8}) {
    const auto points = boxful(20'000, {3, 2, 1}, 1);
    expect_even(points_of_parts(2, divide_sample<2>(points, parts), points), 20'000, parts);
    expect_even(points_of_parts(3, divide_sample<3>(points, parts), points), 20'000, parts);
  }
}

TEST(SampleDivision, CutsTheLongestSideOfEvenlySpreadPoints) {
  const auto cuts = divide_sample<3>(boxful(20'000, {1, 1.5, 1.2}, 4), 2);
  ASSERT_THAT(cuts, SizeIs(1));
  EXPECT_EQ(cuts[0].where.axis, 1);
  EXPECT_NEAR(cuts[0].where.value, 0, 0.05);
}

/// A cut of the longest side would part its upper half from its lower one, and cross all simplices.
TEST(SampleDivision, CutsAThinLayerWithStraysAcrossTheLayer) {
  for (int height_axis = 0; height_axis < 3; ++height_axis) {
    const auto points = layer_with_strays(20'000, height_axis);
    const auto cuts = divide_sample<3>(points, 8);
    for (const DivisionCut& cut : cuts) EXPECT_NE(cut.where.axis, height_axis);
    expect_even(points_of_parts(3, cuts, points), points.size(), 8);
  }
  for (const DivisionCut& cut : divide_sample<2>(layer_with_strays(20'000, 1), 8)) {
    EXPECT_EQ(cut.where.axis, 0);
  }
}

/// Half of the points in each would be a cut through the larger one.
TEST(SampleDivision, PartsClustersWhereNothingLiesBetweenThem) {
  Random random(5);
  std::vector<LatticePoint> points;
  for (int i = 0; i < 10'100; ++i) points.push_back(random.near({0, 0, 0}, {1, 1, 1}));
  for (int i = 0; i < 9'900; ++i) points.push_back(random.near({1000, 3, 0}, {1, 1, 1}));
  random.shuffle(points);
  for (const DivisionCut& cut :
       {divide_sample<2>(points, 2).at(0), divide_sample<3>(points, 2).at(0)}) {
    EXPECT_EQ(cut.where.axis, 0);
    EXPECT_NEAR(cut.where.value, 500, 1);
  }
}

/// They have simplices as the square of their number: all of the sample would be a billion.
TEST(SampleDivision, TriangulatesFewPointsOfSkewLines) {
  Random random(7);
  std::vector<LatticePoint> points;
  for (int i = 0; i < 60'000; ++i) {
    const double t = random.between(0, 1);
    points.push_back(i % 2 == 0 ? LatticePoint(t, 0, 0) : LatticePoint(0, t, 1));
  }
  expect_even(points_of_parts(3, divide_sample<3>(points, 8), points), points.size(), 8);
}

/// The longest side is that of the lines. Few points, but many simplices would be cut.
TEST(SampleDivision, CutsOtherPointsRatherThanSkewLines) {
  Random random(8);
  std::vector<LatticePoint> points = boxful(20'000, {4, 3, 3}, 9);
  for (int i = 0; i < 2'000; ++i) {
    const double t = random.between(-1.9, 1.9);
    points.push_back(i % 2 == 0 ? LatticePoint(t, 1.7, -0.5)
                                : LatticePoint(t, 1.7 + 0.05 * t, 0.5));
  }
  random.shuffle(points);
  const auto cuts = divide_sample<3>(points, 2);
  ASSERT_THAT(cuts, SizeIs(1));
  EXPECT_EQ(cuts[0].where.axis, 1);
}

TEST(SampleDivision, OfEqualPointsMakesNoCut) {
  EXPECT_THAT(divide_sample<2>(std::vector<LatticePoint>(3'000, {1, 2, 3}), 4), IsEmpty());
  EXPECT_THAT(divide_sample<3>(std::vector<LatticePoint>(3'000, {1, 2, 3}), 4), IsEmpty());
  EXPECT_THAT(divide_sample<3>({}, 4), IsEmpty());
}

TEST(SampleDivision, NeverPartsEqualCoordinatesAndLeavesNoPartEmpty) {
  std::vector<LatticePoint> points(3'000, {1, 2, 3});
  points.resize(4'000, {7, 2, 3});
  for (const std::size_t parts : {2, 3, 8}) {
    const auto counts = points_of_parts(3, divide_sample<3>(points, parts), points);
    EXPECT_THAT(counts, ::testing::UnorderedElementsAre(3'000, 1'000));
  }
}

TEST(SampleDivision, DividesPointsOfALineEvenly) {
  std::vector<LatticePoint> points;
  for (int i = 0; i < 6'000; ++i) points.emplace_back(3.0 * i, -2.0 * i, 5.0 * i);
  expect_even(points_of_parts(3, divide_sample<3>(points, 5), points), points.size(), 5);
  expect_even(points_of_parts(2, divide_sample<2>(points, 5), points), points.size(), 5);
}

TEST(SampleDivision, GivesFewerPointsThanPartsAPartEach) {
  const auto points = boxful(5, {1, 1, 1}, 10);
  EXPECT_THAT(points_of_parts(3, divide_sample<3>(points, 16), points), Each(1U));
  EXPECT_THAT(divide_sample<2>(points, 16), SizeIs(4));
}

TEST(SampleDivision, SeparatesNeighbouringDoubles) {
  const double low = 1;
  const double high = std::nextafter(low, 2.0);
  std::vector<LatticePoint> points(500, {low, 0, 0});
  points.resize(1'000, {high, 0, 0});
  const auto cuts = divide_sample<2>(points, 2);
  ASSERT_THAT(cuts, SizeIs(1));
  EXPECT_EQ(cuts[0].where.value, high);
}

}  // namespace
}  // namespace spillway::test
