#include "stream/triangulate/border.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::test {
namespace {

/// A simplex by its finite corners, sorted: infinite ones have one less.
template <int D>
using Named = std::vector<Point<D>>;

template <int D, typename Corners, typename PointOf>
Named<D> named(const Corners& corners, const PointOf& point_of) {
  Named<D> name;
  for (const VertexId v : corners) {
    if (v != kInfiniteVertex) name.push_back(point_of(v));
  }
  std::sort(name.begin(), name.end());
  return name;
}

template <int D>
std::multiset<Named<D>> simplices_of(const std::vector<Point<D>>& points) {
  std::multiset<Named<D>> all;
  const Triangulation<D> mesh = delaunay_triangulation<D>(points, {});
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    all.insert(named<D>(simplex.vertices, [&](VertexId v) { return mesh.points[v]; }));
  });
  return all;
}

template <int D>
std::multiset<Named<D>> simplices_of(const Border<D>& border) {
  std::multiset<Named<D>> all;
  for (const auto& corners : border.simplices) {
    all.insert(named<D>(corners, [&](VertexId v) { return border.vertices[v].position; }));
  }
  return all;
}

/// All simplices of points that are triangulated for themselves.
template <int D>
Border<D> border_of(const std::vector<Point<D>>& points) {
  const Triangulation<D> mesh = delaunay_triangulation<D>(points, {});
  Border<D> border;
  border.dimension = mesh.dimension;
  for (const Point<D>& point : mesh.points) {
    border.vertices.push_back({});
    border.vertices.back().position = point;
  }
  mesh.for_each_simplex(
      [&](SimplexId, const Simplex<D>& simplex) { border.simplices.push_back(simplex.vertices); });
  return border;
}

template <int D>
TileNode<D> tree_of(const std::vector<Point<D>>& points) {
  TileNode<D> tree;
  for (const Point<D>& point : points) tree.box.expand(point);
  tree.points = points.size();
  return tree;
}

/// Points with x from `begin` to `begin` + 1.
template <int D>
std::vector<Point<D>> random_points(std::size_t count, double begin, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<D>> points(count);
  for (Point<D>& point : points) {
    for (double& x : point) x = coordinate(random);
    point[0] += begin;
  }
  return points;
}

template <typename Dimension>
class BorderMerge : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BorderMerge, Dimensions);

template <int D>
MergedBorder<D> merged(const std::vector<std::vector<Point<D>>>& parts, MemoryBudget& budget,
                       Task& task) {
  std::vector<Border<D>> children;
  std::vector<TileNode<D>> trees;
  for (const auto& points : parts) {
    children.push_back(border_of<D>(points));
    trees.push_back(tree_of<D>(points));
  }
  std::vector<const TileNode<D>*> of_children;
  for (const TileNode<D>& tree : trees) of_children.push_back(&tree);
  return merge_borders<D, TileNode<D>>(children, of_children, budget, task);
}

template <int D>
void expect_triangulation_of_all(const std::vector<std::vector<Point<D>>>& parts) {
  std::vector<Point<D>> all;
  for (const auto& points : parts) all.insert(all.end(), points.begin(), points.end());
  MemoryBudget budget(std::uint64_t{1} << 30);
  Task task;
  MergedBorder<D> result = merged<D>(parts, budget, task);
  EXPECT_EQ(result.border.dimension, D);
  EXPECT_EQ(simplices_of(result.border), simplices_of<D>(all));
  EXPECT_GT(budget.used(), 0U) << "until it is settled";
  result.memory = {};
  EXPECT_EQ(budget.used(), 0U);
}

TYPED_TEST(BorderMerge, OfAllSimplicesIsTheTriangulationOfAllPoints) {
  constexpr int kD = TypeParam::value;
  expect_triangulation_of_all<kD>(
      {random_points<kD>(300, 0, 1), random_points<kD>(200, 1, 2), random_points<kD>(400, 2, 3)});
}

TYPED_TEST(BorderMerge, TakesAllPointsOfAPartWithoutSimplices) {
  constexpr int kD = TypeParam::value;
  std::vector<Point<kD>> line(kD + 1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    line[i] = {};
    line[i][1] = 0.3 * static_cast<double>(i);
    line[i][0] = 1.5;
  }
  ASSERT_TRUE(border_of<kD>(line).open());
  expect_triangulation_of_all<kD>({random_points<kD>(200, 0, 4), line});
}

TYPED_TEST(BorderMerge, RetriangulatesOnlyWhatASiblingMayChange) {
  constexpr int kD = TypeParam::value;
  const std::vector<std::vector<Point<kD>>> parts = {random_points<kD>(2000, 0, 5),
                                                     random_points<kD>(2000, 1, 6)};
  MemoryBudget budget(std::uint64_t{1} << 30);
  Task task;
  const MergedBorder<kD> result = merged<kD>(parts, budget, task);
  EXPECT_GT(result.tested, 0U);
  EXPECT_LT(result.retriangulated, 3000U);
  ASSERT_EQ(task.after.size(), 3U);
  EXPECT_EQ(task.after[0].kind, TaskKind::kBorder);
  EXPECT_EQ(task.after[0].points, result.retriangulated);
  EXPECT_EQ(task.after[2].kind, TaskKind::kAccept);
}

TYPED_TEST(BorderMerge, TakesAnExposureThatIsKnown) {
  constexpr int kD = TypeParam::value;
  const std::vector<std::vector<Point<kD>>> parts = {random_points<kD>(200, 0, 9),
                                                     random_points<kD>(200, 1, 10)};
  std::vector<Border<kD>> children = {border_of<kD>(parts[0]), border_of<kD>(parts[1])};
  const TileNode<kD> low = tree_of<kD>(parts[0]);
  const TileNode<kD> high = tree_of<kD>(parts[1]);
  const std::array trees = {&low, &high};
  MemoryBudget budget(std::uint64_t{1} << 30);
  Task task;
  const auto merge = [&](std::vector<Border<kD>> borders) {
    return merge_borders<kD, TileNode<kD>>(borders, trees, budget, task);
  };
  // All but the last simplex of the first part: so that one stays, and moves on by a level.
  for (Border<kD>& child : children) child.exposure.assign(child.simplices.size(), 1);
  children[0].exposure.back() = 6;
  const MergedBorder<kD> known = merge(children);
  EXPECT_TRUE(known.exposure_is_known);
  EXPECT_EQ(known.tested, 1U);
  EXPECT_EQ(known.border.exposure, std::vector<Exposure>{3});
  EXPECT_EQ(known.border.simplices[0], children[0].simplices.back());
  children[1].exposure = {};
  const MergedBorder<kD> known_in_part = merge(children);
  EXPECT_FALSE(known_in_part.exposure_is_known);
  EXPECT_GT(known_in_part.tested, 1U);
  EXPECT_TRUE(known_in_part.border.exposure.empty());
}

TYPED_TEST(BorderMerge, NeedsMemory) {
  constexpr int kD = TypeParam::value;
  MemoryBudget budget(10'000);
  Task task;
  EXPECT_THROW(
      merged<kD>({random_points<kD>(300, 0, 7), random_points<kD>(300, 1, 8)}, budget, task),
      Failure);
  EXPECT_EQ(budget.used(), 0U);
}

}  // namespace
}  // namespace spillway::test
