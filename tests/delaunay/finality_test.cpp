#include "src/delaunay/finality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "src/delaunay/delaunay.h"
#include "src/delaunay/schedule.h"
#include "src/geometry/predicates.h"

namespace spillway {
namespace {

/// Two halves of a random set: the left triangulated, the right a tree of boxes.
template <int D>
struct Halves {
  Triangulation<D> left;
  std::vector<Point<D>> right_points;
  Part<D> right;

  explicit Halves(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Point<D>> left_points(600);
    right_points.resize(600);
    const auto fill = [&](std::vector<Point<D>>& points, double shift) {
      for (auto& p : points) {
        for (double& x : p) x = static_cast<double>(random() % 200);
        p[0] += shift;
      }
    };
    fill(left_points, 0);
    fill(right_points, 201);
    left = delaunay<D>(left_points, {.threads = 1});
    std::vector<VertexId> index(right_points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    right = divide<D>(right_points, index, {.leaf_size = 40});
  }

  /// Whether a point of the right half destroys the simplex of the left one.
  [[nodiscard]] bool destroyed(const Simplex<D>& simplex) const {
    std::array<Point<D>, D + 1> corners;
    const int infinite = simplex.infinite_place();
    for (int i = 0; i <= D; ++i) {
      if (i != infinite) corners[i] = left.points[simplex.vertices[i]];
    }
    return std::any_of(right_points.begin(), right_points.end(), [&](const Point<D>& p) {
      if (infinite < 0) return in_sphere<D>(corners, p) > 0;
      corners[infinite] = p;
      return orientation<D>(corners) > 0;
    });
  }
};

template <typename Dimension>
class Finality : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Finality, Dimensions);

TYPED_TEST(Finality, NeverCallsASimplexFinalThatASiblingDestroys) {
  constexpr int kD = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Halves<kD> halves(seed);
    std::vector<Simplex<kD>> simplices;
    halves.left.for_each_simplex(
        [&](SimplexId, const Simplex<kD>& simplex) { simplices.push_back(simplex); });
    for_each_region<kD>(
        simplices.size(), [&](std::size_t s) { return simplices[s].vertices; }, halves.left.points,
        [&](std::size_t s, const ConflictRegion<kD>& region) {
          if (halves.destroyed(simplices[s])) {
            EXPECT_TRUE(region.may_meet_leaf(halves.right));
          }
        });
  }
}

TYPED_TEST(Finality, BorderSearchFindsAllThatASiblingDestroys) {
  constexpr int kD = TypeParam::value;
  Halves<kD> halves(7);
  const std::vector<const Part<kD>*> others{&halves.right};
  std::vector<BlockMarks> marks;
  for (const auto& block : halves.left.blocks) {
    marks.emplace_back(block.simplices.size(), Mark::kInterior);
  }
  auto border = find_border<kD>(halves.left, halves.left.hull, others, marks);
  std::sort(border.begin(), border.end());
  EXPECT_EQ(std::adjacent_find(border.begin(), border.end()), border.end());
  std::size_t all = 0;
  halves.left.for_each_simplex([&](SimplexId id, const Simplex<kD>& simplex) {
    ++all;
    const bool found = std::binary_search(border.begin(), border.end(), id);
    EXPECT_EQ(found, marks[id.block][id.index] == Mark::kBorder);
    if (halves.destroyed(simplex)) {
      EXPECT_TRUE(found);
    }
  });
  EXPECT_LT(border.size(), all);
}

TYPED_TEST(Finality, BorderAmongAllSimplicesHasAllThatTheSearchFinds) {
  constexpr int kD = TypeParam::value;
  const Halves<kD> halves(8);
  const std::vector<const Part<kD>*> others{&halves.right};
  std::vector<BlockMarks> fresh;
  for (const auto& block : halves.left.blocks) {
    fresh.emplace_back(block.simplices.size(), Mark::kInterior);
  }
  std::vector<SimplexId> all;
  halves.left.for_each_simplex([&](SimplexId id, const Simplex<kD>&) { all.push_back(id); });
  std::vector<BlockMarks> marks = fresh;
  const auto border = border_among<kD>(halves.left, all, others, marks);
  EXPECT_TRUE(std::is_sorted(border.begin(), border.end()));
  EXPECT_LT(border.size(), all.size());
  for (const SimplexId id : all) {
    EXPECT_EQ(marks[id.block][id.index] == Mark::kBorder,
              std::binary_search(border.begin(), border.end(), id));
  }
  for (const SimplexId id : find_border<kD>(halves.left, halves.left.hull, others, fresh)) {
    EXPECT_TRUE(std::binary_search(border.begin(), border.end(), id));
  }
}

}  // namespace
}  // namespace spillway
