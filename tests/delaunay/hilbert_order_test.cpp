#include "src/delaunay/hilbert_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/generators/random.h"

namespace spillway {
namespace {

using Points = std::vector<Point<2>>;

std::vector<VertexId> order_of(const Points& points) {
  Box<2> box;
  for (const Point<2>& p : points) box.expand(p);
  return hilbert_order<2>(points, box);
}

/// The length of the tour in that order, over the side of its square.
double tour_length(const Points& points, double side) {
  const std::vector<VertexId> order = order_of(points);
  double length = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Point<2>& a = points[order[i - 1]];
    const Point<2>& b = points[order[i]];
    length += std::hypot(a[0] - b[0], a[1] - b[1]);
  }
  return length / side;
}

Points random_points(std::size_t count, double side) {
  Random random(9);
  Points points(count);
  for (Point<2>& p : points) p = {side * random.uniform(), side * random.uniform()};
  return points;
}

TEST(HilbertOrder, HasEveryPointOnce) {
  for (const std::size_t count : {0, 1, 2, 600, 20'000}) {
    std::vector<VertexId> order = order_of(random_points(count, 1));
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), count);
    for (VertexId i = 0; i < count; ++i) ASSERT_EQ(order[i], i);
  }
}

TEST(HilbertOrder, MakesShortTours) {
  constexpr std::size_t kCount = 10'000;  // the shortest tour is about 0.71 sqrt(n)
  EXPECT_LT(tour_length(random_points(kCount, 1), 1), 1.1 * std::sqrt(kCount));
}

TEST(HilbertOrder, MakesShortToursInACrowdedCell) {
  constexpr std::size_t kCount = 10'000;
  constexpr double kSide = 1e-9;
  Points points = random_points(kCount, kSide);
  points.push_back({1, 1});
  const double way_to_the_corner = std::sqrt(2.0) / kSide;
  EXPECT_LT(tour_length(points, kSide) - way_to_the_corner, 1.2 * std::sqrt(kCount));
}

TEST(HilbertOrder, EndsOnEqualPointsAndOnExtremeOnes) {
  Points points(100, {5, 5});
  points.push_back({6, 5});
  EXPECT_EQ(order_of(points).size(), 101U);
  constexpr double kMax = std::numeric_limits<double>::max();
  points.assign(100, {-kMax, 0});
  points.resize(200, {kMax, 1});
  EXPECT_EQ(order_of(points).size(), 200U);
  points.assign(100, {0, 0});
  points.resize(200, {0x1p-1074, 0});
  EXPECT_EQ(order_of(points).size(), 200U);
}

}  // namespace
}  // namespace spillway
