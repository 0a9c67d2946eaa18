#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Opens PLY without faces, binary of either byte order or ASCII. Vertices are points, and their
/// other numbers attributes; lists and other elements are passed over. Throws Failure that names the
/// file and the line or byte. `path` is the source's name as the user gave it; `skip_invalid` as
/// PointReaderOptions has it.
std::unique_ptr<PointReader> open_ply_points(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid = false);

}  // namespace spillway::formats
