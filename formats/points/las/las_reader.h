#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

/// Reads the points of a LAS file that are not compressed, of which `source` has been read up to
/// them. `path` is the source's name as the user gave it.
std::unique_ptr<PointReader> open_las_reader(std::unique_ptr<InputBytes> source,
                                             const LasHeader& las, const std::string& path,
                                             const PointReaderOptions& options);

}  // namespace spillway::formats
