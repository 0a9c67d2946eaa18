#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"

namespace spillway::formats {

/// Writes text, one point a line, its output coordinates separated by `separator`. Doubles have the
/// fewest digits that give the same double again; points of a lattice whose scales are powers of
/// ten have as many decimals as the scale.
std::unique_ptr<PointWriter> open_text_writer(std::unique_ptr<OutputFile> file,
                                              const PointWriterOptions& options, char separator);

}  // namespace spillway::formats
