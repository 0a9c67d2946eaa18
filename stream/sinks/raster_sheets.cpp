#include "stream/sinks/raster_sheets.h"

#include <cmath>

namespace spillway::stream {
namespace {

/// The coordinate of an edge of pixels. It is the same multiple of the resolution in all rasters
/// that are aligned.
double edge_of(double origin, double pixels, double resolution) {
  const double steps = std::round(origin / resolution);
  return steps * resolution == origin ? (steps + pixels) * resolution
                                      : origin + pixels * resolution;
}

}  // namespace

RasterSheets::RasterSheets(const PixelGrid& raster, std::span<const SheetPlace> places,
                           bool with_ring)
    : raster_(raster), margin_(with_ring ? 1 : 0) {
  std::uint64_t stored = 0;
  for (const auto& [window, outline] : places) {
    outlines_.push_back(outline);
    stored += sheets_.emplace_back(raster, window, with_ring, stored).stored_count();
    band_rows_.push_back(window.row_begin);
    band_rows_.push_back(window.row_end + 2 * margin_);
  }
  is_whole_ =
      sheets_.size() == 1 && sheets_[0].rows == raster.rows && sheets_[0].columns == raster.columns;
  std::ranges::sort(band_rows_);
  band_rows_.erase(std::unique(band_rows_.begin(), band_rows_.end()), band_rows_.end());
  bands_.resize(band_rows_.size());
  for (std::size_t sheet = 0; sheet < sheets_.size(); ++sheet) {
    const PixelWindow& window = sheets_[sheet].window;
    auto band = std::ranges::lower_bound(band_rows_, window.row_begin) - band_rows_.begin();
    for (; band_rows_[static_cast<std::size_t>(band)] < window.row_end + 2 * margin_; ++band) {
      bands_[static_cast<std::size_t>(band)].push_back(
          {window.column_begin, window.column_end + 2 * margin_, 0, sheet});
    }
  }
  for (std::vector<Columns>& band : bands_) {
    std::ranges::sort(band, {}, &Columns::begin);
    std::uint32_t reach = 0;
    for (Columns& columns : band) columns.reach = reach = std::max(reach, columns.end);
  }
}

std::uint64_t RasterSheets::stored_tiles() const {
  return sheets_.empty() ? 0 : sheets_.back().first + sheets_.back().stored_count();
}

std::size_t RasterSheets::sheet_of_stored(std::uint64_t number) const {
  const auto next = std::ranges::upper_bound(sheets_, number, {}, &TileLayout::first);
  return static_cast<std::size_t>(next - sheets_.begin()) - 1;
}

PixelGrid RasterSheets::grid_of(std::size_t sheet) const {
  const TileLayout& tiles = sheets_[sheet];
  return {edge_of(raster_.west, tiles.window.column_begin, raster_.resolution),
          edge_of(raster_.north, -static_cast<double>(tiles.window.row_begin), raster_.resolution),
          raster_.resolution, tiles.columns, tiles.rows};
}

std::uint64_t RasterSheets::bytes() const {
  constexpr std::uint64_t kNameBytes = 256;
  std::uint64_t bytes = sheets_.size() * (sizeof(TileLayout) + kNameBytes);
  for (const auto& outline : outlines_) bytes += outline == nullptr ? 0 : outline->bytes();
  for (const std::vector<Columns>& band : bands_) bytes += band.size() * sizeof(Columns);
  return bytes;
}

}  // namespace spillway::stream
