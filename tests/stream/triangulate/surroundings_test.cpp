// What may change simplices of a part: never less than what does, and told by level where asked.

#include "stream/triangulate/surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

/// A tile of points in a tree of parts, its first leaf triangulated; another tile lies beside it.
template <int D>
struct Scene {
  std::vector<Point<D>> points;
  Part<D> root;
  std::vector<RunBoxes<D>> boxes;
  std::vector<std::vector<const Part<D>*>> levels;  ///< around the first leaf
  std::vector<Point<D>> other_points;
  TileNode<D> other;
  Outside<D> outside;
  std::vector<std::array<VertexId, D + 1>> simplices;

  explicit Scene(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(0, 1);
    points.resize(400);
    for (Point<D>& p : points) {
      for (double& x : p) x = coordinate(random);
    }
    std::vector<VertexId> index(points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    root = divide<D>(points, index, {.leaf_points = 60});
    boxes.resize(root.list + 1);
    set_boxes(root);
    const Part<D>* part = &root;
    while (!part->leaf()) {
      levels.insert(levels.begin(), {&part->children[1]});
      part = &part->children[0];
    }
    const std::vector<Point<D>> leaf(points.begin(), points.begin() + part->end);
    const Triangulation<D> mesh = delaunay_triangulation<D>(leaf, {.threads = 1});
    mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
      simplices.push_back(simplex.vertices);
      for (VertexId& v : simplices.back()) {
        if (v != kInfiniteVertex) v = mesh.input_index[v];
      }
    });
    other_points.resize(50);
    for (Point<D>& p : other_points) {
      for (double& x : p) x = coordinate(random);
      p[0] -= 1.05;
      other.box.expand(p);
    }
    other.points = other_points.size();
    outside = {&other};
  }

  [[nodiscard]] Surroundings<D> surroundings(bool asks_for_points) const {
    return {levels, outside, points, boxes, asks_for_points};
  }

  /// Whether one of these changes the simplex.
  [[nodiscard]] bool is_changed(std::size_t s, std::span<const Point<D>> by) const {
    const auto& vertices = simplices[s];
    return std::ranges::any_of(by, [&](const Point<D>& point) {
      std::array<Point<D>, D + 1> corners;
      bool infinite = false;
      for (int i = 0; i <= D; ++i) {
        infinite |= vertices[i] == kInfiniteVertex;
        corners[i] = vertices[i] == kInfiniteVertex ? point : points[vertices[i]];
      }
      return infinite ? orientation<D>(corners) > 0 : in_sphere<D>(corners, point) > 0;
    });
  }
  [[nodiscard]] bool is_changed(std::size_t s, const Part<D>& by) const {
    return is_changed(s, std::span(points).subspan(by.begin, by.size()));
  }

  /// Calls visit(s, changed, exposure) for each simplex.
  template <typename Visit>
  void ask(const Surroundings<D>& around, bool exposed, const Visit& visit) const {
    ChangeSearch<D> search(around, std::numeric_limits<std::size_t>::max());
    for_each_region_batch<D>(
        simplices.size(), [&](std::size_t s) { return simplices[s]; }, std::span(points),
        [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
          std::array<Exposure, ConflictRegionBatch<D>::kSize> exposure{};
          const std::uint64_t changed =
              search.may_change(regions, exposed ? exposure.data() : nullptr);
          for (std::size_t s = 0; s < 64 && (regions.all() >> s & 1) != 0; ++s) {
            visit(first + s, (changed >> s & 1) != 0, exposure[s]);
          }
        });
  }

 private:
  void set_boxes(const Part<D>& part) {
    for (const Part<D>& child : part.children) set_boxes(child);
    if (part.leaf()) {
      boxes[part.list] = RunBoxes<D>(std::span(points).subspan(part.begin, part.size()));
    }
  }
};

template <typename Dimension>
class ChangeSearchTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ChangeSearchTest, Dimensions);

TYPED_TEST(ChangeSearchTest, FindsAllThatPointsOfEachLevelOrOfOtherTilesChange) {
  constexpr int kD = TypeParam::value;
  const Scene<kD> scene(1);
  ASSERT_GE(scene.levels.size(), 3U);
  for (const bool asks_for_points : {false, true}) {
    std::size_t spared = 0;
    scene.ask(scene.surroundings(asks_for_points), true,
              [&](std::size_t s, bool changed, Exposure exposure) {
                for (std::size_t level = 0; level < scene.levels.size(); ++level) {
                  if (scene.is_changed(s, *scene.levels[level][0])) {
                    EXPECT_NE(exposure >> level & 1, 0) << "level " << level;
                  }
                }
                EXPECT_EQ(exposure >> scene.levels.size(), 0);
                if (exposure != 0 || scene.is_changed(s, scene.other_points)) {
                  EXPECT_TRUE(changed);
                }
                spared += changed ? 0 : 1;
              });
    EXPECT_GT(spared, 0U) << "not all are in the border";
  }
}

TYPED_TEST(ChangeSearchTest, TellsTheSameWhetherTheExposureIsAskedForOrNot) {
  constexpr int kD = TypeParam::value;
  const Scene<kD> scene(2);
  const Surroundings<kD> around = scene.surroundings(true);
  std::vector<bool> with(scene.simplices.size()), without(scene.simplices.size());
  scene.ask(around, true, [&](std::size_t s, bool changed, Exposure) { with[s] = changed; });
  scene.ask(around, false, [&](std::size_t s, bool changed, Exposure exposure) {
    without[s] = changed;
    EXPECT_EQ(exposure, 0);
  });
  EXPECT_EQ(with, without);
}

TYPED_TEST(ChangeSearchTest, OtherTilesChangeWithoutExposure) {
  constexpr int kD = TypeParam::value;
  Scene<kD> scene(3);
  scene.levels.clear();
  std::size_t changed_ones = 0;
  scene.ask(scene.surroundings(true), true, [&](std::size_t s, bool changed, Exposure exposure) {
    EXPECT_EQ(exposure, 0);
    if (scene.is_changed(s, scene.other_points)) {
      EXPECT_TRUE(changed);
    }
    changed_ones += changed ? 1 : 0;
  });
  EXPECT_GT(changed_ones, 0U);
  EXPECT_LT(changed_ones, scene.simplices.size());
}

TYPED_TEST(ChangeSearchTest, ExposureIsToldOfAsManyLevelsAsItHasBits) {
  constexpr int kD = TypeParam::value;
  Scene<kD> scene(4);
  scene.levels.resize(kExposureLevels);
  EXPECT_TRUE(scene.surroundings(true).tells_exposure());
  scene.levels.resize(kExposureLevels + 1);
  EXPECT_FALSE(scene.surroundings(true).tells_exposure());
  scene.levels.clear();
  EXPECT_FALSE(scene.surroundings(true).tells_exposure()) << "of a tile in one piece";
}

}  // namespace
}  // namespace spillway::test
