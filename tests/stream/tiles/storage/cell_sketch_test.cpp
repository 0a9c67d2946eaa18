#include "stream/tiles/storage/cell_sketch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "src/delaunay/border/conflict_region_batch.h"

namespace spillway::test {
namespace {

using Points = std::vector<LatticePoint>;

/// Whether the sketch may hold a point, as a tiny simplex there sees it, and one that is far
/// larger.
template <int D>
bool holds(const PointSketch<D>& sketch, const LatticePoint& point, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point<D>> corners;
  for (const double size : {1e-6, 1.0, 1e3}) {
    for (int i = 0; i <= D; ++i) {
      Point<D>& corner = corners.emplace_back();
      for (int k = 0; k < D; ++k) corner[k] = point[k] + (i == 0 ? 0 : size * unit(random));
    }
  }
  ConflictRegionBatch<D> regions;
  regions.set(
      3,
      [](std::size_t s) {
        std::array<VertexId, D + 1> simplex;
        for (int i = 0; i <= D; ++i) simplex[i] = static_cast<VertexId>(s * (D + 1) + i);
        return simplex;
      },
      corners);
  return regions.may_meet_sketch(sketch, regions.all()) == regions.all();
}

template <int D>
void expect_all_in(const PointSketch<D>& sketch, const Points& points) {
  std::mt19937_64 random(2);
  for (const LatticePoint& p : points) EXPECT_TRUE(holds<D>(sketch, p, random));
}

/// On an ellipse, or an ellipsoid, somewhere.
Points on_a_surface(std::size_t count, int dimension, double offset, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Points points(count);
  for (LatticePoint& p : points) {
    double squared = 0;
    for (int k = 0; k < dimension; ++k) {
      p[k] = normal(random);
      squared += p[k] * p[k];
    }
    for (int k = 0; k < dimension; ++k) p[k] = offset + (3 - k) * p[k] / std::sqrt(squared);
  }
  return points;
}

Box<3> box_of(const Points& points) {
  Box<3> box;
  for (const LatticePoint& p : points) box.expand(p);
  return box;
}

CellSketch sketched(const Points& points, int dimension, std::size_t most) {
  CellSketch sketch(dimension, most, box_of(points));
  sketch.gather(points);
  sketch.measure(points);
  return sketch;
}

template <typename Dimension>
class CellSketchTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CellSketchTest, Dimensions);

TYPED_TEST(CellSketchTest, HoldsAllPointsInNoMoreThanItsCells) {
  constexpr int D = TypeParam::value;
  for (const double offset : {0.0, 4.5e6}) {
    const Points points = on_a_surface(3000, D, offset);
    const CellSketch sketch = sketched(points, D, 200);
    EXPECT_LE(sketch.size(), 200U);
    EXPECT_GE(sketch.size(), 40U);
    expect_all_in<D>(sketch.sketch<D>(), points);
  }
}

TYPED_TEST(CellSketchTest, IsThinWherePointsLieOnASurface) {
  constexpr int D = TypeParam::value;
  const auto sketch = sketched(on_a_surface(20'000, D, 0), D, 400).template sketch<D>();
  double radius = 0, thickness = 0;
  for (const Plate<D>& plate : sketch.plates) {
    radius += plate.radius;
    thickness += plate.thickness;
  }
  EXPECT_LT(thickness, (D == 2 ? 0.02 : 0.1) * radius);
}

TYPED_TEST(CellSketchTest, OfPartsHoldsTheirPointsAndThoseOfBoxes) {
  constexpr int D = TypeParam::value;
  Points all;
  std::vector<CellSketch> parts;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Points some = on_a_surface(1000, D, static_cast<double>(seed), seed);
    parts.push_back(sketched(some, D, 100));
    all.insert(all.end(), some.begin(), some.end());
  }
  const Points loose = on_a_surface(200, D, 9);
  const Box<3> box = box_of(loose);
  const Points held = on_a_surface(500, D, -4, 7);
  CellSketch sketch(D, 64, box_of(held));
  const auto visit = [&](const auto& act) {
    for (const CellSketch& part : parts) act(part);
    act(box);
    act(std::span<const LatticePoint>(held));
  };
  visit([&](const auto& part) { sketch.gather(part); });
  visit([&](const auto& part) { sketch.measure(part); });
  EXPECT_LE(sketch.size(), 64U);
  all.insert(all.end(), loose.begin(), loose.end());
  all.insert(all.end(), held.begin(), held.end());
  expect_all_in<D>(sketch.sketch<D>(), all);
}

TYPED_TEST(CellSketchTest, IsTheSameForAnySpans) {
  constexpr int D = TypeParam::value;
  const Points points = on_a_surface(2000, D, 0);
  const auto whole = sketched(points, D, 60).template sketch<D>();
  CellSketch in_spans(D, 60, box_of(points));
  const auto visit = [&](const auto& act) {
    for (std::size_t i = 0; i < points.size(); i += 7) {
      act(std::span<const LatticePoint>(points).subspan(i).first(
          std::min<std::size_t>(7, points.size() - i)));
    }
  };
  visit([&](auto some) { in_spans.gather(some); });
  visit([&](auto some) { in_spans.measure(some); });
  const auto again = in_spans.template sketch<D>();
  ASSERT_EQ(whole.plates.size(), again.plates.size());
  for (std::size_t b = 0; b < whole.plates.size(); ++b) {
    EXPECT_EQ(whole.boxes.level(0)[b], again.boxes.level(0)[b]);
    EXPECT_EQ(whole.plates[b].thickness, again.plates[b].thickness);
    EXPECT_EQ(whole.plates[b].normal, again.plates[b].normal);
  }
}

TYPED_TEST(CellSketchTest, TakesPointsOfAnySize) {
  constexpr int D = TypeParam::value;
  Points wild{{1e300, -1e300, 0}, {0, 0, 0}, {-1e300, 1e-300, 5}, {1e-320, 3, 3}};
  const auto sketch = sketched(wild, D, 1).template sketch<D>();
  EXPECT_LE(sketch.plates.size(), 8U);
  expect_all_in<D>(sketch, wild);
  const Points equal(20, {2, 3, 4});
  const auto of_equal = sketched(equal, D, 10);
  EXPECT_EQ(of_equal.size(), 1U);
  expect_all_in<D>(of_equal.sketch<D>(), equal);
}

}  // namespace
}  // namespace spillway::test
