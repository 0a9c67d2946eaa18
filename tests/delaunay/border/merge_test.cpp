// Merges of parts that are triangulated each by itself, against CGAL's triangulation of all points
// and the laws of any triangulation.

#include "src/delaunay/border/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/parallel/parallel.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/delaunay/verify.h"

namespace spillway::test {
namespace {

/// Points of a leaf, or what is merged.
template <int D>
struct Tree {
  std::vector<Point<D>> points{};
  std::vector<Tree> children{};
};

template <int D>
std::vector<std::array<VertexId, D + 1>> sorted_simplices(const Triangulation<D>& mesh) {
  std::vector<std::array<VertexId, D + 1>> simplices;
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    simplices.push_back(simplex.vertices);
    std::ranges::sort(simplices.back());
  });
  std::ranges::sort(simplices);
  return simplices;
}

struct Choices {
  bool kernel_tells = false;     ///< which simplices of a leaf points of others may change
  bool may_stay_open = false;    ///< the merge of all
  std::size_t border_lists = 1;  ///< at least, of the triangulation of a border
};

/// Triangulates the leaves of a tree and merges from below upwards. Vertices have the numbers of
/// their points.
template <int D>
class Merges {
 public:
  explicit Merges(const Tree<D>& tree, Choices choices = {}) : choices_(choices) {
    std::uint32_t lists = 0;
    number(tree, root_, lists);
    mesh_.points = SlabArray<Point<D>>(points_.size());
    std::ranges::copy(points_, mesh_.points.begin());
    mesh_.input_index = SlabArray<VertexId>(points_.size());
    std::iota(mesh_.input_index.begin(), mesh_.input_index.end(), VertexId{0});
    mesh_.lists.resize(lists);
    marks_.resize(lists);
    boxes_.resize(lists);
    surface_ = triangulate(root_, whole_space<D>());
    mesh_.dimension = surface_.dimension;
    mesh_.hull = surface_.hull;
  }

  [[nodiscard]] const std::vector<Point<D>>& points() const { return points_; }
  [[nodiscard]] const Triangulation<D>& mesh() const { return mesh_; }
  [[nodiscard]] const PartSurface& surface() const { return surface_; }
  [[nodiscard]] const std::vector<ListMarks>& marks() const { return marks_; }
  /// Points that the last merge has triangulated once more; none if it has not.
  [[nodiscard]] std::size_t border_points() const { return border_points_; }
  [[nodiscard]] const Task& task() const { return task_; }

 private:
  void number(const Tree<D>& tree, Part<D>& part, std::uint32_t& lists) {
    part.begin = static_cast<VertexId>(points_.size());
    points_.insert(points_.end(), tree.points.begin(), tree.points.end());
    for (const Point<D>& p : tree.points) part.box.expand(p);
    part.children.resize(tree.children.size());
    for (std::size_t c = 0; c < tree.children.size(); ++c) {
      number(tree.children[c], part.children[c], lists);
      part.box.expand(part.children[c].box);
    }
    part.end = static_cast<VertexId>(points_.size());
    part.list = lists++;
  }

  PartSurface triangulate(const Part<D>& part, const Box<D>& safe_box) {
    if (part.leaf()) return triangulate_leaf(part, safe_box);
    std::vector<PartSurface> surfaces;
    for (const Part<D>& child : part.children) {
      Box<D> box = safe_box;
      for (const Part<D>& other : part.children) {
        if (&other != &child) cut_back(box, child.box, other.box);
      }
      surfaces.push_back(triangulate(child, box));
    }
    task_ = {};
    border_points_ = 0;
    const auto triangulate_border = [&](SlabArray<Point<D>> border, std::size_t part_size, Task&) {
      EXPECT_EQ(part_size, part.size());
      border_points_ = border.size();
      return delaunay_triangulation<D>(
          border.span(), {.threads = 1, .leaf_points = border.size() / choices_.border_lists});
    };
    return merge<D>(mesh_, marks_, boxes_, part, surfaces,
                    choices_.may_stay_open && &part == &root_, triangulate_border, task_);
  }

