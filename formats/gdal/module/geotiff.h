#pragma once
// GeoTIFF, within the module.

#include <memory>
#include <string>

#include "formats/gdal/raster.h"

namespace spillway::formats {

/// What Gdal::check_raster_driver() does.
void check_geotiff_driver(const RasterOptions& options);

/// What Gdal::create_raster() returns.
std::unique_ptr<Raster> create_geotiff(const RasterOptions& options);

/// What Gdal::read_raster_grid() returns.
RasterGrid read_geotiff_grid(const std::string& path);

}  // namespace spillway::formats
