#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "stream/tiles/regions/region_plan.h"
#include "stream/tiles/tile_node.h"

namespace spillway::stream {

/// The tree over the cells of a plan, as far as it is known while they are completed one by one: of
/// a complete cell its tiles with tight boxes, of the others the box that has all of their points.
/// Cells without points drop out.
template <int D>
class CellTree {
 public:
  using Node = std::shared_ptr<TileNode<D>>;

  explicit CellTree(const RegionPlan& plan);

  /// Parts of the tree whose cells are all complete, and the part that they make up: two, or at the
  /// end the one that has all points, if it was taken for a part of them when it was made.
  struct Join {
    std::size_t part = 0;  ///< a number of its own
    std::vector<std::size_t> below;
    Node node;
    std::vector<Node> outside;  ///< everything else
  };
  struct Completion {
    std::size_t part = 0;
    Node node;  ///< null if the cell has no points
    std::vector<Node> outside;
    std::vector<Join> joins;  ///< that can be made from now on, from below upwards
  };

  /// A cell is complete, with these tiles. Each cell is to come once.
  Completion complete(std::uint32_t cell, std::optional<TileNode<D>> tiles);

  /// How many parts there may be: their numbers are below that.
  [[nodiscard]] std::size_t parts() const { return parents_.size() + 1; }

 private:
  void add(const CutTree& cuts, CutTree::NodeRef ref, std::optional<std::size_t> parent);
  [[nodiscard]] std::size_t number_of(CutTree::NodeRef ref) const;
  [[nodiscard]] Node joined(std::size_t part) const;
  [[nodiscard]] std::vector<Node> outside_of(std::size_t part) const;
  void add_last_join(Completion& done);

  std::size_t cells_;  ///< which come first by number, then cuts
  std::vector<std::optional<std::size_t>> parents_;
  std::vector<std::array<std::size_t, 2>> sides_;  ///< by cut
  std::vector<Node> nodes_;                        ///< null: certainly without points
  std::vector<bool> complete_;
  std::vector<bool> surrounded_;  ///< by part: there was something outside when it was made
  std::size_t root_ = 0;
  /// Of what is complete: the part that has all of its points; none if there are none.
  std::vector<std::optional<std::size_t>> part_of_;
};

}  // namespace spillway::stream
