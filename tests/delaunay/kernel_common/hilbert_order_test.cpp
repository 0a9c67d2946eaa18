#include "src/delaunay/kernel_common/hilbert_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/generators/random.h"

namespace spillway::test {
namespace {

using Points = std::vector<Point<2>>;

template <int D>
std::vector<VertexId> order_of(const std::vector<Point<D>>& points) {
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  return hilbert_order<D>(points, box);
}

/// The length of the tour in that order, over the side of its square.
double tour_length(const Points& points, double side) {
  const std::vector<VertexId> order = order_of<2>(points);
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

/// All points of a cubic lattice, far from the curve's order.
template <int D>
std::vector<Point<D>> lattice(std::size_t side) {
  std::vector<Point<D>> points(static_cast<std::size_t>(std::pow(side, D)));
  constexpr std::size_t kStride = 1'000'003;  // a prime
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t cell = i * kStride % points.size();
    for (int k = 0; k < D; ++k) {
      points[i][k] = static_cast<double>(cell % side);
      cell /= side;
    }
  }
  return points;
}

/// How many points do not follow a neighbour in the lattice.
template <int D>
std::size_t jumps(const std::vector<Point<D>>& points) {
  const std::vector<VertexId> order = order_of<D>(points);
  std::size_t count = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    double way = 0;
    for (int k = 0; k < D; ++k) way += std::abs(points[order[i]][k] - points[order[i - 1]][k]);
    if (way != 1) ++count;
  }
  return count;
}

void expect_permutation(std::vector<VertexId> order, std::size_t count) {
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), count);
  for (VertexId i = 0; i < count; ++i) ASSERT_EQ(order[i], i);
}

TEST(HilbertOrder, HasEveryPointOnce) {
  for (const std::size_t count : {0, 1, 2, 25, 600, 20'000, 70'000}) {
    expect_permutation(order_of<2>(random_points(count, 1)), count);
  }
}

TEST(HilbertOrder, LeadsFromNeighbourToNeighbour) {
  for (const std::size_t side : {2, 4, 8, 16, 32, 64, 128, 256, 512}) {
    EXPECT_EQ(jumps<2>(lattice<2>(side)), 0U) << side;
  }
  for (const std::size_t side : {2, 4, 8, 16, 32, 64, 128}) {
    EXPECT_EQ(jumps<3>(lattice<3>(side)), 0U) << side;
  }
}

TEST(HilbertOrder, MakesShortTours) {
  constexpr std::size_t kCount = 10'000;  // the shortest tour is about 0.71 sqrt(n)
  EXPECT_LT(tour_length(random_points(kCount, 1), 1), 1.0 * std::sqrt(kCount));
}

TEST(HilbertOrder, MakesShortToursInACrowdedCell) {
  constexpr std::size_t kCount = 10'000;
  constexpr double kSide = 1e-9;
  Points points = random_points(kCount, kSide);
  points.push_back({1, 1});
  const double way_to_the_corner = std::sqrt(2.0) / kSide;
  EXPECT_LT(tour_length(points, kSide) - way_to_the_corner, 1.1 * std::sqrt(kCount));
}

TEST(HilbertOrder, HasEveryPointOfCrowdedCellsOnce) {
  // Each square of the plane is one cell of the square around it, with as many points again.
  Points points;
  for (double side = 1; side > 1e-30; side /= 1024) {
    for (const Point<2>& p : random_points(100, side)) points.push_back(p);
    points.resize(points.size() + 60, {side / 2, side / 2});
  }
  expect_permutation(order_of<2>(points), points.size());
}

TEST(HilbertOrder, TakesBoxesThatAreTooLarge) {
  const Points points = random_points(1'000, 1);
  const Box<2> box{.lo = {-1e6, -1e6}, .hi = {1e6, 1e6}};
  EXPECT_EQ(hilbert_order<2>(points, box), order_of<2>(points));
}

TEST(HilbertOrder, EndsOnEqualPointsAndOnExtremeOnes) {
  Points points(100, {5, 5});
  points.push_back({6, 5});
  EXPECT_EQ(order_of<2>(points).size(), 101U);
  constexpr double kMax = std::numeric_limits<double>::max();
  points.assign(100, {-kMax, 0});
  points.resize(200, {kMax, 1});
  EXPECT_EQ(order_of<2>(points).size(), 200U);
  points.assign(100, {0, 0});
  points.resize(200, {0x1p-1074, 0});
  EXPECT_EQ(order_of<2>(points).size(), 200U);
}

}  // namespace
}  // namespace spillway::test