  PartSurface triangulate_leaf(const Part<D>& part, const Box<D>& safe_box) {
    const std::span<const Point<D>> points = mesh_.points.span().subspan(part.begin, part.size());
    BaseCaseInput<D> input{.points = points,
                           .input_index = mesh_.input_index.span().subspan(part.begin, part.size()),
                           .first_vertex = part.begin};
    if (choices_.kernel_tells) input.safe_box = safe_box;
    BaseCase<D> leaf = triangulate_base_case<D>(input);
    boxes_[part.list] = RunBoxes<D>(points);
    marks_[part.list] =
        ListMarks(leaf.simplices.size(), leaf.not_inside ? Mark::kFinal : Mark::kInterior);
    PartSurface surface;
    surface.dimension = leaf.dimension;
    surface.open = leaf.dimension < D;
    for (const std::uint32_t i : leaf.hull) surface.hull.push_back({part.list, i});
    if (leaf.not_inside) {
      for (const std::uint32_t i : *leaf.not_inside) marks_[part.list][i] = Mark::kInterior;
      surface.changeable = std::move(leaf.not_inside);
    }
    if (surface.open) {
      for (VertexId v = part.begin; v < part.end; ++v) {
        const auto is_dropped = [v](const DroppedDuplicate& d) { return d.dropped == v; };
        if (std::ranges::none_of(leaf.duplicates, is_dropped)) surface.vertices.push_back(v);
      }
    }
    mesh_.duplicates.insert(mesh_.duplicates.end(), leaf.duplicates.begin(), leaf.duplicates.end());
    mesh_.lists[part.list].simplices = std::move(leaf.simplices);
    return surface;
  }

  const Choices choices_;
  std::vector<Point<D>> points_;
  Part<D> root_;
  Triangulation<D> mesh_;
  std::vector<ListMarks> marks_;
  std::vector<RunBoxes<D>> boxes_;
  PartSurface surface_;
  std::size_t border_points_ = 0;
  Task task_;
};

/// Of equal points the first.
template <int D>
std::vector<VertexId> distinct_vertices(const std::vector<Point<D>>& points) {
  std::map<Point<D>, VertexId> first;
  for (VertexId v = 0; v < points.size(); ++v) first.emplace(points[v], v);
  std::vector<VertexId> vertices;
  for (const auto& [point, v] : first) vertices.push_back(v);
  std::ranges::sort(vertices);
  return vertices;
}

template <int D>
void expect_triangulation_of_all(const Merges<D>& merges) {
  EXPECT_THAT(verify<D>(merges.mesh()), ::testing::IsEmpty());
  const auto simplices = sorted_simplices<D>(merges.mesh());
  EXPECT_EQ(simplices, cgal_simplices<D>(merges.points()));
  const PartSurface& surface = merges.surface();
  EXPECT_EQ(surface.open, simplices.empty());
  EXPECT_EQ(surface.open, surface.dimension < D);
  if (surface.open) {
    EXPECT_EQ(surface.vertices, distinct_vertices<D>(merges.points()));
    EXPECT_THAT(surface.hull, ::testing::IsEmpty());
  } else {
    EXPECT_EQ(surface.hull.size(), cgal_hull_facets<D>(merges.points()));
  }
  for (const ListMarks& list : merges.marks()) {
    for (const Mark mark : list) {
      ASSERT_TRUE(mark == Mark::kInterior || mark == Mark::kFinal) << "as the next merge needs it";
    }
  }
}

template <int D>
void expect_triangulation_of_all(const Tree<D>& tree) {
  for (const bool kernel_tells : {false, true}) {
    for (const std::size_t border_lists : {1, 3}) {
      SCOPED_TRACE(::testing::Message() << kernel_tells << ", lists of borders: " << border_lists);
      expect_triangulation_of_all<D>(
          Merges<D>(tree, {.kernel_tells = kernel_tells, .border_lists = border_lists}));
    }
  }
}

/// Random places of a lattice of so many on each axis, moved along the first one.
template <int D>
Tree<D> random_leaf(std::size_t count, std::uint64_t side, double shift, std::mt19937_64& random) {
  Tree<D> leaf;
  leaf.points.resize(count);
  for (Point<D>& p : leaf.points) {
    for (double& x : p) x = static_cast<double>(random() % side);
    p[0] += shift;
  }
  return leaf;
}

/// So many leaves beside each other on the first axis.
template <int D>
Tree<D> random_leaves(std::size_t leaves, std::size_t count, std::uint64_t side,
                      std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Tree<D> tree;
  for (std::size_t c = 0; c < leaves; ++c) {
    tree.children.push_back(random_leaf<D>(count, side, static_cast<double>(c * side), random));
  }
  return tree;
}

