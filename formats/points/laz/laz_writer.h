#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes LAZ: what open_las_writer() writes, compressed in chunks of 50,000 points, those of point
/// format 0 pointwise and those of 6 in layers. Where nobody can come back to write where the chunk
/// table is, the last 8 bytes of the file tell it.
std::unique_ptr<PointWriter> open_laz_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options);

}  // namespace spillway::formats
