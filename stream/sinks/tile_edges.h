#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

#include "stream/sinks/tile_layout.h"

namespace spillway::stream {

/// Side of a tile with a border of one pixel.
inline constexpr std::size_t kFramedSide = kRasterTile + 2;

/// The outermost pixels of tiles that come in order, for the neighbours of each. Those of two rows
/// of tiles are kept.
class TileEdges {
 public:
  explicit TileEdges(const TileLayout& tiles) : tiles_(tiles) {}

  /// A tile's neighbours have all come when so many tiles have come after it.
  static std::uint64_t delay(const TileLayout& tiles) { return std::uint64_t{tiles.across} + 1; }

  /// What the edges of such a raster take.
  static std::uint64_t bytes(const TileLayout& tiles) {
    return (2 * delay(tiles) + 1) * sizeof(Edges);
  }

  /// The next tile, kRasterTile rows of kRasterTile pixels.
  void add(std::span<const float> pixels);

  /// Puts what lies around a tile into the border of `framed`, kFramedSide rows of as many pixels;
  /// not a number beyond the raster. Tiles are asked for in order, delay() after they were added.
  void frame(std::uint64_t tile, std::span<float> framed);

 private:
  using Edge = std::array<float, kRasterTile>;
  struct Edges {
    Edge north;
    Edge south;
    Edge west;
    Edge east;
  };

  /// Those of the tile so many rows and columns further; null beyond the raster.
  [[nodiscard]] const Edges* neighbour(std::uint64_t tile, int rows, int columns) const;

  const TileLayout tiles_;
  std::deque<Edges> edges_;
  std::uint64_t first_ = 0;  ///< the tile that edges_ begins with
};

}  // namespace spillway::stream
