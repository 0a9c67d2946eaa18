#include "stream/tiles/cuts/sample_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "src/delaunay/delaunay.h"

namespace spillway::test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<LatticePoint> even_points(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) {
    for (double& x : p) x = static_cast<double>(random() % 1'000'000);
  }
  return points;
}

std::vector<LatticePoint> skew_lines(std::size_t count) {
  std::vector<LatticePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<double>(i / 2);
    points[i] = i % 2 == 0 ? LatticePoint{t, 0, 0} : LatticePoint{0, t, 1};
  }
  std::ranges::shuffle(points, std::mt19937_64(2));
  return points;
}

/// Simplices by the places of their corners.
template <int D>
std::multiset<std::array<Point<D>, D + 1>> placed(const SampleMesh<D>& mesh) {
  std::multiset<std::array<Point<D>, D + 1>> all;
  for (const auto& corners : mesh.simplices) {
    std::array<Point<D>, D + 1> places;
    std::ranges::transform(corners, places.begin(), [&](VertexId v) { return mesh.points.at(v); });
    std::ranges::sort(places);
    all.insert(places);
  }
  return all;
}

template <typename Dimension>
class SampleMeshTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SampleMeshTest, Dimensions);

TYPED_TEST(SampleMeshTest, OfFewPointsHasAllAndTheirFiniteSimplices) {
  constexpr int kD = TypeParam::value;
  const std::vector<LatticePoint> sample = even_points(300);
  const auto mesh = triangulate_sample<kD>(sample, 10'000);
  std::vector<Point<kD>> points;
  for (const LatticePoint& p : sample) points.push_back(mesh_point<kD>(p));
  EXPECT_THAT(mesh.points, ::testing::UnorderedElementsAreArray(points));
  EXPECT_EQ(mesh.simplices.size(),
            delaunay_triangulation<kD>(points, {.threads = 1}).finite_count());
}

TYPED_TEST(SampleMeshTest, APointWeighsAsManyAsItHasSimplices) {
  constexpr int kD = TypeParam::value;
  const auto mesh = triangulate_sample<kD>(even_points(300), 10'000);
  std::vector<double> weights(mesh.points.size());
  for (const auto& corners : mesh.simplices) {
    for (const VertexId v : corners) ++weights[v];
  }
  EXPECT_EQ(mesh.weights, weights);
}

TYPED_TEST(SampleMeshTest, TakesAboutAsManyAsItMaySpreadOverTheSample) {
  constexpr int kD = TypeParam::value;
  std::vector<LatticePoint> sample = even_points(50'000);
  std::ranges::sort(sample, {}, [](const LatticePoint& p) { return p[0]; });
  const auto mesh = triangulate_sample<kD>(sample, 2'000);
  EXPECT_GT(mesh.points.size(), 1'900U);
  EXPECT_LE(mesh.points.size(), 2'000U);
  for (int part = 0; part < 4; ++part) {
    const auto here = std::ranges::count_if(
        mesh.points, [&](const Point<kD>& p) { return static_cast<int>(p[0] / 250'000) == part; });
    EXPECT_NEAR(static_cast<double>(here), 500, 60);
  }
}

TYPED_TEST(SampleMeshTest, OfPointsThatLieFlatHasNoSimplices) {
  constexpr int kD = TypeParam::value;
  std::vector<LatticePoint> line;
  for (int i = 0; i < 100; ++i) line.push_back({1.0 * i, 2.0 * i, 3.0 * i});
  EXPECT_THAT(triangulate_sample<kD>(line, 1'000).simplices, IsEmpty());
  EXPECT_THAT(triangulate_sample<kD>(std::vector<LatticePoint>(50), 1'000).simplices, IsEmpty());
}

TYPED_TEST(SampleMeshTest, SidesHaveTheirPointsAndTheSimplicesThatDoNotCross) {
  constexpr int kD = TypeParam::value;
  const auto mesh = triangulate_sample<kD>(even_points(400), 10'000);
  for (int axis = 0; axis < kD; ++axis) {
    const Cut cut{.axis = axis, .value = mesh.points[7][axis]};
    const auto sides = mesh.sides(cut);
    EXPECT_EQ(sides[0].points.size() + sides[1].points.size(), mesh.points.size());
    for (int side = 0; side < 2; ++side) {
      const auto is_here = [&](const Point<kD>& p) {
        return (p[axis] >= cut.value) == (side == 1);
      };
      EXPECT_TRUE(std::ranges::all_of(sides[side].points, is_here)) << "on the cut is above it";
      std::multiset<std::array<Point<kD>, kD + 1>> expected;
      for (const auto& simplex : placed<kD>(mesh)) {
        if (std::ranges::all_of(simplex, is_here)) expected.insert(simplex);
      }
      EXPECT_EQ(placed<kD>(sides[side]), expected);
      EXPECT_THAT(sides[side].weights, SizeIs(sides[side].points.size()));
    }
    const auto sum = [](const std::vector<double>& weights) {
      return std::accumulate(weights.begin(), weights.end(), 0.0);
    };
    EXPECT_EQ(sum(sides[0].weights) + sum(sides[1].weights), sum(mesh.weights))
        << "those of simplices that are cut, too";
    EXPECT_EQ(sides[1].weights[0],
              mesh.weights[static_cast<std::size_t>(
                  std::ranges::find(mesh.points, sides[1].points[0]) - mesh.points.begin())]);
  }
}

TEST(SampleMesh, StopsAtFewPointsWhereTheyHaveManySimplices) {
  const auto mesh = triangulate_sample<3>(skew_lines(50'000), 40'000);
  EXPECT_LE(mesh.points.size(), 1'024U);
  EXPECT_GT(mesh.points.size(), 900U);
  EXPECT_GT(mesh.simplices.size(), 16 * mesh.points.size());
}

TEST(SampleMesh, InThePlaneHeightsDoNotCount) {
  std::vector<LatticePoint> sample = even_points(200);
  const auto flat = triangulate_sample<2>(sample, 1'000);
  for (LatticePoint& p : sample) p[2] = 1e9 - 7 * p[2];
  EXPECT_EQ(placed<2>(triangulate_sample<2>(sample, 1'000)), placed<2>(flat));
}

}  // namespace
}  // namespace spillway::test
