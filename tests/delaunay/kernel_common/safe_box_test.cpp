// What the own kernels say about circumspheres inside a safe box, against rational arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "src/delaunay/base_case/base_case.h"
#include "src/parallel/parallel.h"
#include "tests/delaunay/kernel_sets.h"
#include "tests/generators/family_cases.h"
#include "tests/geometry/exact_sphere.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

template <int D>
using Points = std::vector<Point<D>>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Count {
  std::size_t claimed = 0;  ///< to be inside
  std::size_t inside = 0;
};

/// The base case of the points, which is asked about the safe box.
template <int D>
BaseCase<D> asked(const Points<D>& points, const Box<D>& safe_box,
                  Kernel kernel = Kernel::kSpillway, bool corners_only = false) {
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  return triangulate_base_case<D>({.points = points,
                                   .input_index = index,
                                   .safe_box = safe_box,
                                   .corners_only = corners_only,
                                   .kernel = kernel});
}

/// Expects that nothing is claimed that is not true; every `step`-th simplex is looked at.
template <int D>
Count expect_true_claims(const Points<D>& points, const Box<D>& safe_box, std::size_t step = 1,
                         Kernel kernel = Kernel::kSpillway) {
  const BaseCase<D> base_case = asked<D>(points, safe_box, kernel);
  Count count;
  if (base_case.dimension < D) return count;
  std::vector<bool> not_inside(base_case.simplices.size());
  EXPECT_TRUE(base_case.not_inside.has_value());
  for (const std::uint32_t s : base_case.not_inside.value()) not_inside.at(s) = true;
  for (std::size_t s = 0; s < not_inside.size(); s += step) {
    const Simplex<D>& simplex = base_case.simplices[s];
    const bool claimed = !not_inside[s];
    if (simplex.infinite()) {
      EXPECT_FALSE(claimed);
      continue;
    }
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = points[simplex.vertices[i]];
    const bool inside = ExactSphere<D>(corners).inside(safe_box);
    count.inside += inside ? 1 : 0;
    count.claimed += claimed ? 1 : 0;
    EXPECT_TRUE(inside || !claimed);
  }
  return count;
}

/// Some of the box of the points, or more; some sides are infinite, some at a point.
template <int D>
Box<D> random_safe_box(const Points<D>& points, Random& random) {
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  Box<D> safe_box = box;
  for (int k = 0; k < D; ++k) {
    const auto side = [&](double from, double to) {
      switch (random.integer(0, 4)) {
        case 0:
          return to > from ? -kInfinity : kInfinity;
        case 1:
          return points[random.integer(0, static_cast<std::int64_t>(points.size()) - 1)][k];
        default:
          return from + (to - from) * random.uniform(-0.3, 0.4);
      }
    };
    safe_box.lo[k] = side(box.lo[k], box.hi[k]);
    safe_box.hi[k] = side(box.hi[k], box.lo[k]);
  }
  return safe_box;
}

template <typename Dimension>
class KernelSafeBox : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(KernelSafeBox, Dimensions);

/// The sorted corners of the simplices that a base case lists.
template <int D>
std::vector<std::array<VertexId, D + 1>> sorted_corners(const BaseCase<D>& base_case) {
  std::vector<std::array<VertexId, D + 1>> all(base_case.corners.begin(), base_case.corners.end());
  for (auto& corners : all) std::ranges::sort(corners);
  std::ranges::sort(all);
  return all;
}

