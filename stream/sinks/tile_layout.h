#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "formats/gdal/raster.h"
#include "src/geometry/pixel_grid.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::stream {

/// How a raster, or a sheet of one, is cut into tiles, which are counted row by row from the
/// north-west. It may have a ring: the pixels just beyond its edges, which fill tiles of their own,
/// stored before the others.
struct TileLayout {
  struct Size {
    std::uint32_t rows;
    std::uint32_t columns;
  };
  static constexpr std::size_t kPixels = std::size_t{kRasterTile} * kRasterTile;

  TileLayout() = default;
  /// Of a whole raster.
  TileLayout(const PixelGrid& raster, bool with_ring)
      : TileLayout(raster, {0, raster.rows, 0, raster.columns}, with_ring, 0) {}
  /// Of a sheet of a raster, whose tiles are stored from `first_stored` on.
  TileLayout(const PixelGrid& raster, const PixelWindow& sheet, bool with_ring,
             std::uint64_t first_stored)
      : whole(raster),
        window(sheet),
        rows(sheet.row_end - sheet.row_begin),
        columns(sheet.column_end - sheet.column_begin),
        across((columns + kRasterTile - 1) / kRasterTile),
        down((rows + kRasterTile - 1) / kRasterTile),
        margin(with_ring ? 1 : 0),
        first(first_stored) {}

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
  /// The row and the column of the whole raster that it begins with.
  [[nodiscard]] std::uint32_t first_row(std::uint64_t tile) const {
    return window.row_begin + row(tile) * kRasterTile;
  }
  [[nodiscard]] std::uint32_t first_column(std::uint64_t tile) const {
    return window.column_begin + column(tile) * kRasterTile;
  }
  /// How many rows and columns of it are in the sheet.
  [[nodiscard]] Size size(std::uint64_t tile) const {
    return {std::min(kRasterTile, rows - row(tile) * kRasterTile),
            std::min(kRasterTile, columns - column(tile) * kRasterTile)};
  }
  /// Its number where it is stored.
  [[nodiscard]] std::uint64_t stored(std::uint64_t tile) const {
    return first + ring_tiles() + tile;
  }
  /// How many are stored, with those of the ring.
  [[nodiscard]] std::uint64_t stored_count() const { return ring_tiles() + count(); }
  /// The pixels of a stored tile that lie in the sheet or its ring.
  [[nodiscard]] std::uint32_t pixels_of_stored(std::uint64_t number) const {
    const std::uint64_t tile = number - first;
    if (tile < ring_tiles()) {
      return static_cast<std::uint32_t>(
          std::min<std::uint64_t>(kPixels, ring_pixels() - tile * kPixels));
    }
    const auto [rows_of_it, columns_of_it] = size(tile - ring_tiles());
    return rows_of_it * columns_of_it;
  }

  // Of the ring, whose rows and columns are counted from one beyond the sheet: 0 to rows + 1.

  [[nodiscard]] std::uint64_t ring_pixels() const {
    return std::uint64_t{2} * margin * (std::uint64_t{columns} + 2 + rows);
  }
  [[nodiscard]] std::uint64_t ring_tiles() const { return (ring_pixels() + kPixels - 1) / kPixels; }
  [[nodiscard]] bool is_in_ring(std::uint32_t row, std::uint32_t column) const {
    return row == 0 || row > rows || column == 0 || column > columns;
  }
  /// Which of its pixels this one is.
  [[nodiscard]] std::uint64_t ring_pixel(std::uint32_t row, std::uint32_t column) const {
    const std::uint64_t width = std::uint64_t{columns} + 2;
    if (row == 0) return column;
    if (row > rows) return width + column;
    return 2 * width + (column == 0 ? 0 : rows) + row - 1;
  }

  PixelGrid whole;            ///< the raster that it is a sheet of
  PixelWindow window;         ///< where it lies there
  std::uint32_t rows = 0;     ///< of pixels
  std::uint32_t columns = 0;  ///< of pixels
  std::uint32_t across = 0;   ///< tiles in a row
  std::uint32_t down = 0;     ///< rows of tiles
  std::uint32_t margin = 0;   ///< 1 with a ring, else 0
  std::uint64_t first = 0;    ///< number of the first stored tile
};

}  // namespace spillway::stream
