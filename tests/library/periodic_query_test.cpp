// Questions to periodic meshes, against brute force over copies with exact signs.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/geometry/distance.h"
#include "src/geometry/predicates.h"
#include "src/geometry/torus.h"
#include "tests/library/periodic_sets.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class PeriodicQuery : public ::testing::Test {};
TYPED_TEST_SUITE(PeriodicQuery, Dimensions, DimensionNames);

template <int D>
Point<D> in_box(const Delaunay<D>& mesh, Point<D> place) {
  Torus(*mesh.periodic(), D).wrap(place);
  return place;
}

/// Places in the box, at its sides, at points and far outside.
template <int D>
Points<D> places_for(const Points<D>& points, const PeriodicBox& box, std::uint64_t seed) {
  Points<D> places = places_around<D>(points, 120, seed);
  for (std::size_t i = 0; i < places.size(); i += 5) {
    const int axis = static_cast<int>(i / 5) % D;
    places[i][axis] = i % 2 == 0 ? box.box.low[axis] : box.box.high[axis];
  }
  return places;
}

template <int D>
bool has(const std::array<Point<D>, D + 1>& corners, const Point<D>& place) {
  for (int i = 0; i <= D; ++i) {
    auto replaced = corners;
    replaced[i] = place;
    if (orientation<D>(replaced) < 0) return false;
  }
  return true;
}

template <int D>
std::int32_t locate_slowly(const Delaunay<D>& mesh, const Point<D>& place) {
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    bool found = false;
    const auto corners = placed_corners<D>(mesh, c);
    for_each_copy<D>(*mesh.periodic(), [&](const std::array<int, D>& periods) {
      std::array<Point<D>, D + 1> copies;
      for (int i = 0; i <= D; ++i) copies[i] = moved<D>(corners[i], periods, *mesh.periodic());
      found = found || has<D>(copies, place);
    });
    if (found) return static_cast<std::int32_t>(c);
  }
  return -1;
}

template <int D>
std::int32_t nearest_slowly(const Delaunay<D>& mesh, const Point<D>& place) {
  std::int32_t nearest = 0;
  Point<D> there = mesh.points()[0];
  for (std::size_t v = 0; v < mesh.point_count(); ++v) {
    for_each_copy<D>(*mesh.periodic(), [&](const std::array<int, D>& periods) {
      const Point<D> copy = moved<D>(mesh.points()[v], periods, *mesh.periodic());
      if (compare_distances<D>(place, copy, there) >= 0) return;
      nearest = static_cast<std::int32_t>(v);
      there = copy;
    });
  }
  return nearest;
}

TYPED_TEST(PeriodicQuery, LocateFindsTheLowestCellACopyOfWhichHasThePlace) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points, box] : periodic_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points, {.periodic = box});
    const Points<D> places = places_for<D>(points, box, 11);
    const auto found = mesh.locate(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int32_t expected = locate_slowly<D>(mesh, in_box<D>(mesh, places[i]));
      EXPECT_EQ(mesh.locate(places[i]), expected);
      EXPECT_EQ(found[i], expected);
    }
  }
}

TYPED_TEST(PeriodicQuery, NearestVertexIsThatOfTheNearestCopy) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points, box] : periodic_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points, {.periodic = box});
    const Points<D> places = places_for<D>(points, box, 12);
    const auto found = mesh.nearest_vertex(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int32_t expected = nearest_slowly<D>(mesh, in_box<D>(mesh, places[i]));
      EXPECT_EQ(mesh.nearest_vertex(places[i]), expected);
      EXPECT_EQ(found[i], expected);
    }
  }
}

TYPED_TEST(PeriodicQuery, InterpolatedValuesAreThoseOfThePointsAndTheSameInAllCopies) {
  constexpr int D = TypeParam::value;
  const PeriodicBox box = square_box<D>(-3, 8);
  const Points<D> points = random_points<D>(600, 13);
  const Delaunay<D> mesh(points, {.periodic = box});
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(std::cos(double(i)));
  EXPECT_EQ(mesh.interpolate(values, points), values);
  EXPECT_EQ(mesh.interpolate(values, mesh.points()), values);
  Points<D> places = places_around<D>(points, 500, 14);
  for (auto& place : places) {
    for (double& c : place) c = std::nearbyint(c * 64) / 64;
  }
  const auto found = mesh.interpolate(values, places);
  for (auto& place : places) place[0] += 8;
  EXPECT_EQ(mesh.interpolate(values, places), found);
  for (const double value : found) EXPECT_LE(std::abs(value), 1);
}

TYPED_TEST(PeriodicQuery, PlacesBeyondAnOpenSideAndThoseThatAreNotFiniteAreNowhere) {
  constexpr int D = TypeParam::value;
  PeriodicBox box = square_box<D>(-3, 8);
  box.periodic[0] = false;
  const Points<D> points = random_points<D>(200, 15);
  const Delaunay<D> mesh(points, {.periodic = box});
  const std::vector<double> values(points.size(), 1);
  Points<D> places(3, points[0]);
  places[1][0] = 1000;
  places[2][D - 1] = std::numeric_limits<double>::infinity();
  const auto cells = mesh.locate(places);
  EXPECT_GE(cells[0], 0);
  EXPECT_EQ(cells[1], -1);
  EXPECT_EQ(cells[2], -1);
  EXPECT_GE(mesh.nearest_vertex(places[1]), 0);
  EXPECT_EQ(mesh.nearest_vertex(places[2]), -1);
  const auto found = mesh.interpolate(values, places);
  EXPECT_EQ(found[0], 1);
  EXPECT_TRUE(std::isnan(found[1]));
  EXPECT_TRUE(std::isnan(found[2]));
}

}  // namespace
}  // namespace spillway::test
