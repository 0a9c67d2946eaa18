#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "stream/sinks/dem_sink_options.h"
#include "stream/sinks/tile_layout.h"

namespace spillway::stream {

/// A raster that is cut into sheets, each of which becomes a file. With a ring, a sheet also has
/// the pixels next to it, which it shares with its neighbours: so it is made without them.
class RasterSheets {
 public:
  RasterSheets() = default;
  /// Sheets may overlap, and need not cover the raster.
  RasterSheets(const PixelGrid& raster, std::span<const SheetPlace> places, bool with_ring);

  [[nodiscard]] std::size_t size() const { return sheets_.size(); }
  [[nodiscard]] const TileLayout& operator[](std::size_t sheet) const { return sheets_[sheet]; }
  [[nodiscard]] const PixelGrid& raster() const { return raster_; }
  /// Rows and columns beyond the raster's edges that count as well.
  [[nodiscard]] std::uint32_t margin() const { return margin_; }
  /// Tiles of all sheets, those of rings included.
  [[nodiscard]] std::uint64_t stored_tiles() const;
  /// Its outline; null: none.
  [[nodiscard]] const PolygonPixels* outline(std::size_t sheet) const {
    return outlines_[sheet].get();
  }
  /// The sheet that a stored tile is of.
  [[nodiscard]] std::size_t sheet_of_stored(std::uint64_t number) const;
  /// The place of a sheet on the ground.
  [[nodiscard]] PixelGrid grid_of(std::size_t sheet) const;
  /// What it takes, in bytes.
  [[nodiscard]] std::uint64_t bytes() const;

  /// Calls take(sheet, begin, end) for each sheet that has some of these columns of a row in it or
  /// in its ring, with those. Rows and columns begin with the margin.
  template <typename Visit>
  void visit(std::uint32_t row, std::uint32_t begin, std::uint32_t end, const Visit& take) const {
    if (is_whole_) return take(std::size_t{0}, begin, end);
    const auto above = std::ranges::upper_bound(band_rows_, row);
    if (above == band_rows_.begin() || above == band_rows_.end()) return;
    const std::vector<Columns>& band =
        bands_[static_cast<std::size_t>(above - band_rows_.begin()) - 1];
    const auto first = std::ranges::upper_bound(band, begin, {}, &Columns::reach);
    for (auto one = first; one != band.end() && one->begin < end; ++one) {
      if (one->end <= begin) continue;
      take(one->sheet, std::max(begin, one->begin), std::min(end, one->end));
    }
  }

  /// Calls take(sheet, row, column) for each sheet that has a pixel in it and in its outline, with
  /// the place there.
  template <typename Take>
  void visit_pixel(std::uint32_t row, std::uint32_t column, const Take& take) const {
    visit(row + margin_, column + margin_, column + margin_ + 1,
          [&](std::size_t sheet, std::uint32_t, std::uint32_t) {
            const PixelWindow& window = sheets_[sheet].window;
            const bool is_inside =
                row >= window.row_begin && row < window.row_end && column >= window.column_begin &&
                column < window.column_end &&
                (outlines_[sheet] == nullptr || outlines_[sheet]->has(row, column));
            if (is_inside) take(sheet, row - window.row_begin, column - window.column_begin);
          });
  }

 private:
  /// The columns of a sheet with its ring.
  struct Columns {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t reach = 0;  ///< the furthest end of those up to here
    std::size_t sheet = 0;
  };

  PixelGrid raster_;
  std::uint32_t margin_ = 0;
  bool is_whole_ = false;  ///< one sheet, the raster itself
  std::vector<TileLayout> sheets_;
  std::vector<std::shared_ptr<const PolygonPixels>> outlines_;
  std::vector<std::uint32_t> band_rows_;     ///< where the sheets of a row change
  std::vector<std::vector<Columns>> bands_;  ///< the sheets between; by their first column
};

}  // namespace spillway::stream
