#pragma once

#include <span>
#include <vector>

#include "src/geometry/box.h"

namespace spillway::distributed {

/// The boxes of some ranks, one or more, as a tree for regions that are held against it.
template <int D>
struct BoxTree {
  Box<D> box;
  std::vector<BoxTree> children{};

  static BoxTree of(std::span<const Box<D>> boxes) {
    if (boxes.size() == 1) return {boxes.front()};
    BoxTree tree;
    tree.children.push_back(of(boxes.first(boxes.size() / 2)));
    tree.children.push_back(of(boxes.subspan(boxes.size() / 2)));
    for (const BoxTree& child : tree.children) tree.box.expand(child.box);
    return tree;
  }
};

}  // namespace spillway::distributed
