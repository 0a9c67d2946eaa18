// Queries against brute force with exact signs.

#include <gtest/gtest.h>
#include <spillway/delaunay.h>

#include <algorithm>
#include <array>
#include <barrier>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "src/geometry/distance.h"
#include "src/geometry/predicates.h"
#include "src/library/search_starts.h"
#include "tests/library/point_sets.h"

namespace spillway::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Dimension>
class InMemoryQuery : public ::testing::Test {};
TYPED_TEST_SUITE(InMemoryQuery, Dimensions, DimensionNames);

template <int D>
std::int32_t locate_slowly(const Delaunay<D>& mesh, const Point<D>& place) {
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = mesh.points()[mesh.cells()[c].vertices[i]];
    bool inside = true;
    for (int i = 0; i <= D && inside; ++i) {
      auto replaced = corners;
      replaced[i] = place;
      inside = orientation<D>(replaced) >= 0;
    }
    if (inside) return static_cast<std::int32_t>(c);
  }
  return -1;
}

template <int D>
std::int32_t nearest_slowly(const Delaunay<D>& mesh, const Point<D>& place) {
  std::int32_t nearest = 0;
  for (std::size_t v = 1; v < mesh.point_count(); ++v) {
    if (compare_distances<D>(place, mesh.points()[v], mesh.points()[nearest]) < 0) {
      nearest = static_cast<std::int32_t>(v);
    }
  }
  return nearest;
}

TYPED_TEST(InMemoryQuery, LocateFindsTheLowestCellThatHasThePlace) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    const Points<D> places = places_around<D>(points, 300, 11);
    const auto found = mesh.locate(places);
    ASSERT_EQ(found.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int32_t expected = locate_slowly<D>(mesh, places[i]);
      EXPECT_EQ(mesh.locate(places[i]), expected);
      EXPECT_EQ(found[i], expected);
    }
  }
}

TYPED_TEST(InMemoryQuery, InterpolatedValuesStayWithinThoseOfTheCorners) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(3'000, 21);
  const Delaunay<D> mesh(points);
  const Points<D> places = places_around<D>(points, 20'000, 22);
  const auto cells = mesh.locate(places);
  const std::vector<double> alike(points.size(), 0.1);
  std::vector<double> heights(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] = 0.1 + 1e-15 * static_cast<double>(i % 3);
  const auto of_alike = mesh.interpolate(alike, places);
  const auto of_heights = mesh.interpolate(heights, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (cells[i] < 0) continue;
    ASSERT_EQ(of_alike[i], 0.1);
    ASSERT_GE(of_heights[i], heights[0]);
    ASSERT_LE(of_heights[i], heights[2]);
  }
}

TYPED_TEST(InMemoryQuery, NearestVertexIsTheLowestOfTheNearest) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points);
    Points<D> places = places_around<D>(points, 200, 12);
    Point<D> far;
    far.fill(-1e12);
    places.push_back(far);
    const auto found = mesh.nearest_vertex(places);
    ASSERT_EQ(found.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int32_t expected = nearest_slowly<D>(mesh, places[i]);
      EXPECT_EQ(mesh.nearest_vertex(places[i]), expected);
      EXPECT_EQ(found[i], expected);
    }
  }
}

TYPED_TEST(InMemoryQuery, NearestVertexOfTheCentreOfACircleOfManyIsTheLowest) {
  constexpr int D = TypeParam::value;
  Points<D> points;
  for (const auto& [a, b] :
       {std::pair{7, 24}, {15, 20}, {20, 15}, {24, 7}}) {  // 25 from the centre
    for (const int signs : {0, 1, 2, 3}) {
      Point<D> point{};
      point[0] = (signs & 1) != 0 ? a : -a;
      point[1] = (signs & 2) != 0 ? b : -b;
      points.push_back(point);
      if constexpr (D == 3) points.push_back({0, point[0], point[1]});
    }
  }
  const Delaunay<D> mesh(points);
  EXPECT_EQ(mesh.nearest_vertex(Point<D>{}), 0);
}

