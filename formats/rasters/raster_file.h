#pragma once

#include <cstdint>
#include <memory>

#include "formats/disk/private_output.h"
#include "formats/gdal/raster.h"

namespace spillway::formats {

/// A GeoTIFF being written. GDAL writes it into a private folder beside the target; finish() gives
/// it its name. If destroyed without, or after a signal, nothing is left.
class RasterFile {
 public:
  /// Begins the file `options.path`; the name of the options is set here. Throws Failure if it cannot
  /// be created.
  explicit RasterFile(RasterOptions options);

  [[nodiscard]] Raster& raster() { return *raster_; }

  /// Completes the file and replaces what was there of that name; overviews, masks and statistics
  /// that an older one had beside itself are removed. Returns its bytes.
  std::uint64_t finish();

 private:
  PrivateOutput output_;
  std::unique_ptr<Raster> raster_;  ///< writes to output_, so it goes first
};

}  // namespace spillway::formats
