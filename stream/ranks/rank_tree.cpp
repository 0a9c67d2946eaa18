#include "stream/ranks/rank_tree.h"

#include <algorithm>
#include <utility>

#include "src/geometry/dimensions.h"
#include "stream/ranks/exchange/messages.h"

namespace spillway::ranks {

template <int D>
RankTree<D>::RankTree(const RankDivision& division, const std::optional<TileNode<D>>& own,
                      const distributed::Ranks& ranks) {
  Packer packer;
  if (own) pack(packer, *own);
  std::vector<std::optional<TileNode<D>>> trees;
  for (const auto& bytes : ranks.gather(packer.bytes())) {
    Unpacker unpacker(bytes);
    trees.push_back(bytes.empty() ? std::nullopt : std::optional(unpack_tile_node<D>(unpacker)));
  }
  trees[static_cast<std::size_t>(ranks.rank())] = own;
  std::optional<Subtree> all = subtree_at(division, division.cuts.root(), trees);
  if (!all) return;
  root_ = std::move(all->tiles);
  add_node(root_, all->shape, {}, ranks.rank());
}

/// What is below a node of the division; sides without points are left out.
template <int D>
std::optional<typename RankTree<D>::Subtree> RankTree<D>::subtree_at(
    const RankDivision& division, CutTree::NodeRef ref,
    std::vector<std::optional<TileNode<D>>>& trees) const {
  if (CutTree::is_tile(ref)) {
    const int rank = division.rank_of_tile[CutTree::tile_at(ref)];
    std::optional<TileNode<D>>& tree = trees[static_cast<std::size_t>(rank)];
    if (!tree) return std::nullopt;
    return Subtree{std::move(*tree), {rank, {}}};
  }
  const auto sides = division.cuts.sides(ref);
  std::optional<Subtree> low = subtree_at(division, sides[0], trees);
  std::optional<Subtree> high = subtree_at(division, sides[1], trees);
  if (!low || !high) return low ? std::move(low) : std::move(high);
  Subtree both;
  both.tiles.box = low->tiles.box;
  both.tiles.box.expand(high->tiles.box);
  both.tiles.points = low->tiles.points + high->tiles.points;
  for (Subtree* side : {&*low, &*high}) {
    both.tiles.children.push_back(std::move(side->tiles));
    both.shape.sides.push_back(std::move(side->shape));
  }
  return both;
}

template <int D>
std::uint32_t RankTree<D>::add_node(const TileNode<D>& tiles, const Shape& shape,
                                    const Outside<D>& outside, int own_rank) {
  Node node;
  node.tiles = &tiles;
  node.outside = outside;
  node.first = static_cast<int>(members_.size());
  if (shape.sides.empty()) members_.push_back(shape.rank);
  for (std::size_t side = 0; side < shape.sides.size(); ++side) {
    Outside<D> others = outside;
    others.push_back(&tiles.children[1 - side]);
    const std::uint32_t below = add_node(tiles.children[side], shape.sides[side], others, own_rank);
    node.below[side] = below;
    node.level = std::max(node.level, nodes_[below].level + 1);
  }
  node.end = static_cast<int>(members_.size());
  node.first_section = sections_;
  sections_ += node.sections();
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  if (shape.rank == own_rank) own_ = number;
  nodes_.push_back(std::move(node));
  return number;
}

#define SPILLWAY_INSTANTIATE(D) template class RankTree<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::ranks
