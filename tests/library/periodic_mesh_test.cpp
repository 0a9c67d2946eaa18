// Periodic meshes in memory, against CGAL, against streams and from first principles.

#include <gtest/gtest.h>
#include <spillway/context.h>
#include <spillway/mesh.h>
#include <spillway/points.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <set>

#include "src/geometry/predicates.h"
#include "tests/library/cgal_periodic.h"
#include "tests/library/periodic_sets.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class PeriodicMeshInMemory : public ::testing::Test {};
TYPED_TEST_SUITE(PeriodicMeshInMemory, Dimensions, DimensionNames);

template <int D>
using Cell = std::array<VertexId, D + 1>;

template <int D>
std::vector<Cell<D>> sorted_cells(const Delaunay<D>& mesh) {
  std::vector<Cell<D>> cells;
  for (const auto cell : mesh.cells()) {
    auto& vertices = cells.emplace_back();
    std::copy(cell.vertices.begin(), cell.vertices.end(), vertices.begin());
    std::sort(vertices.begin(), vertices.end());
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

template <int D>
ErrorCode code_of(const Points<D>& points, const PeriodicBox& box, std::string& text) {
  try {
    const Delaunay<D> mesh(points, {.periodic = box});
  } catch (const Error& error) {
    text = error.what();
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TYPED_TEST(PeriodicMeshInMemory, CellsAreThoseOfCgal) {
  constexpr int D = TypeParam::value;
  for (const std::size_t count : {700, 2'000}) {
    for (const double low : {0.0, -17.25, 100.3}) {
      const PeriodicBox box = square_box<D>(low, 5.1);
      Points<D> points = random_points<D>(count, count);
      const Delaunay<D> mesh(points, {.periodic = box});
      const auto expected = cgal_periodic_simplices<D>(mesh.points(), *mesh.periodic());
      EXPECT_EQ(sorted_cells<D>(mesh), expected);
      EXPECT_TRUE(mesh.hull_cells().empty());
      EXPECT_TRUE(mesh.hull_facets().empty());
    }
  }
}

TYPED_TEST(PeriodicMeshInMemory, PointsAreBroughtIntoTheBoxAndCopiesOfOneAreDuplicates) {
  constexpr int D = TypeParam::value;
  PeriodicBox box = square_box<D>(0, 16);
  for (int k = 0; k < D; ++k) box.box = {{}, {16, 16, 16}};
  Points<D> inside = random_points<D>(300, 3);
  for (auto& point : inside) {
    for (double& c : point) c = std::floor((c + 3) * 2 * 1024) / 1024;
  }
  Points<D> outside = inside;
  for (std::size_t i = 0; i < outside.size(); ++i) {
    for (int k = 0; k < D; ++k) outside[i][k] += 16 * (static_cast<int>(i % 5) - 2);
  }
  outside.push_back(inside[5]);
  const Delaunay<D> mesh(outside, {.periodic = box});
  for (std::size_t i = 0; i < inside.size(); ++i) EXPECT_EQ(mesh.points()[i], inside[i]);
  ASSERT_EQ(mesh.duplicates().size(), 1);
  EXPECT_EQ(mesh.duplicates()[0], (Duplicate<std::int32_t>{300, 5}));
  EXPECT_EQ(mesh.vertex_cells()[300], -1);
  EXPECT_EQ(sorted_cells<D>(mesh), sorted_cells<D>(Delaunay<D>(inside, {.periodic = box})));
}

TYPED_TEST(PeriodicMeshInMemory, CellsArePositiveFillTheBoxAndStartWithoutOffset) {
  constexpr int D = TypeParam::value;
  std::vector<PeriodicSet<D>> sets = periodic_sets<D>();
  for (const std::uint64_t seed : {1, 2, 3, 4}) sets.push_back(flat_hull<D>(seed));
  for (const auto& [name, points, box] : sets) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points, {.periodic = box});
    ASSERT_EQ(mesh.cell_offsets().size(), mesh.cell_vertices().size() * D);
    double volume = 0;
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
      const auto corners = placed_corners<D>(mesh, c);
      ASSERT_EQ(orientation<D>(corners), 1);
      const auto first = std::ranges::min_element(corners) - corners.begin();
      for (int k = 0; k < D; ++k) {
        EXPECT_EQ(mesh.cell_offsets()[(c * (D + 1) + first) * D + k], 0);
      }
      std::array<Point<D>, D> edges;
      for (int i = 0; i < D; ++i) {
        for (int k = 0; k < D; ++k) edges[i][k] = corners[i + 1][k] - corners[0][k];
      }
      if constexpr (D == 2) {
        volume += (edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0]) / 2;
      } else {
        const auto& [a, b, d] = edges;
        volume += (a[0] * (b[1] * d[2] - b[2] * d[1]) - a[1] * (b[0] * d[2] - b[2] * d[0]) +
                   a[2] * (b[0] * d[1] - b[1] * d[0])) /
                  6;
      }
    }
    // With one open axis the hull is two planes, through the outermost points.
    double expected = 1;
    int open = 0;
    for (int k = 0; k < D; ++k) {
      const auto [low, high] = std::ranges::minmax(
          mesh.points() | std::views::transform([k](const Point<D>& point) { return point[k]; }));
      open += box.periodic[k] ? 0 : 1;
      expected *= box.periodic[k] ? box.period(k) : high - low;
    }
    if (open < 2) {
      EXPECT_NEAR(volume, expected, 1e-9 * expected);
    }
  }
}

TYPED_TEST(PeriodicMeshInMemory, NoSphereHasACopyOfAPointInside) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points, box] : periodic_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points, {.periodic = box});
    const std::size_t step = std::max<std::size_t>(1, mesh.cell_count() / 60);
    for (std::size_t c = 0; c < mesh.cell_count(); c += step) {
      const auto corners = placed_corners<D>(mesh, c);
      for (const Point<D>& point : mesh.points()) {
        for_each_copy<D>(*mesh.periodic(), [&](const std::array<int, D>& periods) {
          const Point<D> copy = moved<D>(point, periods, *mesh.periodic());
          if (std::ranges::count(corners, copy) > 0) return;
          ASSERT_LE(in_sphere<D>(corners, copy), 0);
        });
      }
    }
  }
}

