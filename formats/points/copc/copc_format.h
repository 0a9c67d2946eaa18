#pragma once

#include "formats/points/common/point_format.h"

namespace spillway::detail {

extern const PointFormat kCopcPoints;

}  // namespace spillway::detail
