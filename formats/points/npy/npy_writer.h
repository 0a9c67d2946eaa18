#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes an npy array of float64, n x 2 or n x 3, of output coordinates; with attributes, n
/// structures with fields of their names. Without a promised count the header is written again at
/// the end, so the file must be able to go back.
std::unique_ptr<PointWriter> open_npy_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options);

}  // namespace spillway::formats
