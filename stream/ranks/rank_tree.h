#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/distributed/ranks.h"
#include "stream/ranks/exchange/rank_division.h"
#include "stream/tiles/tile_tree.h"
#include "stream/triangulate/tile_triangulation.h"

namespace spillway::ranks {

/// The sections of a merge between ranks come in this order, in each step those of all its members.
enum class MergeStep : std::uint8_t {
  kAnnounce,  ///< vertices
  kEmit,      ///< simplices
  kFinalize,  ///< vertices that come no more
};
inline constexpr int kMergeSteps = 3;

/// The tree of all tiles of all ranks, and its top, where ranks merge what their tiles have left.
template <int D>
class RankTree {
 public:
  /// A rank's tiles, or a merge of two nodes below. Its members are the ranks below that have
  /// points: from `first` until `end`, as numbers of members().
  struct Node {
    const TileNode<D>* tiles = nullptr;
    int first = 0;
    int end = 0;
    std::uint32_t level = 0;               ///< 0: a rank's tiles
    std::array<std::uint32_t, 2> below{};  ///< numbers of nodes, of a merge
    Outside<D> outside;                    ///< all tiles that are not its own
    std::uint32_t first_section = 0;       ///< of the stream

    [[nodiscard]] bool is_merge() const { return level > 0; }
    /// The section that a member writes in a step of a merge (MergeStep), or its tiles'.
    [[nodiscard]] std::uint32_t section(int member, MergeStep step = MergeStep::kAnnounce) const {
      return first_section +
             static_cast<std::uint32_t>(static_cast<int>(step) * (end - first) + member - first);
    }
    [[nodiscard]] std::uint32_t sections() const {
      return static_cast<std::uint32_t>((end - first) * (is_merge() ? kMergeSteps : 1));
    }
  };

  /// Collective. `own` are the tiles of this rank, if it has points.
  RankTree(const RankDivision& division, const std::optional<TileNode<D>>& own,
           const distributed::Ranks& ranks);
  RankTree(const RankTree&) = delete;
  RankTree& operator=(const RankTree&) = delete;

  /// In post-order: children before parents, the root last. None if no rank has points.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  /// The ranks that have points, in the order of the tree.
  [[nodiscard]] const std::vector<int>& members() const { return members_; }

  /// How many sections the stream has.
  [[nodiscard]] std::uint32_t sections() const { return sections_; }

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
  std::vector<int> members_;
  std::uint32_t sections_ = 0;
  std::optional<std::uint32_t> own_;
};

}  // namespace spillway::ranks
