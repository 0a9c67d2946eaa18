// Stands in for the module in a build without GDAL.

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::formats {

const Gdal& gdal() {
  throw Failure(
      "coordinate systems, GeoTIFF, GeoPackage, Shapefile and GeoJSON need GDAL, which this build "
      "of Spillway does not have: build it with SPILLWAY_GDAL",
      ErrorCode::kInvalidArgument);
}

}  // namespace spillway::formats