TYPED_TEST(PeriodicMeshInMemory, NeighboursAreMutualAndShareTheFacetOppositeTheVertex) {
  constexpr int D = TypeParam::value;
  for (const auto& [name, points, box] : periodic_sets<D>()) {
    SCOPED_TRACE(name);
    const Delaunay<D> mesh(points, {.periodic = box});
    bool closed = true;
    for (int k = 0; k < D; ++k) closed &= box.periodic[k];
    std::size_t on_hull = 0;
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
      for (int i = 0; i <= D; ++i) {
        const std::int32_t other = mesh.cell_neighbours()[c * (D + 1) + i];
        if (other < 0) {
          ++on_hull;
          continue;
        }
        const auto back = mesh.cells()[other].neighbours;
        EXPECT_GE(std::ranges::count(back, static_cast<std::int32_t>(c)), 1);
        std::multiset<std::int32_t> here, there;
        for (int j = 0; j <= D; ++j) {
          if (j != i) here.insert(mesh.cell_vertices()[c * (D + 1) + j]);
          there.insert(mesh.cells()[other].vertices[j]);
        }
        EXPECT_TRUE(std::ranges::includes(there, here));
      }
    }
    EXPECT_EQ(on_hull, mesh.hull_cells().size());
    EXPECT_EQ(on_hull * D, mesh.hull_facets().size());
    EXPECT_EQ(on_hull == 0, closed);
    for (std::size_t v = 0; v < mesh.point_count(); ++v) {
      const std::int32_t cell = mesh.vertex_cells()[v];
      if (cell < 0) continue;
      EXPECT_EQ(std::ranges::count(mesh.cells()[cell].vertices, v) > 0, true);
    }
  }
}

/// Cells as sets of places of corners on a lattice of steps of 1, brought into the box.
template <int D>
std::multiset<std::set<Point<D>>> shapes(const Delaunay<D>& mesh, const Point<D>& by) {
  std::multiset<std::set<Point<D>>> cells;
  const PeriodicBox box = *mesh.periodic();
  for (const auto cell : mesh.cells()) {
    std::set<Point<D>> corners;
    for (const auto vertex : cell.vertices) {
      Point<D> corner = mesh.points()[vertex];
      for (int k = 0; k < D; ++k) corner[k] = std::fmod(corner[k] + by[k], box.period(k));
      corners.insert(corner);
    }
    cells.insert(corners);
  }
  return cells;
}

TYPED_TEST(PeriodicMeshInMemory, ALatticeMovedByWholeStepsHasTheSameCells) {
  constexpr int D = TypeParam::value;
  PeriodicBox box;
  box.box = {{}, {6, 6, 6}};
  const Delaunay<D> mesh(lattice_points<D>(6, 5), {.periodic = box});
  EXPECT_EQ(mesh.cell_count(), D == 2 ? 72 : 6 * 216);
  const auto expected = shapes<D>(mesh, Point<D>{});
  for (int k = 0; k < D; ++k) {
    Point<D> by{};
    by[k] = 1;
    EXPECT_EQ(shapes<D>(mesh, by), expected);
  }
}

TYPED_TEST(PeriodicMeshInMemory, TooFewPointsAreRefusedWithTheLengthOfACell) {
  constexpr int D = TypeParam::value;
  for (const std::size_t count : {1, 2, 5}) {
    std::string text;
    EXPECT_EQ(code_of<D>(random_points<D>(count, count), square_box<D>(0, 3), text),
              ErrorCode::kDegenerateInput);
    EXPECT_TRUE(text.starts_with("too few points for a triangulation of the periodic box")) << text;
  }
  std::string text;
  EXPECT_EQ(code_of<D>({}, square_box<D>(0, 3), text), ErrorCode::kDegenerateInput);
}

