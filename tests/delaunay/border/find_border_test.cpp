#include "src/delaunay/border/find_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/border/conflict_region_batch.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

/// Whether one of the others destroys a simplex of this triangulation.
template <int D>
bool destroyed(const Simplex<D>& simplex, const Triangulation<D>& triangulation,
               const std::vector<Point<D>>& others) {
  std::array<Point<D>, D + 1> corners;
  const int infinite = simplex.infinite_corner();
  for (int i = 0; i <= D; ++i) {
    if (i != infinite) corners[i] = triangulation.points[simplex.vertices[i]];
  }
  return std::any_of(others.begin(), others.end(), [&](const Point<D>& p) {
    if (infinite < 0) return in_sphere<D>(corners, p) > 0;
    corners[infinite] = p;
    return orientation<D>(corners) > 0;
  });
}

/// The boxes of the leaves of a tree of parts.
template <int D>
void add_boxes(const Part<D>& part, std::span<const Point<D>> points,
               std::vector<RunBoxes<D>>& boxes) {
  boxes.resize(std::max<std::size_t>(boxes.size(), part.list + 1));
  if (part.leaf()) boxes[part.list] = RunBoxes<D>(points.subspan(part.begin, part.size()));
  for (const Part<D>& child : part.children) add_boxes<D>(child, points, boxes);
}

template <int D>
Box<D> box_around(std::span<const Point<D>> points) {
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  return box;
}

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
    left = delaunay_triangulation<D>(left_points, {.threads = 1});
    std::vector<VertexId> index(right_points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    right = divide<D>(right_points, index, {.leaf_points = 40});
  }
};

template <typename Dimension>
class FindBorder : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FindBorder, Dimensions);

TYPED_TEST(FindBorder, NeverCallsASimplexFinalThatASiblingDestroys) {
  constexpr int kD = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Halves<kD> halves(seed);
    std::vector<Simplex<kD>> simplices;
    halves.left.for_each_simplex(
        [&](SimplexId, const Simplex<kD>& simplex) { simplices.push_back(simplex); });
    for_each_region<kD>(
        simplices.size(), [&](std::size_t s) { return simplices[s].vertices; }, halves.left.points,
        [&](std::size_t s, const ConflictRegion<kD>& region) {
          if (destroyed<kD>(simplices[s], halves.left, halves.right_points)) {
            EXPECT_TRUE(region.may_meet_leaf(halves.right));
          }
        });
  }
}

TYPED_TEST(FindBorder, BorderSearchFindsAllThatASiblingDestroys) {
  constexpr int kD = TypeParam::value;
  Halves<kD> halves(7);
  const std::vector<const Part<kD>*> others{&halves.right};
  std::vector<RunBoxes<kD>> boxes;
  add_boxes<kD>(halves.right, halves.right_points, boxes);
  std::vector<ListMarks> marks;
  for (const auto& list : halves.left.lists) {
    marks.emplace_back(list.simplices.size(), Mark::kInterior);
  }
  auto border = find_border<kD>(halves.left, box_around<kD>(halves.left.points.span()),
                                halves.left.hull, {others, halves.right_points, boxes}, marks);
  std::sort(border.begin(), border.end());
  EXPECT_EQ(std::adjacent_find(border.begin(), border.end()), border.end());
  std::size_t all = 0;
  halves.left.for_each_simplex([&](SimplexId id, const Simplex<kD>& simplex) {
    ++all;
    const bool found = std::binary_search(border.begin(), border.end(), id);
    EXPECT_EQ(found, marks[id.list][id.index] == Mark::kBorder);
    if (destroyed<kD>(simplex, halves.left, halves.right_points)) {
      EXPECT_TRUE(found);
    }
  });
  EXPECT_LT(border.size(), all);
}

/// A border picked from the list of a leaf's kernel.
template <int D>
struct PickedBorder {
  Triangulation<D> triangulation;
  std::vector<std::uint32_t> candidates;
  std::vector<SimplexId> picked;
};

