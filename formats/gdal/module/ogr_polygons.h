#pragma once

#include <string>

#include "formats/gdal/polygon_layer.h"

namespace spillway::formats {

/// As Gdal::read_polygons().
PolygonLayer read_ogr_polygons(const std::string& path);

}  // namespace spillway::formats
