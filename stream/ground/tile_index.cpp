#include "stream/ground/tile_index.h"

namespace spillway::stream {
namespace {

bool meet(const Box<2>& a, const Box<2>& b) {
  return a.lo[0] <= b.hi[0] && b.lo[0] <= a.hi[0] && a.lo[1] <= b.hi[1] && b.lo[1] <= a.hi[1];
}

bool holds(const Box<2>& outer, const Box<2>& inner) {
  return outer.contains(inner.lo) && outer.contains(inner.hi);
}

Box<2> box_around(std::span<const NumberedBox> boxes) {
  Box<2> all;
  for (const NumberedBox& one : boxes) all.expand(one.box);
  return all;
}

}  // namespace

TileIndex::TileIndex(const TileNode<2>& root) : nodes_(1) { put(root, 0); }

void TileIndex::put(const TileNode<2>& from, std::size_t to) {
  nodes_[to].box = from.box;
  if (from.leaf()) {
    nodes_[to].first = static_cast<std::uint32_t>(tiles_.size());
    tiles_.push_back(&from);
    return;
  }
  const std::size_t first = nodes_.size();
  const std::size_t children = from.children.size();
  nodes_[to].first = static_cast<std::uint32_t>(first);
  nodes_[to].children = static_cast<std::uint32_t>(children);
  nodes_.resize(first + children);
  for (std::size_t c = 0; c < children; ++c) put(from.children[c], first + c);
}

std::vector<std::uint32_t> TileIndex::tiles_in(const Box<2>& box) const {
  std::vector<std::uint32_t> found;
  const NumberedBox one{box, 0};
  visit({&one, 1},
        [&](std::uint32_t tile, std::span<const NumberedBox>) { found.push_back(tile); });
  return found;
}

void TileIndex::visit(std::span<const NumberedBox> boxes, const Visit& visit) const {
  if (nodes_.empty() || boxes.empty()) return;
  visit_below(nodes_[0], box_around(boxes), boxes, visit);
}

/// `extent` is the box around all boxes. Where a child holds them all, or none reaches it, there is
/// no need to look at each.
void TileIndex::visit_below(const Node& node, const Box<2>& extent,
                            std::span<const NumberedBox> boxes, const Visit& visit) const {
  if (!meet(node.box, extent)) return;
  if (!holds(node.box, extent)) {
    std::vector<NumberedBox> some;
    for (const NumberedBox& one : boxes) {
      if (meet(node.box, one.box)) some.push_back(one);
    }
    if (some.empty()) return;
    if (node.children == 0) return visit(node.first, some);
    const Box<2> within = box_around(some);
    for (std::uint32_t c = 0; c < node.children; ++c) {
      visit_below(nodes_[node.first + c], within, some, visit);
    }
    return;
  }
  if (node.children == 0) return visit(node.first, boxes);
  for (std::uint32_t c = 0; c < node.children; ++c) {
    visit_below(nodes_[node.first + c], extent, boxes, visit);
  }
}

}  // namespace spillway::stream
