#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "stream/tiles/storage/cell_sketch.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/tile_node.h"

namespace spillway::stream {

/// Makes sketches of where the points of hollow tiles lie, which others ask that are triangulated
/// before or after them.
class TileSketches {
 public:
  /// They may take about so many bytes.
  TileSketches(int dimension, std::uint64_t bytes) : dimension_(dimension), bytes_(bytes) {}

  /// A sketch to be filled of points of a tile that go to the disk, or none where none would tell
  /// more than a box. `all_points` is how many there are of all, as far as is known.
  std::shared_ptr<CellSketch> begin(const Tile& tile, const HeldPoints& held,
                                    std::uint64_t all_points);

  /// Gives a tile that is made of those stored its sketch, if that tells more than its box.
  template <int D>
  void sketch(TileNode<D>& node, const std::function<const Tile&(std::uint32_t)>& stored,
              std::uint64_t all_points) const;

  template <typename State>
  void state(State& state) {
    state(cells_begun_);
  }

 private:
  [[nodiscard]] std::size_t cells_for(std::uint64_t points, std::uint64_t all_points) const;
  [[nodiscard]] bool is_known_hollow(const Tile& tile, const HeldPoints& held) const;

  int dimension_;
  std::uint64_t bytes_;
  std::size_t cells_begun_ = 0;  ///< of what is on the disk
};

}  // namespace spillway::stream
