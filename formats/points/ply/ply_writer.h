#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes a PLY 1.0 cloud, binary and little-endian: vertices of doubles x, y and maybe z, and
/// attributes in their types. Without a promised count the header is written again at the end, so
/// the file must be able to go back.
std::unique_ptr<PointWriter> open_ply_point_writer(std::unique_ptr<OutputFile> file,
                                                   const PointWriterOptions& options);

}  // namespace spillway::formats
