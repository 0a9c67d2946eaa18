#include "src/delaunay/division/divide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

template <int D>
struct DividedPoints {
  std::vector<Point<D>> original;
  std::vector<Point<D>> points;
  std::vector<VertexId> input_index;
  Part<D> root;
};
using Divided = DividedPoints<2>;

template <int D>
DividedPoints<D> divided_points(std::vector<Point<D>> points, const DivideOptions& options,
                                unsigned threads = 1) {
  DividedPoints<D> d{points, points, std::vector<VertexId>(points.size()), {}};
  std::iota(d.input_index.begin(), d.input_index.end(), VertexId{0});
  with_threads(threads, [&] { d.root = divide<D>(d.points, d.input_index, options); });
  return d;
}

Divided divided(std::vector<Point<2>> points, const DivideOptions& options, unsigned threads = 1) {
  return divided_points<2>(std::move(points), options, threads);
}

std::vector<Point<2>> random_points(std::size_t n, std::uint64_t distinct) {
  std::mt19937_64 random(n);
  std::vector<Point<2>> points(n);
  for (auto& p : points) {
    p = {static_cast<double>(random() % distinct), static_cast<double>(random() % distinct)};
  }
  return points;
}

template <int D, typename F>
void visit(const Part<D>& part, const F& f) {
  f(part);
  for (const Part<D>& child : part.children) visit(child, f);
}

TEST(Divide, KeepsEveryPointAndItsIndex) {
  const Divided d = divided(random_points(5000, 1000), {.leaf_points = 50});
  std::vector<bool> seen(d.points.size());
  for (std::size_t i = 0; i < d.points.size(); ++i) {
    EXPECT_EQ(d.points[i], d.original[d.input_index[i]]);
    EXPECT_FALSE(seen[d.input_index[i]]);
    seen[d.input_index[i]] = true;
  }
}

TEST(Divide, MakesDisjointTightBoxesAndSmallLeaves) {
  const Divided d = divided(random_points(5000, 1000), {.leaf_points = 50, .children = 3});
  visit(d.root, [&](const Part<2>& part) {
    Box<2> tight;
    for (VertexId v = part.begin; v < part.end; ++v) tight.expand(d.points[v]);
    EXPECT_EQ(tight, part.box);
    if (part.leaf()) {
      EXPECT_LE(part.size(), 50U);
    }
    VertexId next = part.begin;
    for (const Part<2>& child : part.children) {
      EXPECT_EQ(child.begin, next);
      EXPECT_GT(child.size(), 0U);
      EXPECT_LT(child.list, part.list);
      next = child.end;
      for (const Part<2>& other : part.children) {
        if (&other == &child) continue;
        const bool apart = child.box.hi[0] < other.box.lo[0] || other.box.hi[0] < child.box.lo[0] ||
                           child.box.hi[1] < other.box.lo[1] || other.box.hi[1] < child.box.lo[1];
        EXPECT_TRUE(apart);
      }
    }
    if (!part.leaf()) {
      EXPECT_EQ(next, part.end);
    }
  });
}

TEST(Divide, NeverSeparatesEqualPoints) {
  const Divided d = divided(random_points(3000, 5), {.leaf_points = 10});
  visit(d.root, [&](const Part<2>& part) {
    if (part.leaf() && part.size() > 10) {
      EXPECT_EQ(part.box.lo, part.box.hi);
    }
  });
  std::vector<Point<2>> at_leaf_ends;
  visit(d.root, [&](const Part<2>& part) {
    if (part.leaf() && part.begin > 0) {
      EXPECT_NE(d.points[part.begin], d.points[part.begin - 1]);
    }
  });
}