TYPED_TEST(PeriodicMeshInMemory, PointsOnOneLineAndVeryUnequalSidesAreTooFew) {
  constexpr int D = TypeParam::value;
  Points<D> line(400);
  for (std::size_t i = 0; i < line.size(); ++i) {
    line[i].fill(1.5);
    line[i][0] = 3 * static_cast<double>(i) / static_cast<double>(line.size());
  }
  std::string text;
  EXPECT_EQ(code_of<D>(line, square_box<D>(0, 3), text), ErrorCode::kDegenerateInput);
  EXPECT_TRUE(text.starts_with("too few points for a triangulation of the periodic box")) << text;
  PeriodicBox box = square_box<D>(0, 3);
  box.box.high[1] = 30'000;
  EXPECT_EQ(code_of<D>(random_points<D>(300, 1), box, text), ErrorCode::kDegenerateInput);
  EXPECT_TRUE(text.starts_with("too few points for a triangulation of the periodic box")) << text;
}

TYPED_TEST(PeriodicMeshInMemory, BoxesThatAreNoneAreRefused) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(50, 1);
  std::string text;
  EXPECT_EQ(code_of<D>(points, square_box<D>(0, 0), text), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of<D>(points, square_box<D>(1e18, 1024), text), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of<D>(points, {.periodic = {}}, text), ErrorCode::kInvalidArgument);
  Points<D> bad = points;
  bad[7][1] = INFINITY;
  EXPECT_EQ(code_of<D>(bad, square_box<D>(0, 3), text), ErrorCode::kInvalidArgument);
  EXPECT_NE(text.find("point 7"), std::string::npos);
  EXPECT_EQ(code_of<4>(random_points<4>(50, 1), square_box<D>(0, 3), text),
            ErrorCode::kInvalidArgument);
}

TYPED_TEST(PeriodicMeshInMemory, HashIsThatOfTheStream) {
  constexpr int D = TypeParam::value;
  const Context context({.memory = std::size_t{256} << 20, .threads = 2});
  for (const auto& [name, points, box] : periodic_sets<D>()) {
    SCOPED_TRACE(name);
    const auto source = points_in_memory(PointView<D>(points));
    MeshInMemory sink;
    TriangulateOptions options;
    options.dimension = D;
    options.periodic = box;
    const Report report = triangulate(*source, sink, options, context);
    const Delaunay<D> mesh(points, {.periodic = box});
    EXPECT_EQ(mesh.canonical_hash(), report.mesh.canonical_hash);
    EXPECT_EQ(mesh.cell_count(), report.mesh.simplices);
    EXPECT_EQ(mesh.vertex_count(), report.mesh.vertices);
    EXPECT_EQ(mesh.periodic(), sink.header().periodic);
  }
}

TYPED_TEST(PeriodicMeshInMemory, CentresLieInTheBox) {
  constexpr int D = TypeParam::value;
  const PeriodicBox box = square_box<D>(-3, 8);
  const Delaunay<D> mesh(random_points<D>(500, 12), {.periodic = box});
  const auto centres = mesh.circumcentres();
  for (std::size_t c = 0; c < centres.size(); ++c) {
    EXPECT_EQ(mesh.circumcentre(static_cast<std::int32_t>(c)), centres[c]);
    for (int k = 0; k < D; ++k) {
      EXPECT_GE(centres[c][k], box.box.low[k] - 1e-9);
      EXPECT_LE(centres[c][k], box.box.high[k] + 1e-9);
    }
  }
}

TYPED_TEST(PeriodicMeshInMemory, ResultDependsNeitherOnThreadsNorOnTheTypeOfNumbers) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(60'000, 9);
  const PeriodicBox box = square_box<D>(-3, 8);
  std::size_t last = 0;
  const Delaunay<D> one(points, {.threads = 1,
                                 .progress =
                                     [&](std::size_t done, std::size_t total) {
                                       EXPECT_GT(done, last);
                                       EXPECT_EQ(total, points.size());
                                       last = done;
                                     },
                                 .periodic = box});
  EXPECT_EQ(last, points.size());
  const Delaunay<D> other(points, {.threads = 3, .periodic = box});
  EXPECT_TRUE(std::ranges::equal(one.cell_vertices(), other.cell_vertices()));
  EXPECT_TRUE(std::ranges::equal(one.cell_neighbours(), other.cell_neighbours()));
  EXPECT_TRUE(std::ranges::equal(one.cell_offsets(), other.cell_offsets()));
  EXPECT_EQ(one.canonical_hash(), other.canonical_hash());
  const Delaunay<D, std::int64_t> wide(points, {.periodic = box});
  EXPECT_TRUE(std::ranges::equal(one.cell_vertices(), wide.cell_vertices()));
  EXPECT_TRUE(std::ranges::equal(one.cell_neighbours(), wide.cell_neighbours()));
}

TYPED_TEST(PeriodicMeshInMemory, MeshesThatDoNotRepeatHaveNoOffsets) {
  constexpr int D = TypeParam::value;
  const Delaunay<D> mesh(random_points<D>(50, 9));
  EXPECT_TRUE(mesh.cell_offsets().empty());
  EXPECT_FALSE(mesh.periodic());
}

}  // namespace
}  // namespace spillway::test
