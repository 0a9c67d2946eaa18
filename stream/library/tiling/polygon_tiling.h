#pragma once

#include <string>
#include <vector>

#include "stream/library/tiling/polygon_names.h"
#include "stream/library/tiling/raster_tiling.h"

namespace spillway::stream {

/// One file for each polygon of a vector file, of the pixels whose centres lie in it.
class PolygonTiling final : public RasterTiling {
 public:
  /// As read_named_polygons().
  PolygonTiling(const std::string& pattern, const std::string& polygons)
      : polygons_(read_named_polygons(pattern, polygons)) {}

  /// In the order of the polygons.
  [[nodiscard]] std::vector<RasterTile> tiles(const PixelGrid& raster) const override;
  /// None: any name could be that of a polygon.
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> /*paths*/) const override {
    return {};
  }
  [[nodiscard]] std::string crs() const override { return polygons_.crs; }

 private:
  NamedPolygons polygons_;
};

}  // namespace spillway::stream
