#pragma once

#include <string>
#include <vector>

#include "formats/points/common/point_format.h"
#include "formats/points/common/point_reader.h"

namespace spillway::stream {

/// What points with these attributes, of files with these headers, have and a file that is written
/// so does not keep, by name: "intensity", "coordinate system".
std::vector<std::string> lost_fields(const AttributeLayout& attributes,
                                     const std::vector<PointHeader>& headers,
                                     const PointFormat& format, const PointWriterOptions& written);

}  // namespace spillway::stream
