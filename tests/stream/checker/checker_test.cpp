// The checker accepts what CGAL computes and refuses every way of spoiling it.

#include "stream/checker/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/error.h"
#include "src/geometry/predicates.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/geometry/point_families.h"
#include "tests/stream/checker/mesh_surgery.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr IntegerLattice kCentimetres{{0.01, 0.01, 0.01}, {637000.1, 4850000.03, -20}};

// A mesh of CGAL's simplices. With a lattice, points are integers.
template <int D>
Mesh cgal_mesh(const std::vector<Point<D>>& points,
               const std::optional<IntegerLattice>& lattice = {}) {
  Mesh mesh;
  mesh.header.dimension = D;
  mesh.header.vertices = points.size();
  mesh.header.lattice = lattice;
  for (const auto& p : points) {
    WorldPoint output{};
    for (int k = 0; k < D; ++k) output[k] = lattice ? lattice->to_world(k, p[k]) : p[k];
    mesh.vertices.push_back(output);
  }
  for (auto vertices : cgal_simplices<D>(points)) {
    std::array<Point<D>, D + 1> simplex;
    for (int i = 0; i <= D; ++i) simplex[i] = points[vertices[i]];
    if (orientation<D>(simplex) < 0) std::swap(vertices[0], vertices[1]);
    mesh.corners.insert(mesh.corners.end(), vertices.begin(), vertices.end());
  }
  mesh.header.simplices = mesh.corners.size() / (D + 1);
  return mesh;
}

