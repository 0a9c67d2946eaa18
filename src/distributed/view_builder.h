#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "src/delaunay/border/conflict_region.h"
#include "src/delaunay/border/find_border.h"
#include "src/delaunay/common/triangulation.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/distributed/view.h"
#include "src/geometry/box.h"

namespace spillway::detail::distributed {

/// The name of the infinite vertex.
inline constexpr RankIndex kInfiniteName{~0U, ~0U};

/// The boxes of some ranks, as a tree for ConflictRegion::may_meet_leaf.
template <int D>
struct BoxTree {
  Box<D> box;
  std::vector<BoxTree> children;
};
template <int D>
BoxTree<D> tree_of_boxes(std::span<const Box<D>> boxes);

/// A simplex across ranks: the names of its vertices, positively oriented.
template <int D>
using NamedSimplex = std::array<RankIndex, D + 1>;

/// Tells the owner of vertex `here` that its simplex of that vertex and the facet has a new
/// neighbour across the facet.
template <int D>
struct NeighbourUpdate {
  std::array<RankIndex, D> facet;
  RankIndex here;
  NamedPoint<D> beyond;  ///< the neighbour's other vertex; its position means nothing if infinite
};

/// The view of one rank while it grows: from the triangulation of the rank's own points to the view
/// of larger and larger groups. A merge of two groups calls the functions in the order in which
/// they stand here. Vertices are named throughout by their owner and their number there.
template <int D>
class ViewBuilder {
 public:
  /// The vertices of simplices that a point in these boxes may change, sorted; those of other ranks
  /// among them. The search starts at simplices that are infinite or have vertices elsewhere:
  /// what a point destroys is connected to the hull through facets, and no such path leaves or
  /// enters a view but by a simplex with vertices elsewhere.
  std::vector<RankIndex> find_border(const BoxTree<D>& others);

  /// Takes over, of the simplices of the border's triangulation that have an own vertex, those that
  /// span the groups, and those of the own group that the view has, facing the same way; or all of
  /// them, if the own group is open. `points` has the vertices of other ranks. Border simplices
  /// that are not found again are removed. The own group is [first_rank, end_rank).
  void accept(const ItemsByRank<NamedSimplex<D>>& simplices,
              const ItemsByRank<NamedPoint<D>>& points, int first_rank, int end_rank, bool open);

  /// Links simplices of the view across the facets where something is new. Returns what other ranks
  /// cannot see in their own views, one of the owners of the facet telling it to them.
  [[nodiscard]] ItemsByRank<NeighbourUpdate<D>> link();

  /// Links simplices to neighbours that are not in the view.
  void apply(const ItemsByRank<NeighbourUpdate<D>>& updates);

  /// Closes the gaps between simplices, and forgets vertices that occur nowhere. No merge may
  /// follow.
  void compact();

  View<D> view;  ///< `origins` of own vertices only

  /// Starts with the triangulation of the rank's points, whose names are by input index.
  ViewBuilder(int rank, const Triangulation<D>& triangulation,
              std::span<const NamedPoint<D>> points);

 private:
  using Corners = std::array<VertexId, D + 1>;
  using Facet = std::array<VertexId, D>;

  /// A facet across which a simplex may get another neighbour.
  struct OpenFacet {
    Facet vertices;  ///< sorted
    std::uint32_t simplex;
    int corner;  ///< of the simplex's vertex opposite
    bool operator<(const OpenFacet& other) const { return vertices < other.vertices; }
  };

  [[nodiscard]] VertexId vertex_named(RankIndex name) const;
  VertexId add_vertex(const NamedPoint<D>& point);
  [[nodiscard]] RankIndex name_of(VertexId v) const {
    return v == kInfiniteVertex ? kInfiniteName : view.names[v];
  }
  [[nodiscard]] bool is_own(VertexId v) const { return v < view.own; }
  [[nodiscard]] OpenFacet facet_of(std::uint32_t simplex, int corner) const;
  [[nodiscard]] bool has_own_vertex(const Facet& facet) const;
  [[nodiscard]] bool is_new(std::uint32_t simplex) const { return simplex >= first_new_; }
  [[nodiscard]] bool is_removed(std::uint32_t simplex) const {
    return view.simplices[simplex].removed();
  }
  void collect_open_facets();
  void tell(const OpenFacet& facet, const OpenFacet& other,
            ItemsByRank<NeighbourUpdate<D>>& updates) const;
  void check_linked() const;

  int rank_;
  std::unordered_map<std::uint64_t, VertexId> foreign_;  ///< vertices of other ranks by name
  std::vector<std::uint32_t> surface_;  ///< simplices that are infinite or have vertices elsewhere
  std::vector<Mark> marks_;             ///< by simplex
  std::vector<std::uint32_t> border_;
  std::uint32_t first_new_ = 0;
  std::vector<OpenFacet> open_facets_;  ///< sorted
};

}  // namespace spillway::detail::distributed
