#include "stream/triangulate/leaf_border.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "src/geometry/predicates.h"
#include "stream/triangulate/merge_tree.h"

namespace spillway::test {
namespace {

template <int D>
using Points = std::vector<Point<D>>;
struct NoState {};
template <int D>
using PartTree = MergeTree<Part<D>, NoState>;

/// Whether one of the others destroys a simplex, exactly.
template <int D>
bool destroyed(const std::array<VertexId, D + 1>& simplex, std::span<const Point<D>> points,
               std::span<const Point<D>> others) {
  std::array<Point<D>, D + 1> corners;
  int infinite = -1;
  for (int i = 0; i <= D; ++i) {
    if (simplex[i] == kInfiniteVertex) {
      infinite = i;
    } else {
      corners[i] = points[simplex[i]];
    }
  }
  return std::ranges::any_of(others, [&](const Point<D>& p) {
    if (infinite < 0) return in_sphere<D>(corners, p) > 0;
    corners[infinite] = p;
    return orientation<D>(corners) > 0;
  });
}

/// A tile in leaves, and another tile beyond x = 1.
template <int D>
class Tile {
 public:
  explicit Tile(Points<D> all, std::size_t leaf_points = 150) {
    const auto beyond =
        std::partition(all.begin(), all.end(), [](const auto& p) { return p[0] < 1; });
    others_.assign(beyond, all.end());
    points_.assign(all.begin(), beyond);
    index_.resize(points_.size());
    std::iota(index_.begin(), index_.end(), VertexId{0});
    root_ = divide<D>(points_, index_, {.leaf_points = leaf_points});
    boxes_.resize(root_.list + 1);
    for (const Point<D>& p : others_) other_.box.expand(p);
    other_.points = others_.size();
    tree_.emplace(root_);
    for (const auto* leaf : tree_->leaves()) {
      boxes_[leaf->tree->list] = RunBoxes<D>(points_of(*leaf->tree));
    }
  }

  [[nodiscard]] std::span<const Point<D>> points_of(const Part<D>& part) const {
    return std::span<const Point<D>>(points_).subspan(part.begin, part.size());
  }
  [[nodiscard]] const auto& leaves() const { return tree_->leaves(); }
  [[nodiscard]] std::span<const Point<D>> others() const { return others_; }
  [[nodiscard]] Surroundings<D> surroundings_of(const typename PartTree<D>::Node& leaf) const {
    return {tree_->siblings_by_level(leaf), outside_, points_, boxes_, true};
  }
  [[nodiscard]] BaseCase<D> base_case(const Part<D>& part) const {
    return triangulate_base_case<D>(
        {.points = points_of(part),
         .input_index = std::span(index_).subspan(part.begin, part.size()),
         .first_vertex = part.begin,
         .in_place = true});
  }

