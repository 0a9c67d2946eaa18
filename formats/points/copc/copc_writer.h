#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes COPC: docs/formats-points.md ("COPC, written"). Points wait until all are there, in
/// memory or, beyond about a quarter of PointWriterOptions::memory, in scratch files. Throws Failure
/// on finish() if the file cannot be written at any byte.
std::unique_ptr<PointWriter> open_copc_writer(std::unique_ptr<OutputFile> file,
                                              const PointWriterOptions& options);

}  // namespace spillway::formats
