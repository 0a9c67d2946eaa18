#pragma once

#include <ogr_geometry.h>

#include <string>
#include <vector>

#include "formats/gdal/polygon_layer.h"

namespace spillway::formats {

/// Without the last one if that repeats the first one.
std::vector<Point<2>> points_of(const OGRLinearRing& ring);

/// As Gdal::read_polygons().
PolygonLayer read_ogr_polygons(const std::string& path);

/// As Gdal::read_buffers().
PolygonLayer read_ogr_buffers(const std::string& path, double distance);

}  // namespace spillway::formats
