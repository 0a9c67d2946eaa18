// The proof of streams accepts every family's triangulation, however it is cut into blocks, refuses
// every way of spoiling it, and holds little more than the open border.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "stream/checker/checker.h"
#include "tests/stream/checker/mesh_streaming.h"
#include "tests/stream/checker/mesh_surgery.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

template <int D>
Mesh triangulated(const std::vector<Point<D>>& points) {
  Mesh mesh;
  mesh.header.dimension = D;
  const Triangulation<D> triangulation =
      delaunay_triangulation<D>(points, {.threads = 1, .leaf_points = 100});
  std::map<VertexId, std::uint64_t> number;
  triangulation.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    for (const VertexId vertex : simplex.vertices) {
      const auto [it, is_new] = number.try_emplace(vertex, number.size());
      mesh.corners.push_back(it->second);
      if (!is_new) continue;
      mesh.vertices.emplace_back();
      std::copy_n(triangulation.points[vertex].begin(), D, mesh.vertices.back().begin());
    }
  });
  return mesh;
}

// The triangulation as blocks hold it: vertices on the lattice, if the family has one.
template <int D>
Mesh triangulated(const GeneratorOptions& options) {
  Mesh mesh = triangulated<D>(generated_points<D>(options));
  const auto generator = make_generator(options);
  if (generator->lattice() != nullptr) mesh.header.lattice = *generator->lattice();
  return mesh;
}

// The same with output coordinates, as the proof of whole meshes takes it.
Mesh in_output_coordinates(Mesh mesh) {
  for (WorldPoint& vertex : mesh.vertices) {
    vertex = in_world(mesh.header.lattice, LatticePoint(vertex.numbers()));
  }
  return mesh;
}

// A stream of the mesh that ends with its true totals.
StreamInMemory stream_of(const Mesh& mesh, std::size_t simplices_in_block) {
  StreamInMemory stream = test::stream_of(mesh, simplices_in_block);
  const CheckReport whole = check_mesh(in_output_coordinates(mesh), {});
  stream.stream_totals.hull_facets = whole.hull_facets;
  stream.stream_totals.canonical_hash = whole.canonical_hash;
  return stream;
}

CheckReport check(StreamInMemory stream, const CheckerOptions& options = {}) {
  return check_mesh_stream(stream, options);
}

void expect_fault(const Mesh& mesh, const std::string& part, const CheckerOptions& options = {}) {
  for (const std::size_t block : {1, 50, 100000}) {
    const CheckReport report = check(stream_of(mesh, block), options);
    EXPECT_GT(report.fault_count, 0U);
    EXPECT_THAT(report.faults, Contains(HasSubstr(part))) << "blocks of " << block;
  }
}

template <typename Dimension>
class StreamProofTest : public ::testing::Test {
 protected:
  static constexpr int kD = Dimension::value;
  const std::string simplex_ = kD == 2 ? "triangle" : "tetrahedron";
  const Mesh good_ = triangulated<kD>(GeneratorOptions{.count = 300, .dimension = kD});
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(StreamProofTest, Dimensions);

TYPED_TEST(StreamProofTest, AcceptsEveryFamilyInBlocksOfEverySize) {
  constexpr int D = TypeParam::value;
  for (const std::string& name : family_names()) {
    const GeneratorOptions options{family_by_name(name), 700, D};
    const Mesh mesh = triangulated<D>(options);
    if (mesh.corners.empty()) continue;  // such as points on one line
    const CheckReport whole = check_mesh(in_output_coordinates(mesh), {});
    for (const std::size_t block : {1, 7, 300, 100000}) {
      const CheckReport report = check(stream_of(mesh, block));
      EXPECT_EQ(report.fault_count, 0U) << name << " in blocks of " << block;
      EXPECT_THAT(report.faults, ::testing::IsEmpty());
      EXPECT_EQ(report.vertices, whole.vertices);
      EXPECT_EQ(report.simplices, whole.simplices);
      EXPECT_EQ(report.hull_facets, whole.hull_facets);
      EXPECT_EQ(report.canonical_hash, whole.canonical_hash);
      EXPECT_EQ(report.on_lattice, whole.on_lattice);
    }
  }
}

TYPED_TEST(StreamProofTest, AcceptsSimplicesInRandomOrder) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  std::mt19937 random(1);  // NOLINT(bugprone-random-generator-seed)
  for (std::size_t s = mesh.corners.size() / (D + 1) - 1; s > 0; --s) {
    const std::size_t other = random() % (s + 1);
    for (int i = 0; i <= D; ++i) {
      std::swap(mesh.corners[s * (D + 1) + i], mesh.corners[other * (D + 1) + i]);
    }
  }
  for (const std::size_t block : {1, 10}) {
    EXPECT_EQ(check(stream_of(mesh, block)).fault_count, 0U);
  }
}

