#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/gdal/raster.h"

namespace spillway {

/// A GeoTIFF being written. GDAL writes it into a private folder beside the target; finish() gives
/// it its name. If destroyed without, or after a signal, nothing is left.
class RasterFile {
 public:
  /// Begins the file `options.path`; the name of the options is set here. Throws Error if it cannot
  /// be created.
  explicit RasterFile(RasterOptions options);
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  [[nodiscard]] Raster& raster() { return *raster_; }

  /// Completes the file and replaces what was there of that name. Returns its bytes.
  std::uint64_t finish();

 private:
  std::string target_;  ///< the final path, through symbolic links
  std::string folder_;  ///< the temporary one
  std::string path_;    ///< of the file in it
  std::unique_ptr<Raster> raster_;
};

}  // namespace spillway
