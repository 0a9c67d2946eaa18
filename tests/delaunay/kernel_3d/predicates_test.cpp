// Each stage of the 3D kernel's predicates against the exact one, on quintuples that are nearly
// degenerate.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "src/delaunay/kernel_3d/exact_predicates.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_3d/star_spheres.h"
#include "src/delaunay/kernel_3d/ties_by_lanes.h"
#include "src/generators/random.h"
#include "src/geometry/predicates.h"

namespace spillway::delaunay::kernel_3d {

using namespace test;  // NOLINT(google-build-using-namespace): what tests share
namespace {

using FivePoints = std::array<Point<3>, 5>;
constexpr Five kFive{{ref(1), ref(2), ref(3), ref(4)}, ref(5)};
constexpr int kRuns = 20'000;

/// Five points near one sphere, the first four positively oriented, rounded to multiples of 2^-bits
/// of the radius: the fewer bits, the more ties.
FivePoints near_sphere(Random& random, int bits) {
  for (;;) {
    FivePoints points;
    const double spread = std::ldexp(1.0, -static_cast<int>(random.below(12)));
    const double start = random.uniform() * 6;
    for (Point<3>& p : points) {
      const double angle = start + random.uniform() * 6 * spread;
      const double height = start / 2 + random.uniform() * 3 * spread;
      p = {std::cos(angle) * std::sin(height), std::sin(angle) * std::sin(height),
           std::cos(height)};
      for (double& c : p) c = std::ldexp(std::round(std::ldexp(c, bits)), -bits);
    }
    const int side =
        spillway::geometry::orientation<3>({points[0], points[1], points[2], points[3]});
    if (side < 0) std::swap(points[2], points[3]);
    if (side != 0) return points;
  }
}

int exact_side(const FivePoints& p) {
  return stages::exact<stages::InSphere<3>>({p[0], p[1], p[2], p[3], p[4]});
}

/// Points and, if asked, the cell of the first four with its cached sphere.
struct Scene {
  explicit Scene(const FivePoints& five) : points(make_working_points(five, memory)) {}

  /// The answer of the test with the fifth point goes to `inside`, if it is certain.
  template <int kLanes, bool kHasOrderKeys>
  Cell cell(std::optional<bool>* inside = nullptr) const {
    std::array<Cell, 8> cells{};
    std::array<Handle, 8> handles{};
    for (std::uint32_t k = 0; k < 4; ++k) cells[0].vertices[k] = ref(1 + k);
    const StarView star{.coordinates = points.coordinates,
                        .largest = points.largest,
                        .cells = CellArray(cells.data()),
                        .handles = handles.data(),
                        .query = points.at(ref(1)),
                        .next = points.at(ref(5))};
    Corners<kLanes> corners;
    gather_corners<kLanes>(star, 0, corners);
    Integers<kLanes> certain = ~Integers<kLanes>{};
    const std::uint32_t answer = make_spheres<kLanes, kHasOrderKeys>(star, 0, corners, certain);
    if (inside != nullptr && certain[0] != 0) *inside = (answer & 1) != 0;
    return cells[0];
  }

  double power(const Cell& cell) const {
    const double* q = points.at(ref(5));
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (q[k] - cell.centre[k]) * (q[k] - cell.centre[k]);
    return sum - cell.squared_radius;
  }

