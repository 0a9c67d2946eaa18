#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "src/delaunay/common/slab_array.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Number of a simplex: its list and its index there.
struct SimplexId {
  std::uint32_t list;
  std::uint32_t index;
  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const SimplexId&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// No simplex: answers a search that found none.
inline constexpr SimplexId kNoSimplex{~0U, ~0U};

/// A cell of D+1 vertices, positively oriented. In an infinite simplex one of them is
/// kInfiniteVertex, and any finite point beyond its facet, put in that place, makes it positive.
template <int D>
requires Dimension<D>
struct Simplex {
  std::array<VertexId, D + 1> vertices;
  /// Across the facet opposite vertices[i]: an index in the same list, or, from kLink on, kLink
  /// plus an index into the list's links.
  std::array<std::uint32_t, D + 1> neighbours;

  static constexpr std::uint32_t kLink = std::uint32_t{1} << 31;

  [[nodiscard]] bool removed() const { return vertices[0] == kNoVertex; }
  /// The place of the infinite vertex, or -1.
  [[nodiscard]] int infinite_corner() const {
    for (int i = 0; i <= D; ++i) {
      if (vertices[i] == kInfiniteVertex) return i;
    }
    return -1;
  }
  [[nodiscard]] bool infinite() const { return infinite_corner() >= 0; }
};

/// The simplices that one base case or one merge made. Neighbours in the same list cost four
/// bytes; the few in other lists are kept aside, so merging never renumbers or copies what is
/// already there.
template <int D>
struct SimplexList {
  SlabArray<Simplex<D>> simplices;  ///< some of them removed
  std::vector<SimplexId> links;     ///< neighbours in other lists

  [[nodiscard]] SimplexId neighbour(SimplexId simplex, int i) const {
    const std::uint32_t n = simplices[simplex.index].neighbours[i];
    return n < Simplex<D>::kLink ? SimplexId{simplex.list, n} : links[n - Simplex<D>::kLink];
  }

  /// Makes `other` the neighbour of `simplex` (one of this list's) opposite its i-th vertex.
  void set_neighbour(SimplexId simplex, int i, SimplexId other) {
    std::uint32_t& n = simplices[simplex.index].neighbours[i];
    if (other.list == simplex.list) {
      n = other.index;
    } else if (n >= Simplex<D>::kLink) {
      links[n - Simplex<D>::kLink] = other;
    } else {
      n = Simplex<D>::kLink + static_cast<std::uint32_t>(links.size());
      links.push_back(other);
    }
  }

  /// A neighbour that is still to be set.
  static constexpr std::uint32_t kUnlinked = ~0U;
};

/// A point that equals another one, and the vertex that stands for both.
struct DroppedDuplicate {
  VertexId dropped;
  VertexId kept;
  auto operator<=>(const DroppedDuplicate&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// A Delaunay triangulation in memory, finite and infinite simplices with their neighbours.
///
/// Vertices are numbered in the order of the k-d division, which keeps neighbours close in memory:
/// vertex v is point input_index[v] of the input. Of equal points only the first of the input is
/// used by simplices; the others are listed in `duplicates`.
///
/// If the points do not span D dimensions there are no simplices.
template <int D>
struct Triangulation {
  SlabArray<Point<D>> points;         ///< by vertex number, equal points included
  SlabArray<VertexId> input_index;    ///< by vertex number
  std::vector<SimplexList<D>> lists;  ///< in the order of the tree of merges, children first
  std::vector<SimplexId> hull;        ///< the infinite simplices, one for each facet of the hull
  std::vector<DroppedDuplicate> duplicates;  ///< sorted by the dropped point's vertex number
  /// Dimension of the points' affine hull: D, or less if there are no simplices; -1 without points.
  int dimension = -1;

  [[nodiscard]] const Simplex<D>& simplex(SimplexId id) const {
    return lists[id.list].simplices[id.index];
  }
  [[nodiscard]] SimplexId neighbour(SimplexId id, int i) const {
    return lists[id.list].neighbour(id, i);
  }

  /// Number of distinct points.
  [[nodiscard]] std::size_t vertex_count() const { return points.size() - duplicates.size(); }
  /// Number of finite simplices.
  [[nodiscard]] std::size_t finite_count() const;

  /// Calls f(id, simplex) for every simplex, finite and infinite, in the order of lists.
  template <typename F>
  void for_each_simplex(F&& f) const {
    for (std::uint32_t b = 0; b < lists.size(); ++b) {
      for (std::uint32_t i = 0; i < lists[b].simplices.size(); ++i) {
        const Simplex<D>& s = lists[b].simplices[i];
        if (!s.removed()) f(SimplexId{b, i}, s);
      }
    }
  }
};

}  // namespace spillway::delaunay