// Distinct integer points, scattered over a square or cube.
template <int D>
std::vector<Point<D>> scattered_integers(std::size_t count, std::int64_t side, std::uint64_t seed) {
  Random random(seed);
  std::vector<Point<D>> points(count);
  for (auto& p : points) {
    for (double& c : p) c = static_cast<double>(random.integer(0, side));
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

template <int D>
std::vector<Point<D>> scattered(std::size_t count, double scale, double offset) {
  auto points = scattered_integers<D>(count, 1 << 30, 5);
  for (auto& p : points) {
    for (double& c : p) c = c * scale * 0x1p-30 + offset;
  }
  return points;
}

// All integer points of a square or cube with n points a side.
template <int D>
std::vector<Point<D>> full_grid(int n) {
  std::vector<Point<D>> points;
  for (int i = 0; i < (D == 2 ? n * n : n * n * n); ++i) {
    Point<D> p{};
    for (int k = 0, rest = i; k < D; ++k, rest /= n) p[k] = rest % n;
    points.push_back(p);
  }
  return points;
}

// A rectangle of 30 x 20 integer points, with heights, as a scanned plain has.
template <int D>
std::vector<Point<D>> plain() {
  Random random(9);
  std::vector<Point<D>> points;
  for (int i = 0; i < 600; ++i) {
    Point<D> p{};
    p[0] = 5 * (i % 30);
    p[1] = 5 * (i / 30);
    if constexpr (D == 3) p[2] = static_cast<double>(random.integer(0, 3));
    points.push_back(p);
  }
  return points;
}

CheckerOptions any_delaunay() {
  CheckerOptions options;
  options.any_delaunay = true;
  return options;
}

void expect_proved(const Mesh& mesh, const CheckerOptions& options = {}) {
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_EQ(report.fault_count, 0U);
  EXPECT_THAT(report.faults, ::testing::IsEmpty());
  EXPECT_EQ(report.canonical_hash, canonical_hash(mesh));
}

void expect_fault(const Mesh& mesh, const std::string& part, const CheckerOptions& options = {}) {
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_GT(report.fault_count, 0U);
  EXPECT_THAT(report.faults, Contains(HasSubstr(part)));
}

template <typename Dimension>
class CheckerTest : public ::testing::Test {
 protected:
  const std::string simplex_ = Dimension::value == 2 ? "triangle" : "tetrahedron";
  const std::string facet_ = Dimension::value == 2 ? "edge" : "facet";
  const Mesh good_ = cgal_mesh<Dimension::value>(scattered<Dimension::value>(200, 1, 0));
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CheckerTest, Dimensions);

TYPED_TEST(CheckerTest, AcceptsScatteredPoints) {
  constexpr int D = TypeParam::value;
  for (const std::size_t count : {D + 1, 10, 3000}) {
    const auto points = scattered<D>(count, 1, 0);
    const Mesh mesh = cgal_mesh<D>(points);
    expect_proved(mesh);
    const CheckReport report = check_mesh(mesh, {});
    EXPECT_EQ(report.vertices, count);
    EXPECT_EQ(report.simplices, mesh.header.simplices);
    EXPECT_EQ(report.hull_facets, cgal_hull_facets<D>(points));
    EXPECT_FALSE(report.on_lattice);
    EXPECT_FALSE(report.proved.empty());
  }
}

TYPED_TEST(CheckerTest, AcceptsHugeOffsetsAndExtremeScales) {
  constexpr int D = TypeParam::value;
  expect_proved(cgal_mesh<D>(scattered<D>(500, 1, 1e9)));
  expect_proved(cgal_mesh<D>(scattered<D>(500, 1e-140, 0)));
  expect_proved(cgal_mesh<D>(scattered<D>(500, 1e140, 0)));
}

TYPED_TEST(CheckerTest, AcceptsGridsFullOfTies) {
  constexpr int D = TypeParam::value;
  const auto grid = full_grid<D>(D == 2 ? 25 : 8);
  expect_proved(cgal_mesh<D>(grid));
  expect_proved(cgal_mesh<D>(plain<D>()));
  expect_proved(cgal_mesh<D>(scattered_integers<D>(800, D == 2 ? 30 : 9, 3)));
}

TYPED_TEST(CheckerTest, AcceptsLatticesOnTheirIntegers) {
  constexpr int D = TypeParam::value;
  for (const auto& points : {full_grid<D>(7), plain<D>(), scattered_integers<D>(900, 40, 4)}) {
    Mesh mesh = cgal_mesh<D>(points, kCentimetres);
    expect_proved(mesh);
    EXPECT_TRUE(check_mesh(mesh, {}).on_lattice);
    mesh.header.lattice.reset();  // the input's lattice does as well
    CheckerOptions options;
    options.input_lattice = kCentimetres;
    expect_proved(mesh, options);
    EXPECT_TRUE(check_mesh(mesh, options).on_lattice);
  }
}

TYPED_TEST(CheckerTest, TestsOutputCoordinatesIfTheLatticeIsNotIsotropic) {
  constexpr int D = TypeParam::value;
  IntegerLattice lattice{{0.25, 0.25, 0.25}, {10, 20, 30}};
  lattice.scale[D - 1] = 0.125;
  auto points = scattered_integers<D>(300, 1000, 6);
  Mesh mesh = cgal_mesh<D>(points, lattice);
  for (auto& p : points) {
    for (int k = 0; k < D; ++k) p[k] = lattice.to_world(k, p[k]);
  }
  mesh.corners = cgal_mesh<D>(points).corners;
  expect_proved(mesh);
  EXPECT_FALSE(check_mesh(mesh, {}).on_lattice);
}

TYPED_TEST(CheckerTest, HashDoesNotDependOnTheOrderOfSimplices) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  std::rotate(mesh.corners.begin(), mesh.corners.begin() + 5 * (D + 1), mesh.corners.end());
  EXPECT_EQ(canonical_hash(mesh), canonical_hash(this->good_));
  remove_simplex<D>(mesh, 0);
  EXPECT_NE(canonical_hash(mesh), canonical_hash(this->good_));
}

TYPED_TEST(CheckerTest, RejectsAFlippedEdge) {
  Mesh mesh = this->good_;
  ASSERT_TRUE(flip<TypeParam::value>(mesh, false));
  expect_fault(mesh, "is not Delaunay");
  expect_fault(mesh, "is not Delaunay", any_delaunay());
}

TYPED_TEST(CheckerTest, RejectsATieBrokenTheOtherWayUnlessAnyDelaunayWillDo) {
  constexpr int D = TypeParam::value;
  Mesh mesh = cgal_mesh<D>(scattered_integers<D>(400, D == 2 ? 25 : 8, 8));
  ASSERT_TRUE(flip<D>(mesh, true));
  expect_fault(mesh, "as ties are broken");
  expect_proved(mesh, any_delaunay());
}

TYPED_TEST(CheckerTest, RejectsAHoleInside) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  remove_simplex<D>(mesh, find_simplex<D>(mesh, true));
  expect_fault(mesh, "the boundary is not convex");
}

TYPED_TEST(CheckerTest, RejectsABoundaryThatIsNotConvex) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  remove_simplex<D>(mesh, find_simplex<D>(mesh, false));
  expect_fault(mesh, "the boundary is not convex");
}

