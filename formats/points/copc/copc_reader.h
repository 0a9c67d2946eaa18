#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

/// Reads the points of a COPC file, of which `source` has been read up to them: of the nodes of its
/// octree that the options want, or all of them. `path` is the source's name as the user gave it.
/// Throws Failure for levels of a pipe, which cannot be chosen.
std::unique_ptr<PointReader> open_copc_reader(std::unique_ptr<InputBytes> source,
                                              const LasHeader& las, const std::string& path,
                                              const PointReaderOptions& options);

}  // namespace spillway::formats
