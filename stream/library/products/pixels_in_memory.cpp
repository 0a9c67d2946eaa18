#include "stream/library/products/pixels_in_memory.h"

#include <algorithm>

namespace spillway::stream {

PixelsInMemory::PixelsInMemory(const RasterOptions& raster, DemPixels& pixels)
    : grid_(raster.grid.pixels), pixels_(pixels) {
  pixels_.values.resize(raster.bands.size() * grid_.rows * grid_.columns);
  pixels_.crs = raster.grid.crs;
}

void PixelsInMemory::write_tile(std::size_t band, std::uint32_t tile_column, std::uint32_t tile_row,
                                std::span<const float> pixels) {
  const std::uint32_t left = tile_column * kRasterTile;
  const std::uint32_t top = tile_row * kRasterTile;
  const std::uint32_t width = std::min(kRasterTile, grid_.columns - left);
  const std::uint32_t height = std::min(kRasterTile, grid_.rows - top);
  for (std::uint32_t row = 0; row < height; ++row) {
    const std::size_t line = band * grid_.rows + top + row;
    std::ranges::copy(
        pixels.subspan(std::size_t{row} * kRasterTile, width),
        pixels_.values.begin() + static_cast<std::ptrdiff_t>(line * grid_.columns + left));
  }
}

}  // namespace spillway::stream