  Slab memory;
  WorkingPoints points;
};

TEST(Kernel3dPredicates, CachedSpheresAreRightWhereTheyAnswer) {
  Random random(1);
  int answers = 0;
  int near_misses = 0;
  for (int run = 0; run < 5 * kRuns; ++run) {
    const FivePoints five = near_sphere(random, 3 + static_cast<int>(random.below(50)));
    const Scene scene(five);
    std::optional<bool> inside;
    const Cell cell = scene.cell<4, false>(&inside);
    const double s = scene.power(cell);
    const double tolerance = tolerance_of(cell.squared_radius);
    const int exact = exact_side(five);
    ASSERT_EQ(inside.has_value(), std::abs(s) > tolerance);
    if (inside) {
      ASSERT_EQ(*inside ? 1 : -1, exact);
      ++answers;
      near_misses += std::abs(s) < 64 * tolerance ? 1 : 0;
    }
    const Cell narrow = scene.cell<2, false>();
    ASSERT_EQ(std::memcmp(&cell, &narrow, sizeof cell), 0);
  }
  EXPECT_GT(answers, kRuns);
  EXPECT_GT(near_misses, 100);
}

TEST(Kernel3dPredicates, NotedTiesAreTies) {
  Random random(2);
  int ties = 0;
  for (int run = 0; run < 5 * kRuns; ++run) {
    const FivePoints five = near_sphere(random, 1 + static_cast<int>(random.below(9)));
    const Scene scene(five);
    ASSERT_TRUE(scene.points.has_order_keys);
    const Cell cell = scene.cell<4, true>();
    const double s = scene.power(cell);
    if (!(std::abs(s) <= tolerance_of(cell.squared_radius))) {
      if (s == s) {
        ASSERT_EQ(s < 0 ? 1 : -1, exact_side(five));
      }
      continue;
    }
    const auto notes = std::bit_cast<std::uint64_t>(cell.squared_radius);
    if ((notes & kTieNote) == 0) continue;
    ASSERT_EQ(exact_side(five), 0);
    const auto largest = std::max_element(five.begin(), five.begin() + 4) - five.begin();
    ASSERT_EQ(five[notes >> kLargestShift & 3], five[static_cast<std::size_t>(largest)]);
    ++ties;
  }
  EXPECT_GT(ties, 100);
}

TEST(Kernel3dPredicates, VolumesOnTinyLatticesAreExact) {
  Random random(7);
  int flat = 0;
  for (int run = 0; run < kRuns; ++run) {
    // The largest lattice that is tiny, or a small one with many coplanar points.
    const std::uint64_t places = run % 2 == 0 ? 100'000 : 3;
    std::array<std::array<double, 4>, 4> records;
    for (auto& record : records) {
      for (double& c : record) c = static_cast<double>(random.below(places));
      if (places > 3 && random.below(2) == 0) record[random.below(3)] = 99'999;
    }
    std::array<std::array<std::int64_t, 3>, 3> d;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        d[i][k] = static_cast<std::int64_t>(records[i + 1][k] - records[0][k]);
      }
    }
    const std::int64_t exact = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                               d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    ASSERT_EQ(volume(records[0].data(), records[1].data(), records[2].data(), records[3].data()),
              static_cast<double>(exact));
    flat += exact == 0 ? 1 : 0;
  }
  EXPECT_GT(flat, 100);
}

