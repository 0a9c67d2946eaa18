#include "src/delaunay/border/conflict_region.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

constexpr VertexId kInf = kInfiniteVertex;

template <int D>
Point<D> random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  Point<D> p;
  for (double& x : p) x = coordinate(random);
  return p;
}

/// Positively oriented, or with the infinite vertex in some place.
template <int D>
struct RandomSimplex {
  std::vector<Point<D>> points;
  std::array<VertexId, D + 1> vertices;
  int infinite = -1;

  RandomSimplex(std::mt19937_64& random, bool is_infinite) {
    std::array<Point<D>, D + 1> corners;
    do {
      points.clear();
      for (int i = 0; i <= D; ++i) {
        points.push_back(random_point<D>(random, 1));
        corners[i] = points.back();
        vertices[i] = static_cast<VertexId>(i);
      }
    } while (orientation<D>(corners) <= 0);
    if (!is_infinite) return;
    infinite = static_cast<int>(random() % (D + 1));
    vertices[infinite] = kInf;
  }

  /// Whether a point destroys it: 1, or 0 on the very border.
  [[nodiscard]] int sign(const Point<D>& point) const {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = points[i];
    if (infinite < 0) return in_sphere<D>(corners, point);
    corners[infinite] = point;
    return orientation<D>(corners);
  }
};

template <typename Dimension>
class ConflictRegionTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ConflictRegionTest, Dimensions);

TYPED_TEST(ConflictRegionTest, HoldsThePointsThatDestroyASimplexAndHardlyOthers) {
  constexpr int kD = TypeParam::value;
  std::mt19937_64 random(1);
  std::size_t outside = 0;
  std::size_t kept = 0;
  for (int round = 0; round < 200; ++round) {
    const RandomSimplex<kD> simplex(random, round % 2 == 0);
    const ConflictRegion<kD> region(simplex.vertices, simplex.points);
    EXPECT_EQ(region.infinite(), round % 2 == 0);
    for (int p = 0; p < 50; ++p) {
      const Point<kD> point = random_point<kD>(random, 2);
      if (simplex.sign(point) > 0) {
        ASSERT_TRUE(region.may_hold(point));
        ASSERT_TRUE(region.may_meet(Box<kD>{point, point}));
        Box<kD> around{point, point};
        around.expand(random_point<kD>(random, 2));
        ASSERT_TRUE(region.may_meet(around));
      } else {
        ++outside;
        kept += region.may_hold(point) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(outside, 3000U);
  EXPECT_LT(kept, outside / 100);
}

TYPED_TEST(ConflictRegionTest, IsClosed) {
  constexpr int kD = TypeParam::value;
  std::mt19937_64 random(2);
  for (int round = 0; round < 100; ++round) {
    const RandomSimplex<kD> simplex(random, round % 2 == 0);
    const ConflictRegion<kD> region(simplex.vertices, simplex.points);
    for (int i = 0; i <= kD; ++i) {
      if (i != simplex.infinite) {
        EXPECT_TRUE(region.may_hold(simplex.points[i]));
      }
    }
  }
}

TYPED_TEST(ConflictRegionTest, OfATreeMeetsALeafAndNotOnlyTheBoxesAbove) {
  constexpr int kD = TypeParam::value;
  struct Tree {
    Box<kD> box;
    std::vector<Tree> children{};
  };
  std::vector<Point<kD>> points(kD + 1);
  std::array<VertexId, kD + 1> vertices{};
  for (int i = 0; i <= kD; ++i) {
    vertices[i] = static_cast<VertexId>(i);
    if (i > 0) points[i][i - 1] = 1;
  }
  const ConflictRegion<kD> region(vertices, points);
  const auto small_box = [](double x) {
    Point<kD> p{};
    p[0] = x;
    return Box<kD>{p, p};
  };
  Tree tree;
  tree.children = {{small_box(-9)}, {small_box(9)}};
  for (const Tree& child : tree.children) tree.box.expand(child.box);
  EXPECT_TRUE(region.may_meet(tree.box));
  EXPECT_FALSE(region.may_meet_leaf(tree));
  tree.children.push_back({small_box(0.5)});
  EXPECT_TRUE(region.may_meet_leaf(tree));
}

TYPED_TEST(ConflictRegionTest, IsTightUnlessTheSimplexIsFlat) {
  constexpr int kD = TypeParam::value;
  std::vector<Point<kD>> points(kD + 1);
  std::array<VertexId, kD + 1> vertices{};
  for (int i = 0; i <= kD; ++i) {
    vertices[i] = static_cast<VertexId>(i);
    if (i > 0) points[i][i - 1] = 1;
  }
  EXPECT_TRUE(ConflictRegion<kD>(vertices, points).tight());
  points[kD].fill(0.3);
  points[kD][kD - 1] = 0;
  EXPECT_FALSE(ConflictRegion<kD>(vertices, points).tight());
  vertices[0] = kInf;
  EXPECT_TRUE(ConflictRegion<kD>(vertices, points).tight()) << "half-spaces always are";
}

}  // namespace
}  // namespace spillway::test