TYPED_TEST(CheckerTest, RejectsAMovedVertex) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  for (int k = 0; k < D; ++k) mesh.vertices[100][k] += 0.2;
  expect_fault(mesh, "negatively oriented");
  Mesh on_lattice = cgal_mesh<D>(plain<D>(), kCentimetres);
  on_lattice.vertices[300][0] += 0.01;
  EXPECT_GT(check_mesh(on_lattice, {}).fault_count, 0U);
}

TYPED_TEST(CheckerTest, RejectsAVertexOffTheLattice) {
  constexpr int D = TypeParam::value;
  Mesh mesh = cgal_mesh<D>(plain<D>(), kCentimetres);
  mesh.vertices[17][1] = std::nextafter(mesh.vertices[17][1], 0.0);
  expect_fault(mesh, "vertex 17 (");
  expect_fault(mesh, "is off the lattice: its y");
}

TYPED_TEST(CheckerTest, RejectsADuplicateSimplexOnce) {
  constexpr int D = TypeParam::value;
  for (const bool inner : {true, false}) {
    Mesh mesh = this->good_;
    const auto vertices = simplex_of<D>(mesh, find_simplex<D>(mesh, inner));
    mesh.corners.insert(mesh.corners.end(), vertices.begin(), vertices.end());
    expect_fault(mesh, "has the same vertices as " + this->simplex_);
  }
}

TYPED_TEST(CheckerTest, RejectsAMeshListedTwice) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  const auto once = mesh.corners;
  mesh.corners.insert(mesh.corners.end(), once.begin(), once.end());
  const CheckReport report = check_mesh(mesh, {});
  EXPECT_EQ(report.fault_count, once.size() / (D + 1));
}

TYPED_TEST(CheckerTest, RejectsReversedOrientation) {
  Mesh mesh = this->good_;
  std::swap(mesh.corners[0], mesh.corners[1]);
  expect_fault(mesh, this->simplex_ + " 0 (vertices ");
  expect_fault(mesh, "negatively oriented");
}

TYPED_TEST(CheckerTest, RejectsADegenerateSimplex) {
  Mesh mesh = this->good_;
  mesh.corners[1] = mesh.corners[0];
  expect_fault(mesh, "degenerate");
}

TYPED_TEST(CheckerTest, RejectsAVertexInNoSimplex) {
  Mesh mesh = this->good_;
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  expect_fault(mesh, "vertex 200 (0.5, 0.5");
  expect_fault(mesh, "is in no " + this->simplex_);
}

TYPED_TEST(CheckerTest, RejectsTwoVerticesAtOnePoint) {
  Mesh mesh = this->good_;
  mesh.vertices[7] = mesh.vertices[8];
  expect_fault(mesh, "are the same point");
}

TYPED_TEST(CheckerTest, RejectsASecondMeshThatOverlapsTheFirst) {
  constexpr int D = TypeParam::value;
  for (const double scale : {0.25, 4.0}) {
    Mesh mesh = this->good_;
    const Mesh other = cgal_mesh<D>(scattered<D>(200, scale, 0.3));
    for (const std::uint64_t corner : other.corners) {
      mesh.corners.push_back(corner + mesh.vertices.size());
    }
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    expect_fault(mesh, "the boundary is not one convex surface");
  }
}

TYPED_TEST(CheckerTest, RejectsTwoSimplicesOnTheSameSideOfAFacet) {
  constexpr int D = TypeParam::value;
  auto points = std::vector<Point<D>>(D + 2);
  for (int k = 0; k < D; ++k) points[k][k] = 1;
  points[D + 1].fill(0.25);
  Mesh mesh;
  mesh.header.dimension = D;
  for (const auto& p : points) {
    mesh.vertices.emplace_back();
    std::copy(p.begin(), p.end(), mesh.vertices.back().begin());
  }
  std::vector<std::uint64_t> vertices(D + 1);
  for (int i = 0; i <= D; ++i) vertices[i] = static_cast<std::uint64_t>(i);
  add_simplex<D>(mesh, vertices);
  vertices[D] = D + 1;
  add_simplex<D>(mesh, vertices);
  expect_fault(mesh, "overlap: they lie on the same side of their common " + this->facet_);
}

TYPED_TEST(CheckerTest, RejectsVertexNumbersOutOfRange) {
  Mesh mesh = this->good_;
  mesh.corners[5] = 200;
  expect_fault(mesh, "names vertex 200, but there are 200 vertices");
  EXPECT_THROW(canonical_hash(mesh), Failure);
}

