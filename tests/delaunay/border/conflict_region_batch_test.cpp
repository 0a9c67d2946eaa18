// Regions of many simplices at a time: as each says by itself.

#include "src/delaunay/border/conflict_region_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

/// Simplices in any order, finite and infinite ones, many of them too flat for a batch to certify.
template <int D>
struct Simplices {
  std::vector<Point<D>> points;
  std::vector<std::array<VertexId, D + 1>> corners;

  explicit Simplices(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(0, 1);
    std::vector<Point<D>> input(60);
    for (Point<D>& p : input) {
      for (double& x : p) x = coordinate(random);
    }
    for (int i = 0; i < 60; ++i) {  // of a plane (a line), but for rounding
      Point<D> p;
      for (double& x : p) x = coordinate(random);
      p[0] = 1.3;
      const double turned = std::cos(0.3) * p[0] - std::sin(0.3) * p[1];
      p[1] = std::sin(0.3) * p[0] + std::cos(0.3) * p[1];
      p[0] = turned;
      input.push_back(p);
    }
    const Triangulation<D> mesh = delaunay_triangulation<D>(input, {.threads = 1});
    points.assign(mesh.points.begin(), mesh.points.end());
    mesh.for_each_simplex(
        [&](SimplexId, const Simplex<D>& simplex) { corners.push_back(simplex.vertices); });
    std::ranges::shuffle(corners, random);
  }

  [[nodiscard]] ConflictRegion<D> region(std::size_t s) const { return {corners[s], points}; }

  /// A batch of those from `first` on.
  void set(ConflictRegionBatch<D>& regions, std::size_t first, std::size_t count) const {
    regions.set(
        count, [&](std::size_t s) { return corners[first + s]; }, points);
  }
};

/// Around a random place, as large as is said.
template <int D>
Box<D> random_box(std::mt19937_64& random, double extent) {
  std::uniform_real_distribution<double> coordinate(-0.5, 2);
  Box<D> box;
  Point<D> p;
  for (double& x : p) x = coordinate(random);
  box.expand(p);
  for (double& x : p) x += extent;
  box.expand(p);
  return box;
}

template <int D>
struct BoxTree {
  Box<D> box;
  std::vector<BoxTree> children{};
};

/// A leaf that knows more than its box.
template <int D>
struct SketchedLeaf {
  Box<D> box;
  std::vector<SketchedLeaf> children{};
  std::optional<PointSketch<D>> sketch{};
};

/// Whether a simplex is changed by a point that lies just there.
template <int D>
bool is_changed(const std::array<VertexId, D + 1>& vertices, std::span<const Point<D>> points,
                const Point<D>& point) {
  std::array<Point<D>, D + 1> corners;
  bool infinite = false;
  for (int i = 0; i <= D; ++i) {
    infinite |= vertices[i] == kInfiniteVertex;
    corners[i] = vertices[i] == kInfiniteVertex ? point : points[vertices[i]];
  }
  return infinite ? orientation<D>(corners) > 0 : in_sphere<D>(corners, point) > 0;
}

std::uint64_t low_bits(std::size_t count) {
  return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

template <typename Dimension>
class RegionBatchTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RegionBatchTest, Dimensions);

TYPED_TEST(RegionBatchTest, AnswersAsEachRegionDoes) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(1);
  std::mt19937_64 random(2);
  ConflictRegionBatch<kD> regions;
  std::size_t vague = 0;
  for (const std::size_t count : {64, 63, 17, 1}) {
    for (std::size_t first = 0; first + count <= simplices.corners.size(); first += 2 * count + 5) {
      simplices.set(regions, first, count);
      EXPECT_EQ(regions.all(), low_bits(count));
      for (std::size_t s = 0; s < count; ++s) {
        const bool infinite = (regions.infinite() >> s & 1) != 0;
        EXPECT_EQ(infinite, simplices.region(first + s).infinite());
        vague += regions.region(s).tight() ? 0 : 1;
      }
      for (const double extent : {0.0, 0.01, 0.3, 2.0}) {
        const Box<kD> box = random_box<kD>(random, extent);
        const std::uint64_t asked = random() & regions.all();
        const std::uint64_t met = regions.may_meet(box, asked);
        for (std::size_t s = 0; s < 64; ++s) {
          const bool expected = (asked >> s & 1) != 0 && regions.region(s).may_meet(box);
          ASSERT_EQ((met >> s & 1) != 0, expected) << s << " of " << count;
        }
      }
    }
  }
  EXPECT_GT(vague, 10U) << "of which little is known";
}

