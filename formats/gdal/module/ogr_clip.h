#pragma once

#include <vector>

#include "formats/gdal/polygon_layer.h"

namespace spillway::formats {

/// As Gdal::clip().
std::vector<PolygonRings> clip_with_geos(const PolygonRings& polygon, const PolygonRings& area);

}  // namespace spillway::formats
