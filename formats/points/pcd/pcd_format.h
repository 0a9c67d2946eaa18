#pragma once

#include "formats/points/common/point_format.h"

namespace spillway::formats {

/// PCD, the format of the Point Cloud Library: docs/formats-points.md ("PCD").
extern const PointFormat kPcdPoints;

}  // namespace spillway::formats
