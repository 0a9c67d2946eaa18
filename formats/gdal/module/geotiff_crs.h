#pragma once
// The coordinate system of GeoTIFF keys, within the module.

#include <string>

#include "formats/gdal/gdal.h"

namespace spillway::formats {

/// What Gdal::crs_of_geotiff_keys() returns.
std::string crs_of_geotiff_keys(const GeotiffKeys& keys, CrsKind kind);

}  // namespace spillway::formats