TYPED_TEST(RegionBatchTest, AnswersWhatIsKnownOfEachAloneButForFlatOnes) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(3);
  std::mt19937_64 random(4);
  ConflictRegionBatch<kD> regions;
  simplices.set(regions, 0, 64);
  std::size_t compared = 0;
  for (int b = 0; b < 100; ++b) {
    const Box<kD> box = random_box<kD>(random, 0.1);
    const std::uint64_t met = regions.may_meet(box, regions.all());
    for (std::size_t s = 0; s < 64; ++s) {
      if (!regions.region(s).tight()) continue;
      ++compared;
      EXPECT_EQ((met >> s & 1) != 0, simplices.region(s).may_meet(box));
    }
  }
  EXPECT_GT(compared, 1000U);
}

TYPED_TEST(RegionBatchTest, NeverMissesAPointThatChangesASimplex) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(5);
  std::mt19937_64 random(6);
  ConflictRegionBatch<kD> regions;
  std::size_t changed = 0;
  for (std::size_t first = 0; first + 64 <= simplices.corners.size(); first += 64) {
    simplices.set(regions, first, 64);
    for (int b = 0; b < 50; ++b) {
      const Box<kD> place = random_box<kD>(random, 0);
      const std::uint64_t met = regions.may_meet(place, regions.all());
      for (std::size_t s = 0; s < 64; ++s) {
        if (!is_changed<kD>(simplices.corners[first + s], simplices.points, place.lo)) continue;
        ++changed;
        EXPECT_NE(met >> s & 1, 0U);
      }
    }
  }
  EXPECT_GT(changed, 100U);
}

TYPED_TEST(RegionBatchTest, ForgetsTheBatchBefore) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(7);
  std::vector<std::array<VertexId, kD + 1>> finite, infinite;
  for (std::size_t s = 0; s < simplices.corners.size(); ++s) {
    (simplices.region(s).infinite() ? infinite : finite).push_back(simplices.corners[s]);
  }
  ConflictRegionBatch<kD> regions;
  regions.set(
      3, [&](std::size_t s) { return infinite[s]; }, simplices.points);
  EXPECT_EQ(regions.infinite(), 0b111U);
  regions.set(
      2, [&](std::size_t s) { return finite[s]; }, simplices.points);
  EXPECT_EQ(regions.infinite(), 0U);
  EXPECT_EQ(regions.all(), 0b11U);
  EXPECT_FALSE(regions.region(0).infinite());
  regions.set(
      0, [&](std::size_t s) { return finite[s]; }, simplices.points);
  EXPECT_EQ(regions.all(), 0U);
}

TYPED_TEST(RegionBatchTest, OfATreeOnlyLeavesCount) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(8);
  std::mt19937_64 random(9);
  ConflictRegionBatch<kD> regions;
  simplices.set(regions, 0, 64);
  for (int round = 0; round < 20; ++round) {
    BoxTree<kD> tree;
    std::vector<Box<kD>> leaves;
    for (int c = 0; c < 3; ++c) {
      BoxTree<kD>& child = tree.children.emplace_back();
      for (int l = 0; l < 2; ++l) {
        leaves.push_back(random_box<kD>(random, 0.02));
        child.children.push_back({leaves.back()});
        child.box.expand(leaves.back());
      }
      tree.box.expand(child.box);
    }
    const std::uint64_t asked = random();
    std::uint64_t expected = 0;
    for (const Box<kD>& leaf : leaves) expected |= regions.may_meet(leaf, asked);
    EXPECT_EQ(regions.may_meet_leaf(tree, asked), expected);
    EXPECT_EQ(regions.may_meet_leaf(BoxTree<kD>{leaves[0]}, asked),
              regions.may_meet(leaves[0], asked));
  }
}

