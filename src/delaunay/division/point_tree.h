#pragma once

#include <concepts>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::delaunay {

/// A tree of boxes over points, such as Part and TileNode: each node has a tight `box` around its
/// points, tells their number, and has `children`, which are none for a leaf.
template <typename Tree>
concept PointTree = requires(const Tree& tree) {
  { tree.size() } -> std::convertible_to<std::uint64_t>;
  { tree.leaf() } -> std::same_as<bool>;
  { *tree.children.begin() } -> std::same_as<const Tree&>;
  tree.box;
};

}  // namespace spillway::delaunay
