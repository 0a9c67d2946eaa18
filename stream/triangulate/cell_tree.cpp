#include "stream/triangulate/cell_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/geometry/dimensions.h"
#include "stream/tiles/cuts/tile_cut.h"

namespace spillway::stream {

template <int D>
CellTree<D>::CellTree(const RegionPlan& plan)
    : cells_(plan.cells.size()),
      parents_(cells_ + static_cast<std::size_t>(plan.cuts.cuts())),
      sides_(static_cast<std::size_t>(plan.cuts.cuts())),
      nodes_(parents_.size()),
      complete_(parents_.size()),
      surrounded_(parents_.size()),
      root_(number_of(plan.cuts.root())),
      part_of_(parents_.size()) {
  for (std::size_t c = 0; c < cells_; ++c) {
    const RegionPlan::Cell& cell = plan.cells[c];
    if (cell.box.empty()) continue;
    nodes_[c] = std::make_shared<TileNode<D>>();
    std::copy_n(cell.box.lo.begin(), cut_axes(D), nodes_[c]->box.lo.begin());
    std::copy_n(cell.box.hi.begin(), cut_axes(D), nodes_[c]->box.hi.begin());
    nodes_[c]->points = static_cast<std::uint64_t>(std::ceil(cell.expected));
  }
  add(plan.cuts, plan.cuts.root(), std::nullopt);
}

template <int D>
std::size_t CellTree<D>::number_of(CutTree::NodeRef ref) const {
  return CutTree::is_tile(ref) ? CutTree::tile_at(ref) : cells_ + static_cast<std::size_t>(ref);
}

template <int D>
void CellTree<D>::add(const CutTree& cuts, CutTree::NodeRef ref,
                      std::optional<std::size_t> parent) {
  const std::size_t number = number_of(ref);
  parents_[number] = parent;
  if (CutTree::is_tile(ref)) return;
  const auto sides = cuts.sides(ref);
  for (int side = 0; side < 2; ++side) {
    sides_[number - cells_][side] = number_of(sides[side]);
    add(cuts, sides[side], number);
  }
  nodes_[number] = joined(number);
}

/// The node over what is known of both sides of a cut.
template <int D>
typename CellTree<D>::Node CellTree<D>::joined(std::size_t part) const {
  const auto& [below, above] = sides_[part - cells_];
  if (!nodes_[below] || !nodes_[above]) return nodes_[below] ? nodes_[below] : nodes_[above];
  auto node = std::make_shared<TileNode<D>>();
  for (const Node& side : {nodes_[below], nodes_[above]}) {
    node->box.expand(side->box);
    node->points += side->points;
    node->children.push_back(side);
  }
  return node;
}

/// What is known of all other parts.
template <int D>
std::vector<typename CellTree<D>::Node> CellTree<D>::outside_of(std::size_t part) const {
  std::vector<Node> outside;
  for (std::size_t below = part; parents_[below]; below = *parents_[below]) {
    const auto& sides = sides_[*parents_[below] - cells_];
    const Node& other = nodes_[sides[sides[0] == below ? 1 : 0]];
    if (other) outside.push_back(other);
  }
  return outside;
}

template <int D>
typename CellTree<D>::Completion CellTree<D>::complete(std::uint32_t cell,
                                                       std::optional<TileNode<D>> tiles) {
  nodes_[cell] = tiles ? std::make_shared<TileNode<D>>(std::move(*tiles)) : nullptr;
  for (auto above = parents_[cell]; above; above = parents_[*above]) {
    nodes_[*above] = joined(*above);
  }
  complete_[cell] = true;
  if (nodes_[cell]) part_of_[cell] = cell;
  Completion done{.part = cell, .node = nodes_[cell], .outside = outside_of(cell), .joins = {}};
  surrounded_[cell] = !done.outside.empty();
  for (auto above = parents_[cell]; above; above = parents_[*above]) {
    const auto& sides = sides_[*above - cells_];
    if (!complete_[sides[0]] || !complete_[sides[1]]) break;
    complete_[*above] = true;
    const auto below = part_of_[sides[0]];
    const auto beyond = part_of_[sides[1]];
    if (below && beyond) {
      part_of_[*above] = *above;
      done.joins.push_back({*above, {*below, *beyond}, nodes_[*above], outside_of(*above)});
      surrounded_[*above] = !done.joins.back().outside.empty();
    } else {
      part_of_[*above] = below ? below : beyond;
    }
  }
  if (complete_[root_]) add_last_join(done);
  return done;
}

/// The last cells had no points: what was kept because of their boxes is final now.
template <int D>
void CellTree<D>::add_last_join(Completion& done) {
  const auto all = part_of_[root_];
  if (!all || !surrounded_[*all]) return;
  auto node = std::make_shared<TileNode<D>>();
  node->box = nodes_[root_]->box;
  node->points = nodes_[root_]->points;
  node->children.push_back(nodes_[root_]);
  done.joins.push_back({parents_.size(), {*all}, node, {}});
}

#define SPILLWAY_INSTANTIATE(D) template class CellTree<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
