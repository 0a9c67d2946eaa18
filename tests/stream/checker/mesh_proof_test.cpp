// The steps of the proof of a whole mesh, each by itself: facets as seen from outside, apexes, and
// the boundary.

#include "stream/checker/mesh_proof.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "src/geometry/predicates.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <int D>
Mesh mesh_of(const std::vector<Point<3>>& vertices, std::vector<std::uint64_t> corners) {
  Mesh mesh;
  mesh.header.dimension = D;
  for (const Point<3>& vertex : vertices) mesh.vertices.emplace_back(vertex);
  mesh.corners = std::move(corners);
  return mesh;
}

template <int D>
MeshView<D> view_of(const Mesh& mesh, const MeshNumbers* numbers = nullptr) {
  MeshView<D> view(mesh, numbers);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::copy_n(mesh.vertices[v].begin(), D, view.points()[v].begin());
  }
  return view;
}

/// The facets that one simplex has.
template <int D>
std::vector<BoundaryFacet<D>> boundary_of(const MeshView<D>& mesh) {
  std::map<std::array<std::uint64_t, D>, std::vector<BoundaryFacet<D>>> facets;
  for (std::uint64_t s = 0; s < mesh.simplex_count(); ++s) {
    for (int i = 0; i <= D; ++i) {
      const BoundaryFacet<D> facet{mesh.facet(s, i), s};
      auto sorted = facet.vertices;
      std::sort(sorted.begin(), sorted.end());
      facets[sorted].push_back(facet);
    }
  }
  std::vector<BoundaryFacet<D>> boundary;
  for (const auto& [sorted, of] : facets) {
    if (of.size() == 1) boundary.push_back(of.front());
  }
  return boundary;
}

template <int D>
std::vector<std::string> boundary_faults(const Mesh& mesh) {
  CheckReport report;
  Faults faults(report, 100);
  const MeshView<D> view = view_of<D>(mesh);
  prove_boundary<D>(view, boundary_of<D>(view), faults);
  EXPECT_EQ(faults.count(), report.faults.size());
  return report.faults;
}

TEST(MeshProof, RunsOfFacesAreFoundInAnyOrder) {
  std::vector<Face<2>> faces = {{{3, 4}, 0}, {{1, 2}, 1}, {{3, 4}, 2}, {{1, 9}, 3}, {{3, 4}, 4}};
  std::map<std::array<std::uint64_t, 2>, std::size_t> runs;
  for_each_run(faces,
               [&runs](const Face<2>* first, std::size_t count) { runs[first->vertices] = count; });
  EXPECT_EQ(runs, (decltype(runs){{{1, 2}, 1}, {{1, 9}, 1}, {{3, 4}, 3}}));
}

TEST(MeshProof, FacetsAreListedWithTheirOutsidePositive) {
  const Mesh mesh = mesh_of<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 3});
  const MeshView<3> view = view_of<3>(mesh);
  const int inside = orientation<3>(view.simplex(0));
  for (int i = 0; i < 4; ++i) {
    const int apex = orientation<3>(view.simplex(view.facet(0, i), view.corner(0, i)));
    EXPECT_EQ(apex, -inside) << i;
  }
}

TEST(MeshProof, FaultsCallVerticesByOtherNumbersIfThereAreSome) {
  const Mesh mesh = mesh_of<2>({{0, 0, 5}, {1.5, 0, 5}, {0, 1, 5}}, {0, 1, 2});
  EXPECT_EQ(view_of<2>(mesh).vertex_text(1), "vertex 1 (1.5, 0)");
  const MeshNumbers numbers{{70, 80, 90}, {6}};
  const MeshView<2> view = view_of<2>(mesh, &numbers);
  EXPECT_EQ(view.vertex_text(1), "vertex 80 (1.5, 0)");
  EXPECT_EQ(view.simplex_text(0), "triangle 6 (vertices 70, 80, 90 at (0, 0), (1.5, 0), (0, 1))");
}

