#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "src/distributed/box_tree.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/distributed/share.h"

namespace spillway::detail::distributed {

/// A simplex across ranks: the names of its vertices, positively oriented.
template <int D>
using NamedSimplex = std::array<RankIndex, D + 1>;

/// The share of one rank while it grows: from the triangulation of the rank's own points to the
/// share of larger and larger groups. A merge of two groups calls expose(), then accept(), and then
/// settle().
template <int D>
class GrowingShare {
 public:
  /// Starts with the triangulation of the rank's points, whose names are by input index.
  GrowingShare(int rank, const Triangulation<D>& triangulation,
               std::span<const NamedPoint<D>> points);

  /// Puts apart the simplices that a point in these boxes may change, and returns the names of
  /// their vertices, sorted.
  std::vector<RankIndex> expose(const BoxTree<D>& others);

  /// Ends a merge of the ranks below `middle` with those from there on, of which `open` are without
  /// simplices. Of the simplices of the border's triangulation whose vertex of the least name is
  /// this rank's, the new ones become part of the share, and of those put apart the ones that came
  /// back. `points` are those of their vertices that are owned elsewhere.
  void accept(const ItemsByRank<NamedSimplex<D>>& simplices,
              const ItemsByRank<NamedPoint<D>>& points, int middle,
              const std::array<bool, 2>& open);

  /// Simplices that no point in the boxes of `outside` may change are not looked at again.
  void settle(std::span<const BoxTree<D>* const> outside);

  /// The share, without vertices that occur nowhere; once, at the end.
  Share<D> take();

  [[nodiscard]] const Share<D>& share() const { return share_; }
  /// Of the affine hull of the points of all ranks that have been merged.
  void set_dimension(int dimension) { share_.dimension = dimension; }

 private:
  using Corners = typename Share<D>::Corners;

  [[nodiscard]] RankIndex name_of(VertexId v) const {
    return v == kInfiniteVertex ? kInfiniteName : share_.names[v];
  }
  [[nodiscard]] VertexId vertex_named(RankIndex name) const;
  void add_vertex(const NamedPoint<D>& point);

  int rank_;
  Share<D> share_;              ///< its simplices are those that are settled
  std::vector<Corners> open_;   ///< the others
  std::vector<Corners> apart_;  ///< exposed to the merge that goes on
  std::unordered_map<std::uint64_t, VertexId> foreign_;  ///< vertices of other ranks by name
};

}  // namespace spillway::detail::distributed
