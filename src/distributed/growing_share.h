#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/distributed/share.h"
#include "src/geometry/point.h"

namespace spillway::distributed {

/// A simplex across ranks: the names of its vertices, positively oriented.
template <int D>
using NamedSimplex = std::array<RankIndex, D + 1>;

/// Two groups of ranks that are merged: names of ranks below `middle` are of the lower half.
struct Halves {
  int middle = 0;
  std::array<bool, 2> open{};  ///< whether it has no simplices
};

/// What one rank holds of a triangulation that grows, from that of the rank's own points to that of
/// larger and larger groups: those simplices that may still change. Each knows its exposure: bit l
/// is set if the other half of the l-th merge, from the lowest on, may change it. A merge of two
/// groups calls put_apart(), then accept(), and then settle(), which also comes first of all.
template <int D>
class GrowingShare {
 public:
  using Corners = std::array<VertexId, D + 1>;

  /// Starts with the triangulation of the rank's points, none of them equal, and the dimension of
  /// their affine hull. A point's name is the rank's number and its place.
  GrowingShare(int rank, std::vector<Point<D>> points, std::vector<Corners> simplices,
               int dimension);

  [[nodiscard]] std::span<const Corners> simplices() const { return simplices_; }
  /// The first are the rank's own, the others those of other ranks in its simplices.
  [[nodiscard]] std::span<const Point<D>> points() const { return points_; }
  [[nodiscard]] std::span<const RankIndex> names() const { return names_; }
  [[nodiscard]] VertexId own_points() const { return own_; }

  /// Of the affine hull of the points of all ranks that have been merged.
  [[nodiscard]] int dimension() const { return dimension_; }
  void set_dimension(int dimension) { dimension_ = dimension; }

  /// Puts apart the simplices that the other half of this merge may change, and returns the names
  /// of their vertices, sorted.
  std::vector<RankIndex> put_apart(unsigned merge);

  /// Ends a merge. Of the simplices of the border's triangulation whose vertex of the least name is
  /// this rank's, the new ones become part of the share, and of those put apart the ones that came
  /// back. `points` are those of their vertices that are owned elsewhere.
  void accept(const ItemsByRank<NamedSimplex<D>>& simplices,
              const ItemsByRank<NamedPoint<D>>& points, const Halves& halves);

  /// The simplices whose exposure is not known yet.
  [[nodiscard]] std::span<const Corners> unsettled() const {
    return simplices().subspan(exposure_.size());
  }

  /// Tells the exposure of those; takes out the ones that nothing may change, and returns them.
  std::vector<Corners> settle(std::span<const std::uint32_t> exposure);

  /// Forgets points of other ranks that its simplices do not have any more.
  void drop_unused_points();

  /// That it takes of memory.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  [[nodiscard]] VertexId vertex_named(RankIndex name) const;
  void add_point(const NamedPoint<D>& point);

  int rank_;
  VertexId own_;
  int dimension_;
  std::vector<Point<D>> points_;
  std::vector<RankIndex> names_;
  std::vector<Corners> simplices_;
  std::vector<std::uint32_t> exposure_;                  ///< of simplices, the first ones
  std::vector<Corners> apart_;                           ///< exposed to the merge that goes on
  std::unordered_map<std::uint64_t, VertexId> foreign_;  ///< points of other ranks by name
};

}  // namespace spillway::distributed
