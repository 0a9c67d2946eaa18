#pragma once

#include <memory>

#include "formats/file_system.h"
#include "formats/point_writer.h"

namespace spillway {

/// Writes LAS, point format 0: version 1.2, or 1.4 for more than 2^32 - 1 points. On a pipe, where
/// the header cannot be written again, its bounds are those of all 32-bit integers.
std::unique_ptr<PointWriter> open_las_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options);

}  // namespace spillway
