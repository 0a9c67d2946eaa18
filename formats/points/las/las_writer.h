#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes LAS: version 1.2 with point format 0, or 1.4 with point format 6, which counts more than
/// 2^32 - 1 points and holds more classes, more returns and the overlap flag. Counts and bounds are
/// written into the header at the end. Where that cannot be done, the promised count is trusted,
/// the bounds are those of all 32-bit integers, and the counts by return, if attributes come, are
/// 0.
std::unique_ptr<PointWriter> open_las_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options);

}  // namespace spillway::formats