/// More boxes than a level of the sketch holds together.
TYPED_TEST(RegionBatchTest, OfASketchItsBoxesAndPlatesCount) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(10);
  std::mt19937_64 random(11);
  ConflictRegionBatch<kD> regions;
  simplices.set(regions, 0, 64);
  std::size_t fewer = 0;
  for (const std::size_t count : {1, 4, 5, 21}) {
    SketchedLeaf<kD> leaf;
    std::vector<Box<kD>> boxes;
    std::vector<Plate<kD>> plates;
    for (std::size_t b = 0; b < count; ++b) {
      boxes.push_back(random_box<kD>(random, 0.2));
      leaf.box.expand(boxes.back());
      Plate<kD> plate{.centre = boxes.back().lo};
      plate.normal[0] = 1;
      plate.expand(boxes.back().hi);
      plate.thickness = 0;
      plates.push_back(plate);
    }
    leaf.sketch = PointSketch<kD>{RunBoxes<kD>(boxes), plates};
    const std::uint64_t asked = random();
    std::uint64_t expected = 0;
    for (std::size_t b = 0; b < count; ++b) {
      for (std::size_t s = 0; s < 64; ++s) {
        const ConflictRegion<kD> region = regions.region(s);
        if (region.may_meet(boxes[b]) && region.may_meet(plates[b])) {
          expected |= asked & std::uint64_t{1} << s;
        }
      }
    }
    EXPECT_EQ(regions.may_meet_leaf(leaf, asked), expected) << count;
    EXPECT_EQ(regions.may_meet_sketch(*leaf.sketch, asked), expected) << count;
    fewer += expected != regions.may_meet(leaf.box, asked) ? 1 : 0;
  }
  EXPECT_GT(fewer, 0U);
  EXPECT_EQ(regions.may_meet_sketch({}, regions.all()), 0U) << "without points";
}

TYPED_TEST(RegionBatchTest, BatchesHoldAllInOrderAndTheLastOneWhatIsLeft) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(12);
  for (const std::size_t count : {0, 1, 63, 64, 65, 128, 150}) {
    std::vector<std::size_t> firsts;
    std::vector<std::uint64_t> bits;
    for_each_region_batch<kD>(
        count, [&](std::size_t s) { return simplices.corners[s]; }, simplices.points,
        [&](std::size_t first, const ConflictRegionBatch<kD>& regions) {
          firsts.push_back(first);
          bits.push_back(regions.all());
        });
    ASSERT_EQ(firsts.size(), (count + 63) / 64);
    for (std::size_t b = 0; b < firsts.size(); ++b) {
      EXPECT_EQ(firsts[b], 64 * b);
      EXPECT_EQ(bits[b], low_bits(std::min<std::size_t>(64, count - 64 * b)));
    }
  }
}

TYPED_TEST(RegionBatchTest, EachRegionComesOnceWithItsOwnSimplex) {
  constexpr int kD = TypeParam::value;
  const Simplices<kD> simplices(13);
  const std::size_t count = 150;
  std::vector<std::size_t> visited;
  for_each_region<kD>(
      count, [&](std::size_t s) { return simplices.corners[s]; }, simplices.points,
      [&](std::size_t s, const ConflictRegion<kD>& region) {
        visited.push_back(s);
        EXPECT_EQ(region.infinite(), simplices.region(s).infinite());
        for (const VertexId v : simplices.corners[s]) {
          if (v != kInfiniteVertex) {
            EXPECT_TRUE(region.may_hold(simplices.points[v])) << "its own corner";
          }
        }
      });
  std::vector<std::size_t> all(count);
  for (std::size_t s = 0; s < count; ++s) all[s] = s;
  EXPECT_EQ(visited, all);
}

}  // namespace
}  // namespace spillway::test
