#include "src/delaunay/border/point_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "src/delaunay/common/schedule.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

/// Points in a tree of parts with their boxes.
template <int D>
struct DividedPoints {
  std::vector<Point<D>> points;
  Part<D> root;
  std::vector<RunBoxes<D>> boxes;
  std::vector<const Part<D>*> parts;

  explicit DividedPoints(std::vector<Point<D>> some) : points(std::move(some)) {
    std::vector<VertexId> index(points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    root = divide<D>(points, index, {.leaf_points = 200});
    boxes.resize(root.list + 1);
    set_boxes(root);
    parts = {&root};
  }
  void set_boxes(const Part<D>& part) {
    for (const Part<D>& child : part.children) set_boxes(child);
    if (part.leaf())
      boxes[part.list] = RunBoxes<D>(std::span(points).subspan(part.begin, part.size()));
  }
  [[nodiscard]] Siblings<D> siblings() const { return {parts, points, boxes}; }
};

template <typename Dimension>
class PointSearchTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PointSearchTest, Dimensions);

template <int D>
std::vector<Point<D>> random_points(std::size_t count, std::uint64_t side, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Point<D>> points(count);
  for (auto& p : points) {
    for (double& x : p) x = static_cast<double>(random() % side);
  }
  return points;
}

TYPED_TEST(PointSearchTest, FindsAPointOfEverySphereAndHalfSpaceThatHasOne) {
  constexpr int D = TypeParam::value;
  const DividedPoints<D> divided(random_points<D>(3000, 300, 11));
  const Siblings<D> siblings = divided.siblings();
  PointSearch<D> search(siblings);
  const std::vector<Point<D>> corners = random_points<D>(2000, 300, 12);
  std::size_t held = 0;
  std::size_t empty = 0;
  for (std::size_t s = 0; s + D < corners.size(); s += D + 1) {
    std::array<Point<D>, D + 1> simplex;
    std::array<VertexId, D + 1> vertices;
    for (int i = 0; i <= D; ++i) vertices[i] = static_cast<VertexId>(s + i);
    // Small ones, so that some are empty.
    std::vector<Point<D>> positions = corners;
    for (int i = 1; i <= D; ++i) {
      for (int k = 0; k < D; ++k) {
        positions[s + i][k] = positions[s][k] + std::fmod(positions[s + i][k], 9) - 4;
      }
    }
    for (int i = 0; i <= D; ++i) simplex[i] = positions[s + i];
    if (orientation<D>(simplex) < 0) {
      std::swap(simplex[0], simplex[1]);
      std::swap(vertices[0], vertices[1]);
    }
    if (orientation<D>(simplex) == 0) continue;
    const bool any = std::any_of(divided.points.begin(), divided.points.end(),
                                 [&](const auto& p) { return side_of_sphere<D>(simplex, p) >= 0; });
    const bool found = search.may_hold_a_point(ConflictRegion<D>(vertices, positions));
    EXPECT_TRUE(found || !any);
    EXPECT_EQ(found, PointSearch<D>(siblings).may_hold_a_point({vertices, positions}));
    (found ? held : empty) += 1;
    vertices[D] = kInfiniteVertex;
    const bool beyond =
        std::any_of(divided.points.begin(), divided.points.end(), [&](const Point<D>& p) {
          simplex[D] = p;
          return orientation<D>(simplex) >= 0;
        });
    EXPECT_TRUE(search.may_hold_a_point({vertices, positions}) || !beyond);
  }
  EXPECT_GT(held, 20U);
  EXPECT_GT(empty, 20U);
}

/// Five thousand points on a circle.
std::vector<Point<2>> on_a_circle(double radius) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 5000; ++i) {
    const double t = 6.2831853 * i / 5000;
    points.push_back({radius * std::cos(t), radius * std::sin(t)});
  }
  return points;
}

TEST(PointSearch, SeesThatAGapBetweenPointsIsEmpty) {
  const DividedPoints<2> divided(on_a_circle(2));
  const Siblings<2> siblings = divided.siblings();
  PointSearch<2> search(siblings);
  const std::vector<Point<2>> inside{{-1.9, 0}, {1.9, 0}, {0, 1.9}};
  const ConflictRegion<2> region({0, 1, 2}, inside);
  EXPECT_TRUE(region.may_meet_leaf(divided.root));
  EXPECT_FALSE(search.may_hold_a_point(region));
}

TEST(PointSearch, EndsSoonIfItIsTold) {
  const DividedPoints<2> divided(on_a_circle(1));
  Siblings<2> siblings = divided.siblings();
  const std::vector<Point<2>> corners{{1 - 1e-9, 0}, {0, 1 - 1e-9}, {-1 + 1e-9, 0}};
  const ConflictRegion<2> region({0, 1, 2}, corners);
  EXPECT_FALSE(PointSearch<2>(siblings).may_hold_a_point(region));
  siblings.most_boxes = 50;
  PointSearch<2> search(siblings);
  EXPECT_TRUE(search.may_hold_a_point(region));
  EXPECT_GE(search.steps(), 50U);
  siblings.most_boxes = 0;
  EXPECT_TRUE(PointSearch<2>(siblings).may_hold_a_point(region));
}

TEST(PointSearch, AsksNoMoreWhenItsStepsHaveNotBeenWorthIt) {
  const DividedPoints<2> divided(on_a_circle(2));
  const Siblings<2> siblings = divided.siblings();
  const std::vector<Point<2>> corners{{-1.9, 0}, {1.9, 0}, {0, 1.9}, {-2.1, 0}, {2.1, 0}, {0, 2.1}};
  const ConflictRegion<2> misses({0, 1, 2}, corners);
  const ConflictRegion<2> holds({3, 4, 5}, corners);
  PointSearch<2> in_vain(siblings, 1);
  EXPECT_TRUE(in_vain.may_hold_a_point(holds));
  EXPECT_TRUE(in_vain.may_hold_a_point(misses)) << "it meets the box of a leaf";
  PointSearch<2> of_use(siblings, 1);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(of_use.may_hold_a_point(misses)) << "no is worth more";
}

}  // namespace
}  // namespace spillway::test