/// Whichever kernel makes a base case, its caller gets the same lists.
TYPED_TEST(KernelSafeBox, CgalsBaseCaseAnswersLikeTheOwnOne) {
  constexpr int D = TypeParam::value;
  Random random(43);
  for (const FamilyCase& tested : all_family_cases()) {
    if (tested.dimension != D) continue;
    SCOPED_TRACE(family_names()[static_cast<std::size_t>(tested.family)]);
    const Points<D> points =
        generated_points<D>({.family = tested.family, .count = 150, .dimension = D, .seed = 6});
    const Box<D> safe_box = random_safe_box<D>(points, random);
    expect_true_claims<D>(points, safe_box, 2, Kernel::kCgal);
    const BaseCase<D> own = asked<D>(points, safe_box, Kernel::kSpillway, true);
    const BaseCase<D> cgal = asked<D>(points, safe_box, Kernel::kCgal, true);
    EXPECT_EQ(cgal.dimension, own.dimension);
    EXPECT_EQ(cgal.not_inside.has_value(), own.not_inside.has_value());
    EXPECT_EQ(sorted_corners<D>(cgal), sorted_corners<D>(own));
  }
}

TYPED_TEST(KernelSafeBox, ClaimsOnlyWhatIsTrueOfAllFamilies) {
  constexpr int D = TypeParam::value;
  Random random(41);
  for (const FamilyCase& tested : all_family_cases()) {
    if (tested.dimension != D) continue;
    SCOPED_TRACE(family_names()[static_cast<std::size_t>(tested.family)]);
    const Points<D> points =
        generated_points<D>({.family = tested.family, .count = 200, .dimension = D, .seed = 5});
    for (int trial = 0; trial < 3; ++trial) {
      expect_true_claims<D>(points, random_safe_box<D>(points, random), 3);
    }
  }
}

TYPED_TEST(KernelSafeBox, ClaimsOnlyWhatIsTrueOfSmallHardSets) {
  constexpr int D = TypeParam::value;
  Random random(42);
  std::size_t claims = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const Points<D> points = hard_set<D>(seed);
    if (points.empty()) continue;
    const Box<D> safe_box = random_safe_box<D>(points, random);
    if (asked<D>(points, safe_box).dimension < D) continue;
    claims += expect_true_claims<D>(points, safe_box).claimed;
  }
  EXPECT_GT(claims, 300U);
}

TYPED_TEST(KernelSafeBox, ClaimsOnlyWhatIsTrueOfTouchingSpheres) {
  constexpr int D = TypeParam::value;
  // Cubes of the unit lattice: their spheres come within half a diagonal and half an edge of a
  // corner, and many cells share each of them.
  Points<D> points;
  for (int i = 0; i < (D == 2 ? 36 : 216); ++i) {
    Point<D>& p = points.emplace_back();
    int rest = i;
    for (double& c : p) c = std::exchange(rest, rest / 6) % 6;
  }
  const double reach = std::sqrt(D / 4.0) - 0.5;
  for (const double scale : {1.0, 0.1, 0x1p-1060, 0x1p900}) {
    Points<D> scaled = points;
    for (Point<D>& p : scaled) {
      for (double& c : p) c *= scale;
    }
    for (const double room : {-1e-9, -1e-15, 0.0, 1e-15, 1e-9}) {
      Box<D> safe_box;
      safe_box.lo.fill((1 - reach - room) * scale);
      safe_box.hi.fill((4 + reach + room) * scale);
      const Count count = expect_true_claims<D>(scaled, safe_box, D == 2 ? 1 : 5);
      if (scale == 1 && room == 1e-9) {
        EXPECT_GT(count.claimed, 0U);
      }
    }
  }
}

TYPED_TEST(KernelSafeBox, ClaimsNearlyAllThatIsTrueOfScatteredPoints) {
  constexpr int D = TypeParam::value;
  Points<D> points =
      generated_points<D>({.family = Family::kUniform, .count = 2000, .dimension = D, .seed = 6});
  for (const double offset : {0.0, 1e6}) {
    for (Point<D>& p : points) p[1] += offset;
    Box<D> box;
    for (const Point<D>& p : points) box.expand(p);
    Box<D> safe_box = box;
    for (int k = 0; k < D; ++k) safe_box.hi[k] -= 0.2 * box.extent(k);
    safe_box.lo[0] = -kInfinity;
    const Count count = expect_true_claims<D>(points, safe_box, 3);
    EXPECT_GT(count.inside, 300U);
    EXPECT_GE(static_cast<double>(count.claimed), 0.999 * static_cast<double>(count.inside));
  }
}

