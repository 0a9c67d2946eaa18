#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/geometry/box.h"

namespace spillway::stream {

/// A cut of space: below `value` on `axis`, and not below. On each side there is another cut or a
/// tile, told by a reference: the cut's number, or -1 - the tile's.
struct CutNode {
  double value = 0;
  int axis = 0;
  std::array<std::int32_t, 2> sides{};
};

/// A cell of a division of space, from `lo` on, below `hi`; and the reference of its tile.
struct TileCell {
  Box<3> box;
  std::int32_t tile = 0;
};

/// Cuts that lead to the cell of a point in few steps, however unevenly the cells came about: a
/// cell may be found on both sides of a cut.
class CutLookup {
 public:
  /// Of cells that fill space, as cuts of it leave them.
  CutLookup(std::vector<TileCell> cells, int dimension);

  [[nodiscard]] const std::vector<CutNode>& cuts() const { return cuts_; }
  [[nodiscard]] std::int32_t root() const { return root_; }
  /// Steps to the farthest tile.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  std::int32_t add(std::vector<TileCell> cells, const Box<3>& region, int depth);

  int dimension_;
  std::vector<CutNode> cuts_;
  std::int32_t root_ = 0;
  int depth_ = 0;
};

}  // namespace spillway::stream