/// Leaves along the first axis, of all places of a lattice as long as `has` says of them.
template <int D, typename Has>
Tree<D> lattice_leaves(std::size_t leaves, int side, const Has& has) {
  Tree<D> tree;
  tree.children.resize(leaves);
  for (std::size_t c = 0; c < leaves; ++c) {
    Point<D> p{};
    for (bool more = true; more;) {
      Point<D> moved = p;
      moved[0] += static_cast<double>(c) * side;
      if (has(moved)) tree.children[c].points.push_back(moved);
      int k = 0;
      for (; k < D && ++p[k] == side; ++k) p[k] = 0;
      more = k < D;
    }
  }
  return tree;
}

template <typename Dimension>
class MergeTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MergeTest, Dimensions);

TYPED_TEST(MergeTest, OfTwoIsTheTriangulationOfAllPoints) {
  constexpr int kD = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_triangulation_of_all<kD>(random_leaves<kD>(2, 150, 1'000'000, seed));
  }
}

TYPED_TEST(MergeTest, OfThreeAtOnceIsTheTriangulationOfAllPoints) {
  constexpr int kD = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_triangulation_of_all<kD>(random_leaves<kD>(3, 100, 1'000'000, seed));
  }
}

TYPED_TEST(MergeTest, OfMergesLinksWhatLiesInTheListsOfSeveral) {
  constexpr int kD = TypeParam::value;
  const Tree<kD> leaves = random_leaves<kD>(5, 60, 1'000'000, 4);
  const auto& leaf = leaves.children;
  const Tree<kD> left{.children = {leaf[0], leaf[1]}};
  const Tree<kD> right{.children = {leaf[3], leaf[4]}};
  expect_triangulation_of_all<kD>(Tree<kD>{.children = {left, leaf[2], right}});
  expect_triangulation_of_all<kD>(
      Tree<kD>{.children = {Tree<kD>{.children = {left, leaf[2]}}, right}});
}

TYPED_TEST(MergeTest, OfALatticeBreaksTiesAsTheTriangulationOfAllDoes) {
  constexpr int kD = TypeParam::value;
  const auto all = [](const Point<kD>&) { return true; };
  expect_triangulation_of_all<kD>(lattice_leaves<kD>(2, 4, all));
  expect_triangulation_of_all<kD>(lattice_leaves<kD>(3, 4, all));
}

TYPED_TEST(MergeTest, OfEqualPointsKeepsTheFirstOfEach) {
  constexpr int kD = TypeParam::value;
  expect_triangulation_of_all<kD>(random_leaves<kD>(2, 200, 4, 5));
  expect_triangulation_of_all<kD>(random_leaves<kD>(3, 200, 4, 6));
}

/// Lines in the plane, planes in space.
TYPED_TEST(MergeTest, OfFlatPartsHasTheSimplicesBetweenThem) {
  constexpr int kD = TypeParam::value;
  const auto first_layer = [](const Point<kD>& p) { return static_cast<int>(p[0]) % 5 == 0; };
  expect_triangulation_of_all<kD>(lattice_leaves<kD>(2, 5, first_layer));
  expect_triangulation_of_all<kD>(lattice_leaves<kD>(3, 5, first_layer));
}

TYPED_TEST(MergeTest, OfAFlatPartBesideAnotherHasAllItsPoints) {
  constexpr int kD = TypeParam::value;
  for (const double flat : {0.0, 5.0}) {
    expect_triangulation_of_all<kD>(lattice_leaves<kD>(2, 5, [&](const Point<kD>& p) {
      const bool in_flat_part = (p[0] < 5) == (flat < 5);
      return !in_flat_part || p[0] == flat;
    }));
  }
}

TYPED_TEST(MergeTest, OfOnePointBesideAPartHasTheCone) {
  constexpr int kD = TypeParam::value;
  Tree<kD> tree = random_leaves<kD>(2, 100, 1000, 7);
  tree.children[1].points.resize(1);
  expect_triangulation_of_all<kD>(tree);
  std::swap(tree.children[0], tree.children[1]);
  expect_triangulation_of_all<kD>(tree);
}

