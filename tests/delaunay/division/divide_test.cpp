#include "src/delaunay/division/divide.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "src/delaunay/common/schedule.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

struct Divided {
  std::vector<Point<2>> original;
  std::vector<Point<2>> points;
  std::vector<VertexId> input_index;
  Part<2> root;
};

Divided divided(std::vector<Point<2>> points, const DivideOptions& options, unsigned threads = 1) {
  Divided d{points, points, std::vector<VertexId>(points.size()), {}};
  std::iota(d.input_index.begin(), d.input_index.end(), VertexId{0});
  with_threads(threads, [&] { d.root = divide<2>(d.points, d.input_index, options); });
  return d;
}

std::vector<Point<2>> random_points(std::size_t n, std::uint64_t distinct) {
  std::mt19937_64 random(n);
  std::vector<Point<2>> points(n);
  for (auto& p : points) {
    p = {static_cast<double>(random() % distinct), static_cast<double>(random() % distinct)};
  }
  return points;
}

template <typename F>
void visit(const Part<2>& part, const F& f) {
  f(part);
  for (const Part<2>& child : part.children) visit(child, f);
}

TEST(Divide, KeepsEveryPointAndItsIndex) {
  const Divided d = divided(random_points(5000, 1000), {.leaf_size = 50});
  std::vector<bool> seen(d.points.size());
  for (std::size_t i = 0; i < d.points.size(); ++i) {
    EXPECT_EQ(d.points[i], d.original[d.input_index[i]]);
    EXPECT_FALSE(seen[d.input_index[i]]);
    seen[d.input_index[i]] = true;
  }
}

TEST(Divide, MakesDisjointTightBoxesAndSmallLeaves) {
  const Divided d = divided(random_points(5000, 1000), {.leaf_size = 50, .children = 3});
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
  const Divided d = divided(random_points(3000, 5), {.leaf_size = 10});
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
                              {.leaf_size = 20'000, .stop = {}, .fill_leaves = fill});
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
  const Divided d = divided(points, {.leaf_size = 10});
  std::vector<std::size_t> sizes;
  visit(d.root, [&](const Part<2>& part) {
    if (part.leaf()) sizes.push_back(part.size());
  });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 99'998, 1}));
}

TEST(Divide, StopsAtPointsThatAreAllEqual) {
  const Divided d = divided(std::vector<Point<2>>(1000, {3, 4}), {.leaf_size = 10});
  EXPECT_TRUE(d.root.leaf());
  EXPECT_EQ(d.root.size(), 1000U);
}

TEST(Divide, HandlesNoPoints) {
  const Divided d = divided({}, {.leaf_size = 10});
  EXPECT_TRUE(d.root.leaf());
  EXPECT_TRUE(d.root.box.empty());
}

TEST(Divide, CutsTheAxisThatTheSchemeSays) {
  std::vector<Point<2>> wide(1000);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    wide[i] = {static_cast<double>(i % 25), static_cast<double>(i)};
  }
  const auto first_cut_axis = [&](Division scheme) {
    const Divided d = divided(wide, {.leaf_size = 600, .scheme = scheme});
    return d.root.children[0].box.hi[0] < d.root.children[1].box.lo[0] ? 0 : 1;
  };
  EXPECT_EQ(first_cut_axis(Division::kLongestExtent), 1);
  EXPECT_EQ(first_cut_axis(Division::kCyclingAxis), 0);
  EXPECT_EQ(first_cut_axis(Division::kConstantAxis), 0);
}

TEST(Divide, CutsAnotherAxisWhereTheSchemesHasNoExtent) {
  std::vector<Point<2>> column(100);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = {7, static_cast<double>(i)};
  const Divided d = divided(column, {.leaf_size = 10, .scheme = Division::kConstantAxis});
  EXPECT_FALSE(d.root.leaf());
}

TEST(Divide, BalancesAGridWhoseRowsHaveTheSamplesPeriod) {
  std::vector<Point<2>> grid;
  for (int y = 0; y < 1024; ++y) {
    for (int x = 0; x < 512; ++x) grid.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
  const Divided d = divided(
      grid, {.leaf_size = grid.size() / 2 + grid.size() / 10, .scheme = Division::kConstantAxis});
  ASSERT_EQ(d.root.children.size(), 2U);
  EXPECT_NEAR(static_cast<double>(d.root.children[0].size()), grid.size() / 2.0, grid.size() * 0.1);
}

TEST(Divide, DoesNotDependOnTheNumberOfThreads) {
  const auto points = random_points(200'000, 1'000'000);
  const Divided one = divided(points, {.leaf_size = 1000}, 1);
  const Divided four = divided(points, {.leaf_size = 1000}, 4);
  EXPECT_EQ(one.input_index, four.input_index);
}

}  // namespace
}  // namespace spillway::detail
