#pragma once

#include <spillway/choices.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/geometry/pixel_grid.h"

namespace spillway::formats {

/// Side of a raster file's tiles in pixels.
inline constexpr std::uint32_t kRasterTile = 256;

/// Where a raster lies.
struct RasterGrid {
  PixelGrid pixels;
  std::string crs;  ///< as Gdal takes it; empty: unknown
};

struct RasterOptions {
  std::string path;  ///< of the file to create, which is not there yet
  std::string name;  ///< of the file in messages
  RasterGrid grid;
  std::vector<std::string> bands;  ///< descriptions, one a band
  float nodata = -9999;
  PixelType type = PixelType::kFloat32;  ///< bytes: values are rounded to 1 to 255; nodata is 0
  /// Bytes as they are, without nodata: of four bands, red, green, blue and opacity.
  bool colours = false;
  std::string compression = "deflate";  ///< "deflate", "zstd", "none"
  /// With overviews, in the order that a Cloud Optimized GeoTIFF has. Beside `path` a second file
  /// is made and removed.
  bool cloud_optimized = false;
  bool averaged_overviews = true;                  ///< else every other pixel's value
  unsigned threads = 1;                            ///< that compress
  std::uint64_t memory = std::uint64_t{64} << 20;  ///< for overviews
};

/// A GeoTIFF being written. Not complete before finish(). Throws Failure with GDAL's
/// reason. The same tiles in the same order give the same bytes for any number of threads.
class Raster {
 public:
  Raster() = default;
  virtual ~Raster() = default;
  Raster(const Raster&) = delete;
  Raster& operator=(const Raster&) = delete;

  /// Writes a tile of one band (counted from 0): kRasterTile rows of kRasterTile pixels from the
  /// north; what lies beyond the raster's edges is not looked at.
  virtual void write_tile(std::size_t band, std::uint32_t tile_column, std::uint32_t tile_row,
                          std::span<const float> pixels) = 0;
  /// Completes and closes the file.
  virtual void finish() = 0;
};

}  // namespace spillway::formats
