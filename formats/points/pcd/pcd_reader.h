#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Opens a PCD file: its fields x, y and z, and the others as attributes. `path` is the source's
/// name as the user gave it. Throws BadInput for what is no PCD.
std::unique_ptr<PointReader> open_pcd_points(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid);

}  // namespace spillway::formats
