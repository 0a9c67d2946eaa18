#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "stream/tiles/tile_node.h"

namespace spillway::stream {

/// Something with a box around it, by its number.
struct NumberedBox {
  Box<2> box;
  std::uint32_t number = 0;
};

/// Which tiles lie in a box.
class TileIndex {
 public:
  TileIndex() = default;
  explicit TileIndex(const TileNode<2>& root);

  /// The tiles, in the order of their numbers.
  [[nodiscard]] std::span<const TileNode<2>* const> tiles() const { return tiles_; }

  /// The numbers of all tiles that have something in common with a box.
  [[nodiscard]] std::vector<std::uint32_t> tiles_in(const Box<2>& box) const;

  /// Calls visit(tile, boxes) for each tile that has a box in common with some of `boxes`, with
  /// these.
  using Visit = std::function<void(std::uint32_t tile, std::span<const NumberedBox> boxes)>;
  void visit(std::span<const NumberedBox> boxes, const Visit& visit) const;

 private:
  /// Some nodes from `first` on, or a tile.
  struct Node {
    Box<2> box;
    std::uint32_t first = 0;
    std::uint32_t children = 0;  ///< 0: a tile
  };

  void put(const TileNode<2>& from, std::size_t to);
  void visit_below(const Node& node, const Box<2>& extent, std::span<const NumberedBox> boxes,
                   const Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<const TileNode<2>*> tiles_;
};

}  // namespace spillway::stream
