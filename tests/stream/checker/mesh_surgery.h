#pragma once
// Looking things up in a mesh and cutting it about, for tests of the checker.

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "src/error.h"
#include "src/geometry/predicates.h"

namespace spillway::test {

template <int D>
Point<D> point_of(const Mesh& mesh, std::uint64_t vertex) {
  Point<D> p;
  std::copy_n(mesh.vertices[vertex].begin(), D, p.begin());
  return p;
}

template <int D>
int orientation_of(const Mesh& mesh, const std::vector<std::uint64_t>& vertices) {
  std::array<Point<D>, D + 1> simplex;
  for (int i = 0; i <= D; ++i) simplex[i] = point_of<D>(mesh, vertices[i]);
  return orientation<D>(simplex);
}

template <int D>
std::vector<std::uint64_t> simplex_of(const Mesh& mesh, std::uint64_t s) {
  const auto first = mesh.corners.begin() + static_cast<std::ptrdiff_t>(s * (D + 1));
  return {first, first + D + 1};
}

template <int D>
void add_simplex(Mesh& mesh, std::vector<std::uint64_t> vertices) {
  if (orientation_of<D>(mesh, vertices) < 0) std::swap(vertices[0], vertices[1]);
  mesh.corners.insert(mesh.corners.end(), vertices.begin(), vertices.end());
}

template <int D>
void remove_simplex(Mesh& mesh, std::uint64_t s) {
  const auto first = mesh.corners.begin() + static_cast<std::ptrdiff_t>(s * (D + 1));
  mesh.corners.erase(first, first + D + 1);
}

/// Facets, sorted, with the numbers of their simplices.
template <int D>
std::map<std::vector<std::uint64_t>, std::vector<std::uint64_t>> facets_of(const Mesh& mesh) {
  std::map<std::vector<std::uint64_t>, std::vector<std::uint64_t>> facets;
  for (std::uint64_t s = 0; s < mesh.corners.size() / (D + 1); ++s) {
    for (int i = 0; i <= D; ++i) {
      auto facet = simplex_of<D>(mesh, s);
      facet.erase(facet.begin() + i);
      std::sort(facet.begin(), facet.end());
      facets[facet].push_back(s);
    }
  }
  return facets;
}

template <int D>
std::uint64_t apex_of(const Mesh& mesh, std::uint64_t s, const std::vector<std::uint64_t>& facet) {
  for (const std::uint64_t v : simplex_of<D>(mesh, s)) {
    if (!std::binary_search(facet.begin(), facet.end(), v)) return v;
  }
  throw Failure("the simplex is a facet");
}

/// Replaces two simplices at a facet by the D ones around the line between their apexes (a 2-2 flip
/// in the plane, a 2-3 flip in space), at the first facet where that is possible and, if asked, all
/// D+2 points are on one sphere.
template <int D>
bool flip(Mesh& mesh, bool cospherical) {
  for (const auto& [facet, simplices] : facets_of<D>(mesh)) {
    if (simplices.size() != 2) continue;
    const std::uint64_t a = apex_of<D>(mesh, simplices[0], facet);
    const std::uint64_t b = apex_of<D>(mesh, simplices[1], facet);
    auto whole = facet;
    whole.push_back(a);
    const int sign = orientation_of<D>(mesh, whole);
    bool crosses = true;
    for (int i = 0; i < D; ++i) {
      auto replaced = whole;
      replaced[i] = b;
      crosses = crosses && orientation_of<D>(mesh, replaced) == sign;
    }
    std::array<Point<D>, D + 1> corners;
    const auto first = simplex_of<D>(mesh, simplices[0]);
    for (int i = 0; i <= D; ++i) corners[i] = point_of<D>(mesh, first[i]);
    const bool tie = side_of_sphere<D>(corners, point_of<D>(mesh, b)) == 0;
    if (!crosses || tie != cospherical) continue;
    remove_simplex<D>(mesh, std::max(simplices[0], simplices[1]));
    remove_simplex<D>(mesh, std::min(simplices[0], simplices[1]));
    for (int i = 0; i < D; ++i) {
      auto vertices = facet;
      vertices.erase(vertices.begin() + i);
      vertices.push_back(a);
      vertices.push_back(b);
      add_simplex<D>(mesh, vertices);
    }
    return true;
  }
  return false;
}

/// A simplex whose neighbours exist on all sides (or, if not wanted, one at the boundary).
template <int D>
std::uint64_t find_simplex(const Mesh& mesh, bool inner) {
  std::vector<int> open(mesh.corners.size() / (D + 1));
  for (const auto& [facet, simplices] : facets_of<D>(mesh)) {
    if (simplices.size() == 1) ++open[simplices[0]];
  }
  for (std::uint64_t s = 0; s < open.size(); ++s) {
    if ((open[s] == 0) == inner) return s;
  }
  throw Failure("the mesh has no such simplex");
}

}  // namespace spillway::test
