#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "src/delaunay/common/triangulation.h"

namespace spillway::detail::distributed {

/// One of the things that are numbered at each rank for itself.
struct RankIndex {
  std::uint32_t rank = 0;
  std::uint32_t index = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const RankIndex&) const = default;
};

/// What one rank holds of a Delaunay triangulation over several: each vertex is owned by one rank,
/// and a rank's view has exactly the simplices, finite and infinite, with at least one vertex of
/// its own. So a simplex with vertices of several owners is in the view of each of them.
///
/// Simplices have no numbers across ranks. A neighbour that is not in the view is known by the
/// vertex that it has beyond the common facet; facet and vertex make it up, and every owner of one
/// of these vertices has it. (Such a facet has no vertex of this rank: else the neighbour were
/// here.)
template <int D>
struct View {
  std::size_t own = 0;           ///< vertices below are this rank's, the others belong elsewhere
  std::vector<Point<D>> points;  ///< by vertex
  /// By vertex: its name, the same at all ranks: its owner and its number there.
  std::vector<RankIndex> names;
  /// By vertex: which point it is: the rank that gave it, and as which of its points. Of equal
  /// points it is the least of these.
  std::vector<RankIndex> origins;
  /// Corners are numbers of vertices, or kInfiniteVertex; for neighbours see local() and beyond().
  std::vector<Simplex<D>> simplices;
  int dimension = -1;  ///< of the affine hull of all ranks' points; no simplices if less than D

  /// A point that equals another one; both are origins.
  struct Duplicate {
    RankIndex dropped;
    RankIndex kept;
  };
  std::vector<Duplicate> duplicates;  ///< those whose vertex this rank owns, sorted by `dropped`

  /// Whether the i-th neighbour of a simplex is in the view: simplices[simplex.neighbours[i]].
  [[nodiscard]] static bool local(const Simplex<D>& simplex, int i) {
    return simplex.neighbours[i] < Simplex<D>::kLink;
  }

  /// The vertex that the i-th neighbour of a simplex has beyond their common facet, or
  /// kInfiniteVertex.
  [[nodiscard]] VertexId beyond(const Simplex<D>& simplex, int i) const;

  /// What stands in `neighbours` for a neighbour elsewhere with this vertex beyond the facet.
  [[nodiscard]] static std::uint32_t elsewhere(VertexId vertex) {
    return vertex == kInfiniteVertex ? kInfiniteElsewhere : Simplex<D>::kLink + vertex;
  }

  /// Views hold fewer vertices, and fewer simplices, than this.
  static constexpr std::size_t kLimit = Simplex<D>::kLink - 2;

 private:
  static constexpr std::uint32_t kInfiniteElsewhere = SimplexList<D>::kUnlinked - 1;
};

}  // namespace spillway::detail::distributed
