// Which simplices something elsewhere may change, of many at a time and by many threads: as their
// regions say one by one.

#include "src/delaunay/border/exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "src/delaunay/border/conflict_region.h"
#include "src/delaunay/delaunay.h"
#include "src/geometry/box.h"

namespace spillway::test {
namespace {

template <int D>
struct Boxes {
  Box<D> box;
  std::vector<Boxes> children{};
};

template <int D>
std::vector<Point<D>> random_points(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<D>> points(count);
  for (Point<D>& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

/// Two small boxes, beside the points or among them.
template <int D>
Boxes<D> pair_of_boxes(double x) {
  Boxes<D> tree;
  for (const double y : {0.1, 0.8}) {
    Boxes<D>& leaf = tree.children.emplace_back();
    Point<D> corner;
    corner.fill(y);
    corner[0] = x;
    leaf.box.expand(corner);
    for (double& c : corner) c += 0.05;
    leaf.box.expand(corner);
    tree.box.expand(leaf.box);
  }
  return tree;
}

template <typename Dimension>
class ExposureOfSimplices : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ExposureOfSimplices, Dimensions);

TYPED_TEST(ExposureOfSimplices, IsWhatTheirRegionsSayOneByOne) {
  constexpr int kD = TypeParam::value;
  const Triangulation<kD> mesh =
      delaunay_triangulation<kD>(random_points<kD>(2000, 1), {.threads = 1});
  const std::vector<Point<kD>> points(mesh.points.begin(), mesh.points.end());
  std::vector<std::array<VertexId, kD + 1>> simplices;
  mesh.for_each_simplex(
      [&](SimplexId, const Simplex<kD>& simplex) { simplices.push_back(simplex.vertices); });
  const std::array<Boxes<kD>, 3> boxes{pair_of_boxes<kD>(-0.1), pair_of_boxes<kD>(0.5),
                                       pair_of_boxes<kD>(1.02)};
  const std::array<const Boxes<kD>*, 3> trees{&boxes[0], &boxes[1], &boxes[2]};
  std::vector<std::uint32_t> expected(simplices.size());
  for (std::size_t s = 0; s < simplices.size(); ++s) {
    const ConflictRegion<kD> region(simplices[s], std::span<const Point<kD>>(points));
    for (std::size_t t = 0; t < trees.size(); ++t) {
      for (const Boxes<kD>& leaf : trees[t]->children) {
        if (region.may_meet(leaf.box)) expected[s] |= 1U << t;
      }
    }
  }
  with_threads(2, [&] {
    EXPECT_EQ((exposure_by_tree<kD, Boxes<kD>>(simplices, points, trees, 0)), expected);
    std::vector<std::uint8_t> marks(simplices.size());
    find_exposed<kD, Boxes<kD>>(simplices, points, trees, [&marks](std::size_t s) { ++marks[s]; });
    for (std::size_t s = 0; s < marks.size(); ++s) {
      ASSERT_EQ(marks[s], expected[s] != 0 ? 1 : 0) << "each at most once";
    }
    for (std::uint32_t& bits : expected) bits &= ~3U;
    EXPECT_EQ((exposure_by_tree<kD, Boxes<kD>>(simplices, points, trees, 2)), expected)
        << "trees before are not asked";
    EXPECT_THAT((exposure_by_tree<kD, Boxes<kD>>(simplices, points, trees, 3)),
                ::testing::Each(0U));
  });
}

}  // namespace
}  // namespace spillway::test
