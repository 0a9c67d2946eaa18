#pragma once

#include <spillway/dem.h>

#include <memory>
#include <string>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "src/terrain/polygon_pixels.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::stream {

/// A file of a raster that is cut up.
struct RasterTile {
  PixelWindow window;
  std::string path;
  std::shared_ptr<const PolygonPixels> outline{};  ///< pixels beside it have no data; null: none
};

/// How a raster is cut into files.
class RasterTiling {
 public:
  RasterTiling() = default;
  virtual ~RasterTiling() = default;
  RasterTiling(const RasterTiling&) = delete;
  RasterTiling& operator=(const RasterTiling&) = delete;

  /// Those that have pixels of the raster. Throws InvalidArgument if it cannot be cut so.
  [[nodiscard]] virtual std::vector<RasterTile> tiles(const PixelGrid& raster) const = 0;
  /// The files in the folder whose names could be those of other tiles, sorted.
  [[nodiscard]] virtual std::vector<std::string> others_than(
      std::vector<std::string> paths) const = 0;
  /// The coordinate system that it is in; empty: that of the raster.
  [[nodiscard]] virtual std::string crs() const { return {}; }
};

/// The path of the VRT beside files of a pattern: without its parts in braces, and with one
/// separator where there were several; "tiles.vrt" if nothing is left.
std::string vrt_path_of(const std::string& pattern);

/// The tiling that options ask for, of files of a pattern; null if there is one file. Throws
/// InvalidArgument if they cannot be, and Failure if polygons cannot be read.
std::unique_ptr<RasterTiling> make_tiling(const std::string& pattern, const DemOptions& options);

}  // namespace spillway::stream
