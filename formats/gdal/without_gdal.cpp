// Stands in for the module in a build without GDAL.

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::detail {

const Gdal& gdal() {
  throw Error(
      "coordinate systems, GeoTIFF, GeoPackage, Shapefile and GeoJSON need GDAL, which this build "
      "of Spillway does not have: build it with SPILLWAY_GDAL",
      ErrorCode::kInvalidArgument);
}

}  // namespace spillway::detail