TEST(Divide, FillsLeavesWhereAsked) {
  const auto leaf_sizes = [](bool fill) {
    std::vector<std::size_t> sizes;
    const Divided d = divided(random_points(400'000, 1'000'000),
                              {.leaf_points = 20'000, .stop = {}, .fill_leaves = fill});
    visit(d.root, [&](const Part<2>& part) {
      if (part.leaf()) sizes.push_back(part.size());
    });
    return sizes;
  };
  EXPECT_EQ(leaf_sizes(false).size(), 32U);
  const std::vector<std::size_t> filled = leaf_sizes(true);
  EXPECT_LE(filled.size(), 23U);
  for (const std::size_t size : filled) EXPECT_LE(size, 20'000U);
}

TEST(Divide, CutsPointsOfWhichNearlyAllAreEqual) {
  std::vector<Point<2>> points(100'000, {3, 4});
  points[50'000] = {5, 4};
  points[70'000] = {1, 4};
  const Divided d = divided(points, {.leaf_points = 10});
  std::vector<std::size_t> sizes;
  visit(d.root, [&](const Part<2>& part) {
    if (part.leaf()) sizes.push_back(part.size());
  });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 99'998, 1}));
}

TEST(Divide, StopsAtPointsThatAreAllEqual) {
  const Divided d = divided(std::vector<Point<2>>(1000, {3, 4}), {.leaf_points = 10});
  EXPECT_TRUE(d.root.leaf());
  EXPECT_EQ(d.root.size(), 1000U);
}

TEST(Divide, HandlesNoPoints) {
  const Divided d = divided({}, {.leaf_points = 10});
  EXPECT_TRUE(d.root.leaf());
  EXPECT_TRUE(d.root.box.empty());
}

TEST(Divide, CutsTheAxisThatTheSchemeSays) {
  std::vector<Point<2>> wide(1000);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    wide[i] = {static_cast<double>(i % 25), static_cast<double>(i)};
  }
  const auto first_cut_axis = [&](Division scheme) {
    const Divided d = divided(wide, {.leaf_points = 600, .scheme = scheme});
    return d.root.children[0].box.hi[0] < d.root.children[1].box.lo[0] ? 0 : 1;
  };
  EXPECT_EQ(first_cut_axis(Division::kLongestExtent), 1);
  EXPECT_EQ(first_cut_axis(Division::kCyclingAxis), 0);
  EXPECT_EQ(first_cut_axis(Division::kConstantAxis), 0);
}

TEST(Divide, CutsAnotherAxisWhereTheSchemesHasNoExtent) {
  std::vector<Point<2>> column(100);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = {7, static_cast<double>(i)};
  const Divided d = divided(column, {.leaf_points = 10, .scheme = Division::kConstantAxis});
  EXPECT_FALSE(d.root.leaf());
}

TEST(Divide, BalancesAGridWhoseRowsHaveTheSamplesPeriod) {
  std::vector<Point<2>> grid;
  for (int y = 0; y < 1024; ++y) {
    for (int x = 0; x < 512; ++x) grid.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
  const Divided d = divided(
      grid, {.leaf_points = grid.size() / 2 + grid.size() / 10, .scheme = Division::kConstantAxis});
  ASSERT_EQ(d.root.children.size(), 2U);
  EXPECT_NEAR(static_cast<double>(d.root.children[0].size()), grid.size() / 2.0, grid.size() * 0.1);
}

TEST(Divide, DoesNotDependOnTheNumberOfThreads) {
  const auto points = random_points(200'000, 1'000'000);
  const Divided one = divided(points, {.leaf_points = 1000}, 1);
  const Divided four = divided(points, {.leaf_points = 1000}, 4);
  EXPECT_EQ(one.input_index, four.input_index);
}

/// The axis on which two parts lie apart, the first one lower; -1 if there is none.
template <int D>
int axis_between(const Part<D>& low, const Part<D>& high) {
  for (int k = 0; k < D; ++k) {
    if (low.box.hi[k] < high.box.lo[k]) return k;
  }
  return -1;
}

template <typename Dimension>
class DivideCuts : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DivideCuts, Dimensions);

/// So many points whose first coordinate is 0, 1, ..., the others random, in any order.
template <int D>
std::vector<Point<D>> runs(const std::vector<std::size_t>& counts) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<D>> points;
  for (std::size_t x = 0; x < counts.size(); ++x) {
    for (std::size_t i = 0; i < counts[x]; ++i) {
      Point<D>& p = points.emplace_back();
      for (double& c : p) c = coordinate(random);
      p[0] = static_cast<double>(x);
    }
  }
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

TYPED_TEST(DivideCuts, LieBelowARunOfEqualCoordinatesOrAboveItIfThatIsTheLowest) {
  constexpr int kD = TypeParam::value;
  const auto halves = [](const std::vector<std::size_t>& counts) {
    const auto points = runs<kD>(counts);
    const auto d = divided_points<kD>(
        points, {.leaf_points = points.size() - 1, .scheme = Division::kConstantAxis});
    EXPECT_EQ(d.root.children.size(), 2U);
    EXPECT_EQ(axis_between(d.root.children[0], d.root.children[1]), 0);
    return std::pair(d.root.children[0].size(), d.root.children[1].size());
  };
  using Halves = std::pair<std::size_t, std::size_t>;
  for (const std::size_t scale : {1, 30, 400}) {  // a sample of all, of some and of few
    EXPECT_EQ(halves({20 * scale, 60 * scale, 20 * scale}), Halves(20 * scale, 80 * scale));
    EXPECT_EQ(halves({60 * scale, 20 * scale, 20 * scale}), Halves(60 * scale, 40 * scale));
    EXPECT_EQ(halves({20 * scale, 20 * scale, 60 * scale}), Halves(40 * scale, 60 * scale));
  }
  EXPECT_EQ(halves({1, 100}), Halves(1, 100));
}

TYPED_TEST(DivideCuts, GoAcrossAnotherAxisWhereAllPointsAreEqualOnOne) {
  constexpr int kD = TypeParam::value;
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> coordinate(0, 1);
  for (const Division scheme : {Division::kLeastBorder, Division::kLongestExtent,
                                Division::kCyclingAxis, Division::kConstantAxis}) {
    for (int equal = 0; equal < kD; ++equal) {
      std::vector<Point<kD>> points(300);
      for (Point<kD>& p : points) {
        for (double& c : p) c = coordinate(random);
        p[equal] = 7;
      }
      const auto d = divided_points<kD>(points, {.leaf_points = 20, .scheme = scheme});
      visit(d.root, [&](const Part<kD>& part) {
        EXPECT_EQ(part.leaf(), part.size() <= 20);
        if (part.leaf()) return;
        const int axis = axis_between(part.children[0], part.children[1]);
        EXPECT_NE(axis, equal);
        EXPECT_NE(axis, -1);
      });
    }
  }
}

TYPED_TEST(DivideCuts, NeverPartEqualPointsHoweverTheyAreFound) {
  constexpr int kD = TypeParam::value;
  std::mt19937_64 random(4);
  for (const unsigned children : {2, 3}) {
    for (const bool fill : {false, true}) {
      std::vector<Point<kD>> points(3000);  // on the sides of a cube, so that cuts are judged
      for (Point<kD>& p : points) {
        for (double& c : p) c = static_cast<double>(random() % 8);
        p[random() % kD] = random() % 2 == 0 ? 0 : 7;
      }
      const auto d = divided_points<kD>(
          points,
          {.leaf_points = 40, .children = children, .fill_leaves = fill, .smallest_judged = 50});
      std::set<Point<kD>> seen;
      visit(d.root, [&](const Part<kD>& part) {
        if (!part.leaf()) return;
        std::set<Point<kD>> here(d.points.begin() + part.begin, d.points.begin() + part.end);
        for (const Point<kD>& p : here) EXPECT_TRUE(seen.insert(p).second);
      });
      EXPECT_EQ(seen, std::set<Point<kD>>(points.begin(), points.end()));
    }
  }
}

/// Two clusters, of which the left one has 42 points of a hundred: the middle lies in the other.
template <int D>
std::vector<Point<D>> two_clusters() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<D>> points(5000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (double& c : points[i]) c = coordinate(random);
    if (i % 100 >= 42) points[i][0] += 9;
  }
  return points;
}

TYPED_TEST(DivideCuts, AreMovedToWhereFewSimplicesCross) {
  constexpr int kD = TypeParam::value;
  const auto below = [](DivideOptions options) {
    options.leaf_points = 4999;
    const auto d = divided_points<kD>(two_clusters<kD>(), options);
    EXPECT_EQ(axis_between(d.root.children[0], d.root.children[1]), 0);
    return d.root.children[0].size();
  };
  EXPECT_NEAR(static_cast<double>(below({.smallest_judged = 5000})), 2100, 100) << "by a sample";
  EXPECT_NEAR(static_cast<double>(below({.smallest_judged = 5001})), 2500, 150) << "not judged";
  EXPECT_NEAR(static_cast<double>(below({.scheme = Division::kLongestExtent})), 2500, 150);
  EXPECT_NEAR(static_cast<double>(below({.children = 4, .smallest_judged = 1000})), 1250, 150)
      << "parts of one size";
}

/// Two sheets that lie a little farther apart than they are long.
template <int D>
std::vector<Point<D>> two_sheets() {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> coordinate(0, 8);
  std::vector<Point<D>> points(4000);
  for (Point<D>& p : points) {
    for (double& c : p) c = coordinate(random);
    p[D - 1] = p[D - 1] * 0.001 + (random() % 2 == 0 ? 0 : 9);
  }
  return points;
}

TYPED_TEST(DivideCuts, GoAcrossAShorterAxisWhereFewerSimplicesCross) {
  constexpr int kD = TypeParam::value;
  const auto cut_axis = [](DivideOptions options) {
    options.leaf_points = 3999;
    const auto d = divided_points<kD>(two_sheets<kD>(), options);
    for (const Part<kD>& part : d.root.children) {
      EXPECT_NEAR(static_cast<double>(part.size()), 4000.0 / options.children, 600);
    }
    return axis_between(d.root.children[0], d.root.children[1]);
  };
  EXPECT_LT(cut_axis({.smallest_judged = 4000}), kD - 1);
  EXPECT_LT(cut_axis({.fill_leaves = true, .smallest_judged = 4000}), kD - 1);
  EXPECT_EQ(cut_axis({.smallest_judged = 4001}), kD - 1) << "not judged";
  EXPECT_EQ(cut_axis({.scheme = Division::kLongestExtent, .smallest_judged = 4000}), kD - 1);
}

TYPED_TEST(DivideCuts, ArePutOffOnlyForWhatIsHollowAndNotTooLarge) {
  constexpr int kD = TypeParam::value;
  const auto is_whole = [](const std::vector<Point<kD>>& points, std::size_t largest) {
    return divided_points<kD>(
               points, {.leaf_points = 1000, .smallest_judged = 1000, .largest_undivided = largest})
        .root.leaf();
  };
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<kD>> crossed(4000);  // two skew lines: every simplex may go from one to another
  for (Point<kD>& p : crossed) {
    const double t = coordinate(random);
    p.fill(0.5);
    p[0] = t;
    p[1] = random() % 2 == 0 ? t : 1 - t + 0.1;
    if (kD == 3) p[2] = p[1] == t ? 0 : 1;
  }
  EXPECT_TRUE(is_whole(crossed, 4000));
  EXPECT_FALSE(is_whole(crossed, 3999));
  std::vector<Point<kD>> even(4000);
  for (Point<kD>& p : even) {
    for (double& c : p) c = coordinate(random);
  }
  EXPECT_FALSE(is_whole(even, 4000));
}

}  // namespace
}  // namespace spillway::test
