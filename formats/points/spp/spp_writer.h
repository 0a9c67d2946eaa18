#pragma once

#include <memory>

#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes Spillway's own point stream. Throws Failure for points that are not finite or, if the
/// options have a lattice, no integers.
std::unique_ptr<PointWriter> open_spp_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options);

}  // namespace spillway::formats
