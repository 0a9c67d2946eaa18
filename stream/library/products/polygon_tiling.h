#pragma once

#include <string>
#include <vector>

#include "formats/gdal/polygon_layer.h"
#include "stream/library/products/raster_tiling.h"

namespace spillway::stream {

/// One file for each polygon of a vector file, of the pixels whose centres lie in it.
class PolygonTiling final : public RasterTiling {
 public:
  /// The name of the file `pattern` holds fields of the polygons in braces, as in "dtm_{name}.tif".
  /// Throws Failure if `polygons` cannot be read, lacks such a field, or gives two files one name.
  PolygonTiling(const std::string& pattern, const std::string& polygons);

  /// In the order of the polygons.
  [[nodiscard]] std::vector<RasterTile> tiles(const PixelGrid& raster) const override;
  /// None: any name could be that of a polygon.
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> /*paths*/) const override {
    return {};
  }
  [[nodiscard]] std::string crs() const override { return layer_.crs; }

 private:
  PolygonLayer layer_;
  std::vector<std::string> paths_;  ///< by polygon
};

}  // namespace spillway::stream
