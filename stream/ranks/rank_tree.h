#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/distributed/ranks.h"
#include "stream/ranks/exchange/rank_division.h"
#include "stream/tiles/tile_tree.h"
#include "stream/triangulate/tile_triangulation.h"

namespace spillway::detail {

/// The tree of all tiles of all ranks, and its top, where ranks merge what their tiles have left.
template <int D>
class RankTree {
 public:
  /// A rank's tiles, or a merge of two nodes below.
  struct Node {
    const TileNode<D>* tiles = nullptr;
    int leader = 0;                        ///< the rank that does it: the first of those below
    std::uint32_t level = 0;               ///< 0: a rank's tiles
    std::array<std::uint32_t, 2> below{};  ///< numbers of nodes, of a merge
    Outside<D> outside;                    ///< all tiles that are not its own

    [[nodiscard]] bool is_merge() const { return level > 0; }
  };

  /// Collective. `own` are the tiles of this rank, if it has points.
  RankTree(const RankDivision& division, const std::optional<TileNode<D>>& own,
           const distributed::Ranks& ranks);
  RankTree(const RankTree&) = delete;
  RankTree& operator=(const RankTree&) = delete;

  /// In post-order: children before parents, the root last. None if no rank has points.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  /// The node of this rank's tiles, if it has any. Its tree is that of `own`, with what it tells of
  /// storage.
  [[nodiscard]] std::optional<std::uint32_t> own_node() const { return own_; }

 private:
  /// The top of the tree while it is made: a rank, or two sides.
  struct Shape {
    int rank = -1;
    std::vector<Shape> sides;
  };
  struct Subtree {
    TileNode<D> tiles;
    Shape shape;
  };

  std::optional<Subtree> subtree_at(const RankDivision& division, CutTree::NodeRef ref,
                                    std::vector<std::optional<TileNode<D>>>& trees) const;
  std::uint32_t add_node(const TileNode<D>& tiles, const Shape& shape, const Outside<D>& outside,
                         int own_rank);

  TileNode<D> root_;
  std::vector<Node> nodes_;
  std::optional<std::uint32_t> own_;
};

}  // namespace spillway::detail