 private:
  Points<D> points_, others_;
  std::vector<VertexId> index_;
  Part<D> root_;
  std::vector<RunBoxes<D>> boxes_;
  TileNode<D> other_;
  Outside<D> outside_{&other_};
  std::optional<PartTree<D>> tree_;
};

/// Searches the borders of all leaves, expects that nothing is missing, and returns the share of
/// the finite simplices that is final.
template <int D>
double search_all(const Tile<D>& tile) {
  std::size_t count = 0, final = 0;
  for (const auto* leaf : tile.leaves()) {
    const Part<D>& part = *leaf->tree;
    BaseCase<D> base_case = tile.base_case(part);
    if (base_case.dimension < D) continue;
    const std::vector<Simplex<D>> simplices(base_case.simplices.begin(), base_case.simplices.end());
    const auto surroundings = tile.surroundings_of(*leaf);
    const LeafFates told = search_leaf_border<D>({tile.points_of(part), part.begin, part.box},
                                                 surroundings, base_case);
    const std::vector<std::uint32_t>& open = *base_case.not_inside;
    EXPECT_EQ(open.size(), told.exposure.size());
    EXPECT_EQ(open.size(), base_case.open_simplices.size());
    for (std::uint32_t s = 0, o = 0; s < simplices.size(); ++s) {
      EXPECT_EQ(base_case.corners[s], simplices[s].vertices);
      std::array<VertexId, D + 1> corners = simplices[s].vertices;
      for (VertexId& v : corners) v = v == kInfiniteVertex ? v : v - part.begin;
      const bool infinite = simplices[s].infinite();
      const bool is_open = o < open.size() && open[o] == s;
      EXPECT_EQ(is_open, infinite || told.fates[s] == Fate::kKept);
      if (told.fates[s] != Fate::kKept) {
        EXPECT_EQ(told.fates[s], infinite ? Fate::kFinalFacet : Fate::kFinal);
      }
      const Exposure exposure = is_open ? told.exposure[o] : Exposure{0};
      if (is_open) {
        EXPECT_EQ(base_case.open_simplices[o].neighbours, simplices[s].neighbours);
        ++o;
      }
      for (std::size_t l = 0; l < surroundings.levels.size(); ++l) {
        for (const Part<D>* sibling : surroundings.levels[l]) {
          if (!destroyed<D>(corners, tile.points_of(part), tile.points_of(*sibling))) continue;
          EXPECT_EQ(told.fates[s], Fate::kKept);
          EXPECT_TRUE(exposure >> l & 1);
        }
      }
      if (destroyed<D>(corners, tile.points_of(part), tile.others())) {
        EXPECT_EQ(told.fates[s], Fate::kKept);
      }
      count += infinite ? 0 : 1;
      final += told.fates[s] == Fate::kFinal ? 1 : 0;
    }
  }
  return static_cast<double>(final) / static_cast<double>(count);
}

template <int D>
Points<D> on_a_sphere(std::size_t count, double noise) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Points<D> points(count);
  for (auto& p : points) {
    double length = 0;
    for (double& x : p) {
      x = normal(random);
      length += x * x;
    }
    const double radius = 1.2 + noise * normal(random);
    for (int k = 0; k < D; ++k) p[k] *= radius * (k == 0 ? 1 : 0.6) / std::sqrt(length);
  }
  return points;
}

template <typename Dimension>
class LeafBorder : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LeafBorder, Dimensions);

TYPED_TEST(LeafBorder, HasAllThatPointsOfASurfaceMayChangeAndLittleElse) {
  constexpr int D = TypeParam::value;
  // A short arc alone has the triangles of the whole ellipse nowhere.
  EXPECT_GE(search_all<D>(Tile<D>(on_a_sphere<D>(1500, 0))), D == 2 ? 0 : 0.4);
  EXPECT_GT(search_all<D>(Tile<D>(on_a_sphere<D>(1500, 1e-3))), 0.4);
}

TYPED_TEST(LeafBorder, HasAllThatPointsOfALatticeMayChange) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(6);
  Points<D> points(1200);
  for (auto& p : points) {
    for (double& x : p) x = static_cast<double>(random() % 12) / 8;
  }
  EXPECT_GT(search_all<D>(Tile<D>(std::move(points))), 0);
}

TYPED_TEST(LeafBorder, LooksAtAllWhereAnotherTileOverlaps) {
  constexpr int D = TypeParam::value;
  const Points<D> points = on_a_sphere<D>(600, 0.1);
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  BaseCase<D> leaf = triangulate_base_case<D>({.points = points, .input_index = index});
  TileNode<D> inside;
  Points<D> others(1);  // in the middle
  inside.box.expand(others[0]);
  const Outside<D> outside{&inside};
  const LeafFates told =
      search_leaf_border<D>({points, 0, box}, {.levels = {}, .outside = outside}, leaf);
  EXPECT_TRUE(told.exposure.empty());
  std::size_t kept = 0;
  for (std::size_t s = 0; s < leaf.corners.size(); ++s) {
    const bool is_destroyed = destroyed<D>(leaf.corners[s], points, others);
    kept += told.fates[s] == Fate::kKept ? 1 : 0;
    if (is_destroyed) {
      EXPECT_EQ(told.fates[s], Fate::kKept);
    }
  }
  EXPECT_GT(kept, 0U);
}

}  // namespace
}  // namespace spillway::test