TYPED_TEST(StreamProofTest, ReportDoesNotDependOnThreads) {
  Mesh mesh = this->good_;
  ASSERT_TRUE(flip<TypeParam::value>(mesh, false));
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  CheckerOptions options;
  const CheckReport one = check(stream_of(mesh, 3), options);
  options.threads = 3;
  const CheckReport three = check(stream_of(mesh, 3), options);
  EXPECT_EQ(one.proved, three.proved);
  EXPECT_EQ(one.faults, three.faults);
  EXPECT_EQ(one.peak_live_vertices, three.peak_live_vertices);
}

TYPED_TEST(StreamProofTest, HoldsLittleMoreThanTheBorderOfASweep) {
  constexpr int D = TypeParam::value;
  const std::uint64_t count = D == 2 ? 90000 : 27000;
  const Family family = D == 2 ? Family::kLattice : Family::kUniform;  // hulls of few facets
  Mesh mesh = triangulated<D>(GeneratorOptions{.family = family, .count = count, .dimension = D});
  sort_along<D>(mesh, 0);
  const CheckReport report = check(stream_of(mesh, 100));
  EXPECT_EQ(report.fault_count, 0U);
  EXPECT_LT(report.peak_live_vertices, report.vertices / 4);
  EXPECT_LT(report.peak_open_facets, report.simplices / 10);
  EXPECT_GT(report.peak_open_facets, report.hull_facets / 2);
}

TYPED_TEST(StreamProofTest, RejectsAFlippedEdge) {
  Mesh mesh = this->good_;
  ASSERT_TRUE(flip<TypeParam::value>(mesh, false));
  expect_fault(mesh, "is not Delaunay");
  EXPECT_EQ(check(stream_of(mesh, 7)).other_ties, 0U);
  CheckerOptions any;
  any.any_delaunay = true;
  expect_fault(mesh, "is not Delaunay", any);
}

TYPED_TEST(StreamProofTest, RejectsATieBrokenTheOtherWayUnlessAnyDelaunayWillDo) {
  constexpr int D = TypeParam::value;
  std::mt19937 random(8);  // NOLINT(bugprone-random-generator-seed)
  std::vector<Point<D>> points(400);
  for (auto& point : points) {
    for (double& c : point) c = static_cast<double>(random() % (D == 2 ? 25 : 8));
  }
  Mesh mesh = triangulated<D>(points);
  ASSERT_TRUE(flip<D>(mesh, true));
  expect_fault(mesh, "as ties are broken");
  const CheckReport report = check(stream_of(mesh, 7));
  EXPECT_EQ(report.other_ties, report.fault_count);
  CheckerOptions any;
  any.any_delaunay = true;
  EXPECT_EQ(check(stream_of(mesh, 7), any).fault_count, 0U);
}

TYPED_TEST(StreamProofTest, RejectsAMissingSimplexInsideAndAtTheBoundary) {
  constexpr int D = TypeParam::value;
  for (const bool inner : {true, false}) {
    Mesh mesh = this->good_;
    remove_simplex<D>(mesh, find_simplex<D>(mesh, inner));
    expect_fault(mesh, "the boundary is not convex");
  }
}

TYPED_TEST(StreamProofTest, RejectsAMovedVertex) {
  constexpr int D = TypeParam::value;
  Mesh mesh = this->good_;
  for (int k = 0; k < D; ++k) mesh.vertices[100][k] += 0.3;
  expect_fault(mesh, "negatively oriented");
}

TYPED_TEST(StreamProofTest, RejectsAVertexOffTheLattice) {
  constexpr int D = TypeParam::value;
  Mesh mesh =
      triangulated<D>(GeneratorOptions{.family = Family::kLattice, .count = 400, .dimension = D});
  mesh.vertices[17][1] += 0.25;
  EXPECT_THAT(check(test::stream_of(mesh, 5)).faults,
              Contains(HasSubstr("is off the lattice: its y")));
}

TYPED_TEST(StreamProofTest, RejectsADuplicateSimplexNextToItAndFarFromIt) {
  constexpr int D = TypeParam::value;
  const auto add = [](Mesh& mesh, const std::vector<std::uint64_t>& vertices, std::size_t corner) {
    mesh.corners.insert(mesh.corners.begin() + static_cast<std::ptrdiff_t>(corner),
                        vertices.begin(), vertices.end());
  };
  for (const bool inner : {true, false}) {
    Mesh mesh = this->good_;
    const std::uint64_t s = find_simplex<D>(mesh, inner);
    const auto vertices = simplex_of<D>(mesh, s);
    add(mesh, vertices, s * (D + 1));
    expect_fault(mesh, "has the same vertices as " + this->simplex_);
    Mesh far = this->good_;
    add(far, vertices, far.corners.size());
    for (const std::size_t block : {1, 50, 100000}) {
      EXPECT_GT(check(stream_of(far, block)).fault_count, 0U);
    }
  }
}

TYPED_TEST(StreamProofTest, RejectsAMeshListedTwice) {
  Mesh mesh = this->good_;
  const auto once = mesh.corners;
  mesh.corners.insert(mesh.corners.end(), once.begin(), once.end());
  expect_fault(mesh, "the same");
}

