// The proof in four to six dimensions, of meshes in memory and of streams: right meshes are proved,
// and each kind of damage is found.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "src/delaunay/delaunay.h"
#include "src/generators/generators.h"
#include "src/geometry/dimensions.h"
#include "stream/checker/checker.h"
#include "tests/stream/checker/mesh_streaming.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

template <int D>
Mesh mesh_of(const std::vector<Point<D>>& points) {
  Mesh mesh;
  mesh.header.dimension = D;
  mesh.header.attributes = further_coordinates(D);
  const Triangulation<D> all = delaunay_triangulation<D>(points, {.threads = 1});
  for (const Point<D>& point : all.points) {
    mesh.vertices.emplace_back(own_coordinates<D>(point));
    append_further_coordinates<D>(point, mesh.attributes);
  }
  all.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    mesh.corners.insert(mesh.corners.end(), simplex.vertices.begin(), simplex.vertices.end());
  });
  return mesh;
}

CheckReport proof_of(const Mesh& mesh, const CheckerOptions& options = {}) {
  const CheckReport whole = check_mesh(mesh, options);
  StreamInMemory stream = stream_of(mesh, 50);
  stream.with_hash = false;
  const CheckReport streamed = check_mesh_stream(stream, options);
  EXPECT_EQ(whole.fault_count == 0, streamed.fault_count == 0);
  EXPECT_EQ(whole.canonical_hash, streamed.canonical_hash);
  EXPECT_EQ(whole.other_ties, streamed.other_ties);
  if (whole.fault_count == 0) {
    EXPECT_EQ(whole.hull_facets, streamed.hull_facets);
  }
  return whole;
}

class ProofOfHigherDimension : public ::testing::TestWithParam<int> {
 protected:
  template <typename F>
  static void for_dimension(F&& f) {
    with_dimension(GetParam(), [&](auto d) {
      if constexpr (d > 3) f(d);
    });
  }
  static std::uint64_t some_points() { return GetParam() == 4 ? 150 : GetParam() == 5 ? 60 : 30; }
  static std::uint64_t lattice_points() { return GetParam() == 4 ? 81 : 1U << GetParam(); }
};

TEST_P(ProofOfHigherDimension, HoldsOfEveryFamily) {
  for_dimension([](auto d) {
    for (const Family family :
         {Family::kUniform, Family::kLattice, Family::kCircle, Family::kLines, Family::kClusters}) {
      SCOPED_TRACE(family_names()[static_cast<std::size_t>(family)]);
      const std::uint64_t count = family == Family::kLattice ? lattice_points() : some_points();
      const CheckReport report =
          proof_of(mesh_of<d>(generated_points<d>({.family = family, .count = count})));
      EXPECT_EQ(report.fault_count, 0U) << report.faults.front();
    }
  });
}

/// Then many boundary facets lie in one hyperplane, side by side in all ways that simplices can.
TEST_P(ProofOfHigherDimension, HoldsWhereAllPointsAreOnTheSidesOfABox) {
  for_dimension([](auto d) {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      auto points = generated_points<d>({.count = d == 4 ? 60U : 35U, .seed = seed});
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (int k = 0; k < 3; ++k) points[i][k] = (i >> k) % 2 == 0 ? 0 : 1;
      }
      const CheckReport report = proof_of(mesh_of<d>(points));
      EXPECT_EQ(report.fault_count, 0U) << report.faults.front();
    }
  });
}

/// A sphere that covers itself: each facet comes twice, by simplices of their own vertices.
TEST_P(ProofOfHigherDimension, FindsABoundaryThatCoversItself) {
  for_dimension([](auto d) {
    Mesh mesh = mesh_of<d>(generated_points<d>({.count = d + 3U}));
    const Mesh once = mesh;
    mesh.vertices.insert(mesh.vertices.end(), once.vertices.begin(), once.vertices.end());
    mesh.attributes.insert(mesh.attributes.end(), once.attributes.begin(), once.attributes.end());
    for (const std::uint64_t c : once.corners) mesh.corners.push_back(c + once.vertices.size());
    StreamInMemory stream = stream_of(mesh, 50);
    stream.with_hash = false;
    EXPECT_THAT(check_mesh_stream(stream, {}).faults,
                Contains(HasSubstr("the boundary covers itself")));
  });
}