TYPED_TEST(InMemoryQuery, ManyPlacesAreAnsweredAsEachAlone) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(20'000, 13);
  const Points<D> places = places_around<D>(points, 9'000, 14);
  std::vector<double> values(points.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i % 97);
  std::vector<std::int32_t> cells, vertices;
  std::vector<double> interpolated;
  for (const unsigned threads : {1U, 2U, 4U}) {
    const Delaunay<D> mesh(points, {.threads = threads});
    if (cells.empty()) {
      for (const auto& place : places) {
        cells.push_back(mesh.locate(place));
        vertices.push_back(mesh.nearest_vertex(place));
        const Points<D> one{place};
        interpolated.push_back(mesh.interpolate(values, one)[0]);
      }
    }
    EXPECT_EQ(mesh.locate(places), cells);
    EXPECT_EQ(mesh.nearest_vertex(places), vertices);
    const auto all = mesh.interpolate(values, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_TRUE(all[i] == interpolated[i] || (std::isnan(all[i]) && cells[i] < 0));
    }
  }
}

TYPED_TEST(InMemoryQuery, TheFirstQuestionsMayComeFromManyThreadsAtOnce) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kThreads = 8;
  const Points<D> points = random_points<D>(70'000, 17);
  const Points<D> places = places_around<D>(points, 400, 18);
  const auto expected = Delaunay<D>(points).locate(places);
  const Delaunay<D> mesh(points);
  std::barrier together(kThreads);
  std::array<std::vector<std::int32_t>, kThreads> found;
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        together.arrive_and_wait();
        if (t % 2 == 0) {
          found[t] = mesh.locate(places);
        } else {
          for (const auto& place : places) found[t].push_back(mesh.locate(place));
        }
      });
    }
  }
  for (const auto& answers : found) EXPECT_EQ(answers, expected);
}

TYPED_TEST(InMemoryQuery, SearchesBeginNearThePlaceAlsoWherePointsTakeTurnsBetweenClusters) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kClusters = StartTree<D, std::int32_t>::kSampled;
  Points<D> points = random_points<D>(8'000, 19);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i][0] += 100.0 * static_cast<double>(i % kClusters);
  }
  const Delaunay<D> mesh(points);
  const MeshView<D, std::int32_t> view{mesh.points(), mesh.cell_vertices(), mesh.cell_neighbours(),
                                       mesh.vertex_cells()};
  const SearchStarts<D, std::int32_t> starts;
  for (std::size_t cluster = 0; cluster < kClusters; ++cluster) {
    const Point<D>& place = points[800 + cluster];
    const auto corners = view.corners(starts.of(view, 2).find(place));
    EXPECT_TRUE(std::ranges::any_of(
        corners, [&](const auto& corner) { return std::abs(corner[0] - place[0]) < 10; }));
  }
}

TYPED_TEST(InMemoryQuery, PlacesThatAreNotFiniteAreNowhere) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(100, 15);
  const Delaunay<D> mesh(points);
  const std::vector<double> values(points.size(), 1);
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    Points<D> places{points[0], points[1], points[2]};
    places[1][D - 1] = bad;
    EXPECT_EQ(mesh.locate(places[1]), -1);
    EXPECT_EQ(mesh.nearest_vertex(places[1]), -1);
    EXPECT_EQ(mesh.locate(places)[1], -1);
    EXPECT_EQ(mesh.nearest_vertex(places), (std::vector<std::int32_t>{0, -1, 2}));
    const auto all = mesh.interpolate(values, places);
    EXPECT_EQ(all[0], 1);
    EXPECT_TRUE(std::isnan(all[1]));
    EXPECT_EQ(all[2], 1);
  }
  EXPECT_TRUE(mesh.locate(PointView<D>()).empty());
}

TYPED_TEST(InMemoryQuery, InterpolationReproducesLinearFunctions) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points] : point_sets<D>()) {
    SCOPED_TRACE(name);
    Point<D> lo = points[0], hi = points[0];
    for (const auto& p : points) {
      for (int k = 0; k < D; ++k) {
        lo[k] = std::min(lo[k], p[k]);
        hi[k] = std::max(hi[k], p[k]);
      }
    }
    // From 0 to 1 along each axis, with weights; scaled before divided, for subnormal extents.
    const auto f = [&](const Point<D>& p) {
      double sum = 0.5;
      for (int k = 0; k < D; ++k) sum += (k + 1) * ((p[k] - lo[k]) / (hi[k] - lo[k]));
      return sum;
    };
    std::vector<double> values;
    for (const auto& p : points) values.push_back(f(p));
    const Delaunay<D> mesh(points);
    const Points<D> places = places_around<D>(points, 300, 16);
    const auto found = mesh.interpolate(values, places);
    const auto cells = mesh.locate(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (cells[i] < 0) {
        EXPECT_TRUE(std::isnan(found[i]));
      } else {
        EXPECT_NEAR(found[i], f(places[i]), 1e-9);
      }
    }
    EXPECT_EQ(mesh.interpolate(values, points), values);
  }
}

TYPED_TEST(InMemoryQuery, InterpolationLooksOnlyAtVerticesOfTheFaceWithThePlace) {
  constexpr int D = TypeParam::value;
  Points<D> points(D + 1);
  for (int k = 0; k < D; ++k) points[k + 1][k] = 2;
  std::vector<double> values(D + 1, kNan);
  values[0] = 1;
  values[1] = 1e308;
  const Delaunay<D> mesh(points);
  Points<D> places(3);
  places[1][0] = 1;             // the middle of an edge
  places[2].fill(2.0 / D / 4);  // inside
  const auto found = mesh.interpolate(values, places);
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[1], 5e307);
  EXPECT_TRUE(std::isnan(found[2]));
}

}  // namespace
}  // namespace spillway::test