TYPED_TEST(CheckerTest, RejectsCoordinatesThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mesh mesh = this->good_;
    mesh.vertices[3][1] = bad;
    expect_fault(mesh, "not finite");
  }
}

TYPED_TEST(CheckerTest, RejectsAMeshWithoutSimplices) {
  Mesh mesh;
  mesh.header.dimension = TypeParam::value;
  expect_fault(mesh, "the mesh has no ");
}

TYPED_TEST(CheckerTest, DescribesNoMoreFaultsThanAskedForButCountsAll) {
  Mesh mesh = this->good_;
  for (int i = 0; i < 20; ++i) mesh.vertices.push_back({2.0 + i, 0, 0});
  CheckerOptions options;
  options.most_faults = 3;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_EQ(report.faults.size(), 3U);
  EXPECT_EQ(report.fault_count, 20U);
}

TEST(Checker2DTest, RejectsABoundaryThatWindsTwice) {
  // The pentagram around its centre: every angle convex, every triangle positive, covered twice.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},       {0, 1000, 0},   {-951, 309, 0},
                   {-588, -809, 0}, {588, -809, 0}, {951, 309, 0}};
  for (std::uint64_t i = 0; i < 5; ++i) add_simplex<2>(mesh, {0, 1 + i, 1 + (i + 2) % 5});
  expect_fault(mesh, "the boundary is not one convex surface");
}

TEST(Checker2DTest, RejectsTwoTrianglesThatShareALineOfTheBoundary) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {-1, 0, 0}, {9, 0, 0}, {-1, 9, 0}};
  mesh.corners = {0, 1, 2, 3, 4, 5};
  expect_fault(mesh, "the boundary covers itself");
}

TEST(Checker3DTest, RejectsABoundaryThatCoversItsInsideSevenTimes) {
  // The great icosahedron around its centre: a sphere by Euler's formula, convex at every edge.
  Mesh mesh;
  mesh.header.dimension = 3;
  mesh.vertices.push_back({0, 0, 0});
  for (const double a : {-1000.0, 1000.0}) {
    for (const double b : {-1618.0, 1618.0}) {
      mesh.vertices.push_back({0, a, b});
      mesh.vertices.push_back({a, b, 0});
      mesh.vertices.push_back({b, 0, a});
    }
  }
  const auto second_neighbours = [&mesh](std::uint64_t u, std::uint64_t v) {
    double dot = 0;
    for (int k = 0; k < 3; ++k) dot += mesh.vertices[u][k] * mesh.vertices[v][k];
    return dot < 0 && dot > -3e6;
  };
  for (std::uint64_t a = 1; a <= 12; ++a) {
    for (std::uint64_t b = 1; b < a; ++b) {
      for (std::uint64_t c = 1; c < b; ++c) {
        if (second_neighbours(a, b) && second_neighbours(b, c) && second_neighbours(a, c)) {
          add_simplex<3>(mesh, {0, a, b, c});
        }
      }
    }
  }
  ASSERT_EQ(mesh.corners.size(), 20U * 4U);
  expect_fault(mesh, "the boundary is not one convex surface");
}

TEST(Checker3DTest, OneOfTheThreeCutsOfAnOctahedronIsCanonical) {
  int canonical = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Mesh mesh;
    mesh.header.dimension = 3;
    for (int k = 0; k < 3; ++k) {
      for (const double side : {-1.0, 1.0}) {
        mesh.vertices.emplace_back();
        mesh.vertices.back()[k] = side;
      }
    }
    const std::uint64_t along = 2 * axis;
    const std::uint64_t u = 2 * ((axis + 1) % 3);
    const std::uint64_t v = 2 * ((axis + 2) % 3);
    for (std::uint64_t i = 0; i < 4; ++i)
      add_simplex<3>(mesh, {along, along + 1, u + i / 2, v + i % 2});
    expect_proved(mesh, any_delaunay());
    canonical += check_mesh(mesh, {}).fault_count == 0 ? 1 : 0;
  }
  EXPECT_EQ(canonical, 1);
}

TEST(CheckerDimensionTest, OtherDimensionsAreRefused) {
  Mesh mesh;
  mesh.header.dimension = 7;
  EXPECT_THROW(check_mesh(mesh, {}), Failure);
  EXPECT_THROW(canonical_hash(mesh), Failure);
}

}  // namespace
}  // namespace spillway::test
