#pragma once
// The proof behind check_mesh, for one dimension. What its steps prove together, and why, is
// written in docs/algorithm-checker.md.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "stream/checker/checker.h"
#include "stream/checker/fault_text.h"

namespace spillway::checker {

/// A face as the sorted numbers of its K vertices, and whose face it is.
template <std::size_t K>
struct Face {
  std::array<std::uint64_t, K> vertices;
  std::uint64_t owner;
  auto operator<=>(const Face&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Sorts the faces and calls f(first, count) for each run of equal ones.
template <std::size_t K, typename F>
void for_each_run(std::vector<Face<K>>& faces, F&& f);

/// A facet that only one simplex has, listed so that orientation(facet, p) is positive for p
/// outside.
template <int D>
struct BoundaryFacet {
  std::array<std::uint64_t, D> vertices;
  std::uint64_t simplex;
};

/// Numbers by which faults call vertices and simplices, where they are others than the mesh's.
struct MeshNumbers {
  std::vector<std::uint64_t> vertices;
  std::vector<std::uint64_t> simplices;
};

/// A mesh whose vertex numbers are valid, seen by the proof: the coordinates that predicates run
/// on, and words for faults.
template <int D>
class MeshView {
 public:
  explicit MeshView(const Mesh& mesh, const MeshNumbers* numbers = nullptr)
      : mesh_(mesh), numbers_(numbers), points_(mesh.vertices.size()) {}

  /// Coordinates for the predicates, to be filled in.
  [[nodiscard]] std::vector<Point<D>>& points() { return points_; }
  [[nodiscard]] const Point<D>& point(std::uint64_t vertex) const { return points_[vertex]; }

  [[nodiscard]] std::uint64_t vertex_count() const { return points_.size(); }
  [[nodiscard]] std::uint64_t simplex_count() const { return mesh_.corners.size() / (D + 1); }
  [[nodiscard]] std::uint64_t corner(std::uint64_t simplex, int i) const {
    return mesh_.corners[simplex * (D + 1) + i];
  }
  [[nodiscard]] std::array<Point<D>, D + 1> simplex(std::uint64_t number) const {
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) points[i] = points_[corner(number, i)];
    return points;
  }
  /// The simplex of a facet's vertices and one more.
  [[nodiscard]] std::array<Point<D>, D + 1> simplex(const std::array<std::uint64_t, D>& facet,
                                                    std::uint64_t last) const {
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i < D; ++i) points[i] = points_[facet[i]];
    points[D] = points_[last];
    return points;
  }
  /// The facet opposite a simplex's i-th vertex, listed so that its outside is positive if the
  /// simplex is positively oriented.
  [[nodiscard]] std::array<std::uint64_t, D> facet(std::uint64_t simplex, int i) const {
    std::array<std::uint64_t, D> vertices;
    for (int j = 0, k = 0; j <= D; ++j) {
      if (j != i) vertices[k++] = corner(simplex, j);
    }
    if ((D - i) % 2 == 0) std::swap(vertices[0], vertices[1]);
    return vertices;
  }

  /// "vertex 7 (1.5, 2)", in output coordinates.
  [[nodiscard]] std::string vertex_text(std::uint64_t vertex) const {
    return spillway::checker::vertex_text<D>(named(vertex));
  }
  /// "triangle 3 (vertices 5, 6, 7 at (0, 0), (1, 0), (0, 1))".
  [[nodiscard]] std::string simplex_text(std::uint64_t simplex) const;
  /// "edge 5, 7 at (0, 0), (1, 0)" for a face of any dimension, called as given.
  template <std::size_t K>
  [[nodiscard]] std::string face_text(const char* name,
                                      const std::array<std::uint64_t, K>& face) const {
    std::array<NamedVertex<D>, K> vertices;
    for (std::size_t i = 0; i < K; ++i) vertices[i] = named(face[i]);
    return fmt::format("{} {}", name, list_text<D>(vertices));
  }

 private:
  [[nodiscard]] NamedVertex<D> named(std::uint64_t vertex) const;

  const Mesh& mesh_;
  const MeshNumbers* numbers_;
  std::vector<Point<D>> points_;
};

/// How the apex of one simplex at a facet lies to the circumsphere of the other, ties broken as
/// `options` says.
template <int D>
ApexSide apex_side(const std::array<Point<D>, D + 1>& simplex, const Point<D>& apex,
                   const CheckerOptions& options);

/// Runs the whole proof and writes its outcome into the report.
template <int D>
void prove_mesh(const Mesh& mesh, const CheckerOptions& options, CheckReport& report);

/// The part about the boundary: adds a fault unless the facets form one convex surface around the
/// simplices. Each facet's simplex must be positively oriented.
template <int D>
void prove_boundary(const MeshView<D>& mesh, const std::vector<BoundaryFacet<D>>& boundary,
                    Faults& faults);

template <std::size_t K, typename F>
void for_each_run(std::vector<Face<K>>& faces, F&& f) {
  std::sort(faces.begin(), faces.end());
  for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
    while (last < faces.size() && faces[last].vertices == faces[first].vertices) ++last;
    f(&faces[first], last - first);
  }
}

}  // namespace spillway::checker
