#pragma once

#include <string>
#include <vector>

#include "formats/points/common/point_format.h"
#include "formats/points/common/point_reader.h"

namespace spillway::detail {

/// What files with these headers have and another file does not keep, in words: "intensity", "GPS
/// time". Classes, returns and flags are kept if `keeps_attributes`; `has_crs` says whether there
/// is a coordinate system.
std::vector<std::string> lost_fields(const std::vector<PointHeader>& headers,
                                     const PointFormat& format, bool keeps_attributes,
                                     bool has_crs);

}  // namespace spillway::detail
