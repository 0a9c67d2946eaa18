#pragma once

#include <spillway/dem.h>

#include "formats/gdal/raster.h"

namespace spillway::stream {

/// Takes the tiles of a raster as plain rows of pixels.
class PixelsInMemory final : public Raster {
 public:
  /// `pixels` gets the values, and must outlive it.
  PixelsInMemory(const RasterOptions& raster, DemPixels& pixels);

  void write_tile(std::size_t band, std::uint32_t tile_column, std::uint32_t tile_row,
                  std::span<const float> pixels) override;
  void finish() override {}

 private:
  PixelGrid grid_;
  DemPixels& pixels_;
};

}  // namespace spillway::stream