/// Expects that it has all that `others_points`, which are the sibling's, destroy, and that what a
/// search finds has it, too.
template <int D>
PickedBorder<D> expect_all_destroyed(const std::vector<Point<D>>& points, const Part<D>& sibling,
                                     const std::vector<Point<D>>& others_points) {
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  Box<D> safe_box = whole_space<D>();
  cut_back(safe_box, box, sibling.box);
  BaseCase<D> leaf =
      triangulate_base_case<D>({.points = points, .input_index = index, .safe_box = safe_box});
  Triangulation<D> triangulation;
  triangulation.points = SlabArray<Point<D>>(points.size());
  std::copy(points.begin(), points.end(), triangulation.points.begin());
  triangulation.lists.resize(1);
  triangulation.lists[0].simplices = std::move(leaf.simplices);
  for (const std::uint32_t s : leaf.hull) triangulation.hull.push_back({0, s});
  const std::size_t count = triangulation.lists[0].simplices.size();
  const std::vector<std::uint32_t> candidates = leaf.not_inside.value();
  EXPECT_TRUE(std::is_sorted(candidates.begin(), candidates.end()));

  const std::vector<const Part<D>*> others{&sibling};
  std::vector<RunBoxes<D>> boxes;
  add_boxes<D>(sibling, others_points, boxes);
  const Siblings<D> siblings{others, others_points, boxes};
  std::vector<ListMarks> marks;
  marks.emplace_back(count, Mark::kFinal);
  for (const std::uint32_t s : candidates) marks[0][s] = Mark::kInterior;
  const auto picked = border_among<D>(triangulation, 0, candidates, siblings, marks);
  EXPECT_TRUE(std::is_sorted(picked.begin(), picked.end()));
  std::vector<ListMarks> unmarked;
  unmarked.emplace_back(count, Mark::kInterior);
  auto searched = find_border<D>(triangulation, box, triangulation.hull, siblings, unmarked);
  std::sort(searched.begin(), searched.end());
  EXPECT_LT(picked.size(), count);
  for (std::uint32_t s = 0; s < count; ++s) {
    const SimplexId id{0, s};
    const bool found = std::binary_search(picked.begin(), picked.end(), id);
    EXPECT_EQ(found, marks[0][s] == Mark::kBorder);
    EXPECT_NE(marks[0][s], Mark::kVague);
    const bool in_both = found && std::binary_search(searched.begin(), searched.end(), id);
    if (!in_both) {
      EXPECT_FALSE(destroyed<D>(triangulation.simplex(id), triangulation, others_points));
    }
  }
  return {std::move(triangulation), candidates, picked};
}

TYPED_TEST(FindBorder, BorderPickedFromALeafsListHasAllThatASiblingDestroys) {
  constexpr int kD = TypeParam::value;
  for (std::uint64_t seed = 8; seed <= 10; ++seed) {
    const Halves<kD> halves(seed);
    expect_all_destroyed<kD>({halves.left.points.begin(), halves.left.points.end()}, halves.right,
                             halves.right_points);
  }
}

/// Of its slivers, many cannot be certified, wherever they are.
TEST(FindBorderInSpace, BorderPickedFromARotatedLatticeHasAllThatASiblingDestroys) {
  std::vector<Point<3>> left;
  std::vector<Point<3>> right;
  for (int x = -8; x < 8; ++x) {
    for (int y = -8; y < 8; ++y) {
      for (int z = -8; z < 8; ++z) {
        const double u = std::cos(0.3) * x - std::sin(0.3) * y;
        const double v = std::sin(0.3) * x + std::cos(0.3) * y;
        const Point<3> p{u, std::cos(0.7) * v - std::sin(0.7) * z,
                         std::sin(0.7) * v + std::cos(0.7) * z};
        (p[0] < 0 ? left : right).push_back(p);
      }
    }
  }
  std::vector<VertexId> index(right.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  const Part<3> sibling = divide<3>(right, index, {.leaf_points = 40});
  const PickedBorder<3> border = expect_all_destroyed<3>(left, sibling, right);
  std::array<std::size_t, 2> vague{};  // left out, picked
  for_each_region<3>(
      border.candidates.size(),
      [&](std::size_t c) {
        return border.triangulation.simplex({0, border.candidates[c]}).vertices;
      },
      border.triangulation.points,
      [&](std::size_t c, const ConflictRegion<3>& region) {
        const SimplexId id{0, border.candidates[c]};
        const bool found = std::binary_search(border.picked.begin(), border.picked.end(), id);
        if (!region.tight()) ++vague[found ? 1 : 0];
      });
  EXPECT_GT(vague[0], 0U);
  EXPECT_GT(vague[1], 0U);
}

}  // namespace
}  // namespace spillway::test