TEST_P(ProofOfHigherDimension, FindsAMissingSimplex) {
  for_dimension([](auto d) {
    Mesh mesh = mesh_of<d>(generated_points<d>({.count = some_points()}));
    const auto middle = static_cast<std::ptrdiff_t>(mesh.corners.size() / (2 * (d + 1)) * (d + 1));
    mesh.corners.erase(mesh.corners.begin() + middle, mesh.corners.begin() + middle + d + 1);
    EXPECT_GT(proof_of(mesh).fault_count, 0U);
  });
}

TEST_P(ProofOfHigherDimension, FindsASimplexThatIsThereTwiceOrTurned) {
  for_dimension([](auto d) {
    const Mesh good = mesh_of<d>(generated_points<d>({.count = some_points()}));
    Mesh twice = good;
    twice.corners.insert(twice.corners.end(), good.corners.begin(), good.corners.begin() + d + 1);
    EXPECT_THAT(proof_of(twice).faults, Contains(HasSubstr("has the same vertices as simplex 0")));
    Mesh turned = good;
    std::swap(turned.corners[0], turned.corners[1]);
    EXPECT_THAT(proof_of(turned).faults, Contains(HasSubstr("is negatively oriented")));
  });
}

TEST_P(ProofOfHigherDimension, FindsAVertexThatMovedAlongTheLastAxis) {
  for_dimension([](auto d) {
    Mesh mesh = mesh_of<d>(generated_points<d>({.count = some_points()}));
    const double moved = 0.03;
    std::memcpy(&mesh.attributes[(d - 3) * sizeof(double) * 7 + (d - 4) * sizeof(double)], &moved,
                sizeof(moved));
    EXPECT_GT(proof_of(mesh).fault_count, 0U);
  });
}

/// A lattice seen in a mirror has the simplices of other ties.
TEST_P(ProofOfHigherDimension, TellsOtherTiesFromThoseOfTheRule) {
  for_dimension([](auto d) {
    auto points = generated_points<d>({.family = Family::kLattice, .count = lattice_points()});
    for (auto& point : points) point[d - 1] = -point[d - 1];
    Mesh mesh = mesh_of<d>(points);
    for (std::size_t at = (d - 4) * sizeof(double); at < mesh.attributes.size();
         at += (d - 3) * sizeof(double)) {
      double last = 0;
      std::memcpy(&last, &mesh.attributes[at], sizeof(last));
      last = 0 - last;
      std::memcpy(&mesh.attributes[at], &last, sizeof(last));
    }
    for (std::size_t s = 0; s < mesh.corners.size(); s += d + 1) {
      std::swap(mesh.corners[s], mesh.corners[s + 1]);
    }
    const CheckReport report = proof_of(mesh);
    EXPECT_GT(report.fault_count, 0U);
    EXPECT_GT(report.other_ties, 0U);
    EXPECT_EQ(report.other_ties, report.fault_count);
    CheckerOptions any;
    any.any_delaunay = true;
    EXPECT_EQ(proof_of(mesh, any).fault_count, 0U);
  });
}

TEST(ProofOfFourDimensions, NamesAllCoordinatesOfAVertex) {
  Mesh mesh = mesh_of<4>({{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1.5}});
  mesh.vertices.emplace_back(2, 2, 2);
  append_further_coordinates<4>({2, 2, 2, 7}, mesh.attributes);
  EXPECT_THAT(proof_of(mesh).faults, Contains("vertex 5 (2, 2, 2, 7) is in no simplex"));
}

INSTANTIATE_TEST_SUITE_P(Of, ProofOfHigherDimension, ::testing::Values(4, 5, 6));

}  // namespace
}  // namespace spillway::test