TYPED_TEST(KernelSafeBox, ListsTheSameInPlaceAndApartWithOneAndWithSeveralThreads) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kCount = D == 2 ? 50'000 : 15'001;  // simplices for several ranges
  Points<D> points =
      generated_points<D>({.family = Family::kUniform, .count = kCount, .dimension = D, .seed = 8});
  for (const std::size_t repeated : {0, 100}) {
    points.insert(points.end(), points.begin(), points.begin() + repeated);
    std::vector<VertexId> index(points.size());
    std::iota(index.begin(), index.end(), VertexId{0});
    Box<D> safe_box;
    for (const Point<D>& p : points) safe_box.expand(p);
    safe_box.hi[0] = (safe_box.lo[0] + safe_box.hi[0]) / 2;
    const auto listed = [&](unsigned threads, bool in_place, bool corners_only = false) {
      BaseCase<D> base_case;
      with_threads(threads, [&] {
        base_case = triangulate_base_case<D>({.points = points,
                                              .input_index = index,
                                              .safe_box = safe_box,
                                              .in_place = in_place,
                                              .corners_only = corners_only});
      });
      return base_case;
    };
    const BaseCase<D> expected = listed(1, false);
    EXPECT_EQ(expected.duplicates.size(), repeated);
    for (const bool in_place : {false, true}) {
      const BaseCase<D> found = listed(4, in_place);
      EXPECT_TRUE(std::equal(found.simplices.begin(), found.simplices.end(),
                             expected.simplices.begin(), expected.simplices.end(),
                             [](const Simplex<D>& a, const Simplex<D>& b) {
                               return a.vertices == b.vertices && a.neighbours == b.neighbours;
                             }));
      EXPECT_EQ(found.hull, expected.hull);
      EXPECT_EQ(found.not_inside, expected.not_inside);
      EXPECT_TRUE(found.corners.empty());
      EXPECT_TRUE(found.open_simplices.empty());
    }
    const auto expect_same_corners = [&](unsigned threads, const BaseCase<D>& full) {
      const BaseCase<D> found = listed(threads, true, true);
      EXPECT_TRUE(found.simplices.empty());
      EXPECT_TRUE(std::equal(
          found.corners.begin(), found.corners.end(), full.simplices.begin(), full.simplices.end(),
          [](const auto& corners, const Simplex<D>& b) { return corners == b.vertices; }));
      EXPECT_EQ(found.hull, full.hull);
      EXPECT_EQ(found.not_inside, full.not_inside);
      return found.open_simplices;
    };
    for (const unsigned threads : {1, 4}) {
      EXPECT_TRUE(expect_same_corners(threads, expected).empty()) << "too many to be listed";
    }
    safe_box.lo.fill(-kInfinity);
    safe_box.hi.fill(kInfinity);
    const BaseCase<D> wide = listed(1, false);
    for (const unsigned threads : {1, 4}) {
      const std::vector<Simplex<D>> open = expect_same_corners(threads, wide);
      ASSERT_EQ(open.size(), wide.not_inside->size());
      for (std::size_t i = 0; i < open.size(); ++i) {
        const Simplex<D>& simplex = wide.simplices[wide.not_inside->at(i)];
        ASSERT_EQ(open[i].vertices, simplex.vertices);
        ASSERT_EQ(open[i].neighbours, simplex.neighbours);
      }
    }
  }
}

TYPED_TEST(KernelSafeBox, SaysNothingUnasked) {
  constexpr int D = TypeParam::value;
  const Points<D> points =
      generated_points<D>({.family = Family::kUniform, .count = 50, .dimension = D, .seed = 7});
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  EXPECT_FALSE(
      triangulate_base_case<D>({.points = points, .input_index = index}).not_inside.has_value());
}

}  // namespace
}  // namespace spillway::test