TYPED_TEST(MergeTest, OfPartsThatLieFlatTogetherStaysOpenWithAllVertices) {
  constexpr int kD = TypeParam::value;
  const auto on_a_line = [](const Point<kD>& p) { return p[1] == p[0] && p[kD - 1] == p[0]; };
  const auto on_a_slope = [](const Point<kD>& p) {
    return p[kD - 1] == (kD == 2 ? p[0] : p[0] + p[1]);
  };
  for (const std::size_t leaves : {2, 3}) {
    Tree<kD> line = lattice_leaves<kD>(1, 12, on_a_line);
    Tree<kD> slope = lattice_leaves<kD>(1, 12, on_a_slope);
    for (Tree<kD>* tree : {&line, &slope}) {
      std::vector<Point<kD>> points = tree->children[0].points;
      std::ranges::sort(points);
      tree->children.assign(leaves, {});
      for (const Point<kD>& p : points) {
        tree->children[static_cast<std::size_t>(p[0]) * leaves / 12].points.push_back(p);
      }
    }
    EXPECT_EQ(Merges<kD>(line).surface().dimension, 1);
    EXPECT_EQ(Merges<kD>(slope).surface().dimension, kD - 1);
    expect_triangulation_of_all<kD>(line);
    expect_triangulation_of_all<kD>(slope);
  }
}

/// A few points each, so that most parts are flat and most hulls face each other.
TYPED_TEST(MergeTest, OfTinyPartsOfALatticeIsTheTriangulationOfAllPoints) {
  constexpr int kD = TypeParam::value;
  std::mt19937_64 random(8);
  std::array<int, kD + 1> dimensions{};
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const std::uint64_t side = 1 + random() % 3;
    Tree<kD> tree;
    const std::size_t leaves = 2 + random() % 3;
    for (std::size_t c = 0; c < leaves; ++c) {
      tree.children.push_back(
          random_leaf<kD>(1 + random() % 9, side, static_cast<double>(c * side), random));
    }
    const Merges<kD> merges(tree, {.kernel_tells = random() % 2 == 0});
    expect_triangulation_of_all<kD>(merges);
    ++dimensions.at(static_cast<std::size_t>(merges.surface().dimension));
  }
  EXPECT_GT(dimensions[1], 3);
  EXPECT_GT(dimensions[kD], 50);
}

TYPED_TEST(MergeTest, TriangulatesAgainOnlyWhatLiesNearTheOthers) {
  constexpr int kD = TypeParam::value;
  const Merges<kD> merges(random_leaves<kD>(2, kD == 2 ? 1000 : 2000, 1'000'000, 9),
                          {.may_stay_open = true});
  EXPECT_LT(merges.border_points(), merges.points().size() * kLargestBorder);
  EXPECT_GT(merges.border_points(), 0U);
  expect_triangulation_of_all<kD>(merges);
}

TYPED_TEST(MergeTest, StaysOpenWhereMostPointsAreInBordersIfItMay) {
  constexpr int kD = TypeParam::value;
  const Tree<kD> tree = random_leaves<kD>(2, 6, 1'000'000, 10);
  const Merges<kD> merges(tree, {.may_stay_open = true});
  EXPECT_TRUE(merges.surface().open);
  EXPECT_EQ(merges.surface().dimension, kD);
  EXPECT_THAT(merges.surface().vertices, ::testing::IsEmpty()) << "the caller sets them";
  EXPECT_EQ(merges.border_points(), 0U) << "nothing is triangulated in vain";
  expect_triangulation_of_all<kD>(tree);
}

TYPED_TEST(MergeTest, IsTheSameByManyThreads) {
  constexpr int kD = TypeParam::value;
  // Flat boxes beside each other: more simplices are in the border than one thread takes at a time.
  std::mt19937_64 random(11);
  Tree<kD> tree;
  for (int c = 0; c < 2; ++c) {
    tree.children.push_back(random_leaf<kD>(kD == 2 ? 1500 : 500, 1'000'000, 0, random));
    for (Point<kD>& p : tree.children.back().points) p[0] = c + p[0] * 0x1p-24;
  }
  with_threads(1, [&] { expect_triangulation_of_all<kD>(Merges<kD>(tree)); });
  with_threads(4, [&] { expect_triangulation_of_all<kD>(Merges<kD>(tree)); });
}

TYPED_TEST(MergeTest, TellsItsStepsInTheirOrder) {
  constexpr int kD = TypeParam::value;
  const Merges<kD> merges(random_leaves<kD>(2, 100, 1000, 12));
  const std::vector<Task>& steps = merges.task().after;
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0].kind, TaskKind::kBorder);
  EXPECT_EQ(steps[0].points, merges.border_points());
  EXPECT_EQ(steps[2].kind, TaskKind::kAccept);
  EXPECT_EQ(steps[3].kind, TaskKind::kNeighbours);
}

}  // namespace
}  // namespace spillway::test
