#pragma once

#include "formats/points/common/point_format.h"

namespace spillway::detail {

extern const PointFormat kPlyPoints;

}  // namespace spillway::detail
