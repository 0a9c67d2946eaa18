#pragma once

#include "formats/points/common/point_format.h"

namespace spillway::formats {

/// Rasters as points, of any format that GDAL reads: docs/formats-points.md ("Rasters").
extern const PointFormat kRasterPoints;

}  // namespace spillway::formats
