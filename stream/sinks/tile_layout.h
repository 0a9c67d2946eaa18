#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "formats/gdal/raster.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::stream {

/// How a raster is cut into tiles, which are counted row by row from the north-west. It may have a
/// ring: the pixels just beyond its edges, which fill tiles of their own, stored before the others.
struct TileLayout {
  struct Size {
    std::uint32_t rows;
    std::uint32_t columns;
  };
  static constexpr std::size_t kPixels = std::size_t{kRasterTile} * kRasterTile;

  TileLayout() = default;
  TileLayout(const PixelGrid& raster, bool with_ring)
      : grid(raster),
        across((raster.columns + kRasterTile - 1) / kRasterTile),
        down((raster.rows + kRasterTile - 1) / kRasterTile),
        margin(with_ring ? 1 : 0) {}

  [[nodiscard]] std::uint64_t count() const { return std::uint64_t{across} * down; }
  [[nodiscard]] std::uint64_t number(std::uint32_t row, std::uint32_t column) const {
    return std::uint64_t{row / kRasterTile} * across + column / kRasterTile;
  }

  // Of a tile.

  [[nodiscard]] std::uint32_t row(std::uint64_t tile) const {
    return static_cast<std::uint32_t>(tile / across);
  }
  [[nodiscard]] std::uint32_t column(std::uint64_t tile) const {
    return static_cast<std::uint32_t>(tile % across);
  }
  /// How many rows and columns of it are in the raster.
  [[nodiscard]] Size size(std::uint64_t tile) const {
    return {std::min(kRasterTile, grid.rows - row(tile) * kRasterTile),
            std::min(kRasterTile, grid.columns - column(tile) * kRasterTile)};
  }
  /// Its number where it is stored.
  [[nodiscard]] std::uint64_t stored(std::uint64_t tile) const { return ring_tiles() + tile; }

  // Of the ring, whose rows and columns are counted from one beyond the raster: 0 to rows + 1.

  [[nodiscard]] std::uint64_t ring_pixels() const {
    return margin * 2 * (std::uint64_t{grid.columns} + 2 + grid.rows);
  }
  [[nodiscard]] std::uint64_t ring_tiles() const { return (ring_pixels() + kPixels - 1) / kPixels; }
  [[nodiscard]] bool is_in_ring(std::uint32_t row, std::uint32_t column) const {
    return row == 0 || row > grid.rows || column == 0 || column > grid.columns;
  }
  /// Which of its pixels this one is.
  [[nodiscard]] std::uint64_t ring_pixel(std::uint32_t row, std::uint32_t column) const {
    const std::uint64_t width = std::uint64_t{grid.columns} + 2;
    if (row == 0) return column;
    if (row > grid.rows) return width + column;
    return 2 * width + (column == 0 ? 0 : grid.rows) + row - 1;
  }

  PixelGrid grid;
  std::uint32_t across = 0;  ///< tiles in a row
  std::uint32_t down = 0;    ///< rows of tiles
  std::uint32_t margin = 0;  ///< 1 with a ring, else 0
};

}  // namespace spillway::stream
