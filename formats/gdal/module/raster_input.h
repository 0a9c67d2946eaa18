#pragma once
// Rasters that are read, within the module.

#include <memory>
#include <string>

#include "formats/gdal/raster_source.h"

namespace spillway::formats {

/// What Gdal::open_raster() does.
std::unique_ptr<RasterSource> open_raster_source(const std::string& path);

}  // namespace spillway::formats