TYPED_TEST(StreamProofTest, RejectsAMeshLaidOverItselfWithVerticesOfItsOwn) {
  Mesh mesh = this->good_;
  const auto once = mesh.corners;
  for (const std::uint64_t corner : once) mesh.corners.push_back(corner + mesh.vertices.size());
  const auto vertices = mesh.vertices;
  mesh.vertices.insert(mesh.vertices.end(), vertices.begin(), vertices.end());
  expect_fault(mesh, "the boundary covers itself");
}

TYPED_TEST(StreamProofTest, RejectsReversedOrientation) {
  Mesh mesh = this->good_;
  std::swap(mesh.corners[0], mesh.corners[1]);
  expect_fault(mesh, this->simplex_ + " 0 (vertices ");
  expect_fault(mesh, "negatively oriented");
}

TYPED_TEST(StreamProofTest, RejectsAVertexInNoSimplex) {
  Mesh mesh = this->good_;
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  expect_fault(mesh, "vertex 300 (0.5, 0.5");
  expect_fault(mesh, "is in no " + this->simplex_);
  StreamInMemory never_finalized = stream_of(mesh, 10);
  never_finalized.blocks.back().finalized.pop_back();
  EXPECT_EQ(check(never_finalized).fault_count, 1U);
}

TYPED_TEST(StreamProofTest, RejectsAStreamWithoutSimplices) {
  Mesh mesh;
  mesh.header.dimension = TypeParam::value;
  EXPECT_THAT(check(test::stream_of(mesh, 10)).faults, Contains(HasSubstr("the mesh has no ")));
}

TYPED_TEST(StreamProofTest, RejectsEveryWrongTotalAndAWrongHash) {
  const StreamInMemory good = stream_of(this->good_, 20);
  for (const auto total : {&MeshTotals::vertices, &MeshTotals::simplices, &MeshTotals::hull_facets,
                           &MeshTotals::canonical_hash}) {
    StreamInMemory stream = good;
    ++(stream.stream_totals.*total);
    const CheckReport report = check(stream);
    EXPECT_EQ(report.fault_count, 1U);
    EXPECT_THAT(report.faults, Contains(HasSubstr("but its trailer says")));
    StreamInMemory counted = stream;
    EXPECT_EQ(count_mesh_stream(counted, {}).faults, report.faults);
    stream.with_hash = false;
    EXPECT_EQ(check(stream).fault_count, 0U) << "formats without totals have none to compare";
  }
}

TYPED_TEST(StreamProofTest, CountingFindsTheSameNumbersAndHash) {
  StreamInMemory stream = stream_of(this->good_, 20);
  const CheckReport report = count_mesh_stream(stream, {});
  EXPECT_EQ(report.fault_count, 0U);
  EXPECT_EQ(report.hull_facets, stream.stream_totals.hull_facets);
  EXPECT_EQ(report.canonical_hash, stream.stream_totals.canonical_hash);
  EXPECT_EQ(report.simplices, stream.stream_totals.simplices);
}

TYPED_TEST(StreamProofTest, TakesTheInputsLatticeIfTheStreamHasNone) {
  constexpr int D = TypeParam::value;
  const IntegerLattice centimetres{{0.01, 0.01, 0.01}, {637000.1, 4850000.03, -20}};
  Mesh mesh =
      triangulated<D>(GeneratorOptions{.family = Family::kLattice, .count = 400, .dimension = D});
  mesh.header.lattice = centimetres;
  EXPECT_EQ(check(stream_of(mesh, 9)).fault_count, 0U);
  StreamInMemory plain = stream_of(mesh, 9);
  plain.stream_header.lattice.reset();
  for (MeshStreamBlock& block : plain.blocks) {
    for (LatticePoint& vertex : block.vertices) {
      vertex = LatticePoint(centimetres.to_world(vertex).numbers());
    }
  }
  CheckerOptions options;
  options.input_lattice = centimetres;
  const CheckReport report = check(plain, options);
  EXPECT_EQ(report.fault_count, 0U);
  EXPECT_TRUE(report.on_lattice);
}

TYPED_TEST(StreamProofTest, GivesOutVerticesInOutputCoordinatesAndProgress) {
  constexpr int D = TypeParam::value;
  Mesh mesh =
      triangulated<D>(GeneratorOptions{.family = Family::kTerrain, .count = 400, .dimension = D});
  std::vector<WorldPoint> vertices;
  double last_fraction = 0;
  CheckerOptions options;
  options.vertex = [&](const WorldPoint& vertex, std::span<const std::byte> further) {
    EXPECT_TRUE(further.empty());
    vertices.push_back(vertex);
  };
  options.progress = [&](std::uint64_t, std::optional<double> fraction) {
    last_fraction = *fraction;
  };
  check(stream_of(mesh, 9), options);
  std::vector<WorldPoint> expected = in_output_coordinates(mesh).vertices;
  std::sort(vertices.begin(), vertices.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(vertices, expected);
  EXPECT_EQ(last_fraction, 1);
}

}  // namespace
}  // namespace spillway::test