TEST(Kernel3dPredicates, InSphereStagesAreRightWhereTheyAnswer) {
  Random random(3);
  int filtered = 0;
  int corrected = 0;
  int narrow = 0;
  int wide = 0;
  for (int run = 0; run < kRuns; ++run) {
    FivePoints five = near_sphere(random, 2 + static_cast<int>(random.below(51)));
    if (random.below(4) == 0) {
      // Coordinates of very different size: more bits than one limb has.
      for (Point<3>& p : five) p[1] = std::ldexp(p[1], -30);
      if (spillway::geometry::orientation<3>({five[0], five[1], five[2], five[3]}) <= 0) continue;
    }
    const Scene scene(five);
    const int exact = exact_side(five);
    if (const auto side = in_sphere_filtered(scene.points, kFive)) {
      ASSERT_EQ(*side, exact);
      ++filtered;
    }
    if (const auto side = in_sphere_integer<1>(scene.points, kFive)) {
      ASSERT_EQ(*side, exact);
      ++narrow;
    } else {
      ++wide;
    }
    if (const auto side = in_sphere_integer<2>(scene.points, kFive)) {
      ASSERT_EQ(*side, exact);
    }
    const Cell cell = scene.cell<2, false>();
    if (const auto side = in_sphere_corrected(scene.points, kFive, cell.centre)) {
      ASSERT_EQ(*side, exact);
      corrected += in_sphere_filtered(scene.points, kFive) ? 0 : 1;
    }
    ASSERT_EQ(side_of_sphere(scene.points, kFive, cell.centre), exact);
  }
  EXPECT_GT(filtered, 1'000);
  EXPECT_GT(corrected, 500);
  EXPECT_GT(narrow, 1'000);
  EXPECT_GT(wide, 1'000);
}

TEST(Kernel3dPredicates, WhateverSphereCorrectsTheSignIsRight) {
  Random random(6);
  int answers = 0;
  for (int run = 0; run < 2 * kRuns; ++run) {
    const FivePoints five = near_sphere(random, 20 + static_cast<int>(random.below(33)));
    const Scene scene(five);
    Cell cell = scene.cell<2, false>();
    // Some roundings off, a part of the radius off, or anywhere.
    const double shift = std::ldexp(1.0, -static_cast<int>(random.below(60)));
    for (double& c : cell.centre) c += (random.uniform() - 0.5) * shift;
    cell.squared_radius *= 1 + (random.uniform() - 0.5) * shift;
    if (const auto side = in_sphere_corrected(scene.points, kFive, cell.centre)) {
      ASSERT_EQ(*side, exact_side(five));
      ++answers;
    }
  }
  EXPECT_GT(answers, kRuns / 2);
  const Scene flat(near_sphere(random, 52));
  const std::array<double, 4> none{0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(in_sphere_corrected(flat.points, kFive, none.data()), std::nullopt);
}

TEST(Kernel3dPredicates, RootsAreBoundedFromAbove) {
  Random random(7);
  for (int run = 0; run < kRuns; ++run) {
    const double number =
        std::ldexp(1 + random.uniform(), static_cast<int>(random.below(1600)) - 800);
    Reals<2> root;
    root_bound<2>(Reals<2>{number, std::exp2(std::round(std::log2(number)))}, root);
    EXPECT_GE(root[0], std::sqrt(number));
    EXPECT_LE(root[0], 1.07 * std::sqrt(number));
    EXPECT_GE(root[1], std::sqrt(std::exp2(std::round(std::log2(number)))));
  }
}

TEST(Kernel3dPredicates, OrientationStagesAreRightWhereTheyAnswer) {
  Random random(4);
  int ties = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto uniform = [&random] {
      return Point<3>{random.uniform(), random.uniform(), random.uniform()};
    };
    FivePoints five{uniform(), uniform(), uniform(), uniform(), uniform()};
    // The fourth in the plane of the first three, or nearly.
    const double s = random.uniform();
    const double t = random.uniform();
    for (int k = 0; k < 3; ++k) {
      five[3][k] = five[0][k] + s * (five[1][k] - five[0][k]) + t * (five[2][k] - five[0][k]);
    }
    if (random.below(2) == 0) {
      const int bits = 2 + static_cast<int>(random.below(5));
      for (Point<3>& p : five) {
        for (double& c : p) c = std::ldexp(std::round(std::ldexp(c, bits)), -bits);
      }
    }
    if (five[0] == five[1]) continue;
    const Scene scene(five);
    const std::array<VertexRef, 4> p{ref(1), ref(2), ref(3), ref(4)};
    const int exact = stages::exact<stages::Orientation<3>>({five[0], five[1], five[2], five[3]});
    if (const auto side = orientation_filtered(scene.points, p)) {
      ASSERT_EQ(*side, exact);
    }
    if (const auto side = orientation_integer<1>(scene.points, p)) {
      ASSERT_EQ(*side, exact);
    }
    if (const auto side = orientation_integer<2>(scene.points, p)) {
      ASSERT_EQ(*side, exact);
    }
    ASSERT_EQ(orientation(scene.points, p), exact);
    ties += exact == 0 ? 1 : 0;
  }
  EXPECT_GT(ties, 100);
}

TEST(Kernel3dPredicates, TieRuleIsThatOfInSphere) {
  Random random(5);
  int ties = 0;
  for (int run = 0; run < 5 * kRuns; ++run) {
    const FivePoints five = near_sphere(random, 1 + static_cast<int>(random.below(3)));
    const auto& [a, b, c, d, query] = five;
    if (exact_side(five) != 0 || query == a || query == b || query == c || query == d) continue;
    const Scene scene(five);
    ASSERT_EQ(tie_conflicts(scene.points, kFive), in_sphere<3>({a, b, c, d}, query) > 0);
    ++ties;
  }
  EXPECT_GT(ties, 500);
}

TEST(Kernel3dPredicates, LimbsHoldTheLargestDifferences) {
  // Opposite corners of the largest cubes that fit: nothing may overflow.
  const FivePoints corners{
      {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, 1, 1 - 0x1p-53}}};
  for (const double size : {1.0, 0x1p60, 1 - 0x1p-53}) {
    FivePoints five = corners;
    for (Point<3>& p : five) {
      for (double& c : p) c *= size;
    }
    const Scene scene(five);
    const int exact = exact_side(five);
    EXPECT_EQ(in_sphere_integer<1>(scene.points, kFive).value_or(exact), exact);
    EXPECT_EQ(in_sphere_integer<2>(scene.points, kFive), exact);
  }
}

}  // namespace
}  // namespace spillway::delaunay::kernel_3d
