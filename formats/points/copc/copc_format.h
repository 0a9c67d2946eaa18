#pragma once

#include "formats/points/common/point_format.h"

namespace spillway::formats {

extern const PointFormat kCopcPoints;

}  // namespace spillway::formats
