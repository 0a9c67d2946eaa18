#pragma once

#include <string>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "src/rooms.h"

namespace spillway::formats {

/// As Gdal::mosaic_text().
std::string mosaic_text(const std::vector<std::string>& rasters, const PixelGrid& place,
                        const std::string& path);

}  // namespace spillway::formats