TEST(MeshProof, AnApexOnTheCircleIsRightForOneOfTwoDiagonals) {
  const Point<2> a{0, 0};
  const Point<2> b{1, 0};
  const Point<2> c{1, 1};
  const Point<2> d{0, 1};
  CheckerOptions any;
  any.any_delaunay = true;
  EXPECT_THAT((std::array{apex_side<2>({a, b, c}, d, {}), apex_side<2>({a, b, d}, c, {})}),
              ::testing::UnorderedElementsAre(ApexSide::kOutside, ApexSide::kInsideByTie));
  EXPECT_EQ(apex_side<2>({a, b, c}, d, any), ApexSide::kOutside);
  EXPECT_EQ(apex_side<2>({a, b, d}, c, any), ApexSide::kOutside);
  EXPECT_EQ(apex_side<2>({a, b, c}, {0.1, 0.9}, any), ApexSide::kInside);
  EXPECT_EQ(apex_side<2>({a, b, c}, {0.1, 0.9}, {}), ApexSide::kInside);
  EXPECT_EQ(apex_side<2>({a, b, c}, {-1, 2}, {}), ApexSide::kOutside);
}

TEST(BoundaryProof, AcceptsOneConvexSurface) {
  EXPECT_THAT(boundary_faults<2>(mesh_of<2>({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}},
                                            {0, 4, 3, 4, 2, 3, 4, 1, 2})),
              IsEmpty())
      << "a vertex may lie straight between two";
  EXPECT_THAT(
      boundary_faults<3>(mesh_of<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 3})),
      IsEmpty());
}

TEST(BoundaryProof, RefusesADent) {
  EXPECT_THAT(boundary_faults<2>(mesh_of<2>({{0, 0}, {4, 0}, {1, 1}, {0, 4}}, {0, 1, 2, 0, 2, 3})),
              Contains(HasSubstr("the boundary is not convex at vertex 2")));
}

TEST(BoundaryProof, RefusesPartsThatTouchInAVertex) {
  EXPECT_THAT(boundary_faults<2>(
                  mesh_of<2>({{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}, {0, 1, 2, 0, 3, 4})),
              Contains(HasSubstr("is in 4 edges of the boundary instead of 2")));
}

TEST(BoundaryProof, RefusesPartsThatLieApart) {
  const auto faults = boundary_faults<2>(
      mesh_of<2>({{0, 0}, {1, 0}, {0, 1}, {10, 10}, {11, 10}, {10, 11}}, {0, 1, 2, 3, 4, 5}));
  EXPECT_THAT(faults, Not(IsEmpty()));
  EXPECT_THAT(faults, Each(HasSubstr("the boundary is not one convex surface")));
}

TEST(BoundaryProof, RefusesAHole) {
  // A square ring around a square hole.
  EXPECT_THAT(boundary_faults<2>(mesh_of<2>(
                  {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}},
                  {0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7})),
              Contains(HasSubstr("not convex")));
}

TEST(BoundaryProof, RefusesASecondCover) {
  // Two triangles of the same place, with vertices of their own.
  EXPECT_THAT(boundary_faults<2>(
                  mesh_of<2>({{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}, {0, 1, 2, 3, 4, 5})),
              Contains(HasSubstr("the boundary covers itself")));
}

TEST(FaultText, DescribesAFewAndCountsAll) {
  CheckReport report;
  Faults faults(report, 2);
  for (int i = 0; i < 5; ++i) faults.add("fault {}", i);
  CheckReport other;
  Faults(other, 9).add("of another");
  faults.add(other);
  EXPECT_EQ(faults.count(), 6U);
  EXPECT_THAT(report.faults, ElementsAre("fault 0", "fault 1"));
}

TEST(FaultText, NamesVerticesAndSimplices) {
  EXPECT_EQ(vertex_text<3>({7, {1.5, 2, -3}}), "vertex 7 (1.5, 2, -3)");
  EXPECT_EQ((simplex_text<2>(3, {{{5, {0, 0}}, {6, {1, 0}}, {7, {0, 1}}}})),
            "triangle 3 (vertices 5, 6, 7 at (0, 0), (1, 0), (0, 1))");
}

}  // namespace
}  // namespace spillway::test
