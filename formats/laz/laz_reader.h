#pragma once

#include <memory>
#include <string>

#include "formats/input_source.h"
#include "formats/las_header.h"
#include "formats/point_reader.h"

namespace spillway::detail {

/// Reads the compressed points of a LAZ or COPC file, of which `source` has been read up to them.
/// `path` is the source's name as the user gave it. Of a COPC file only the nodes are read that the
/// options want. Throws Error for a pipe that cannot be read in order.
std::unique_ptr<PointReader> open_laz_reader(std::unique_ptr<InputSource> source,
                                             const LasHeader& las, const std::string& path,
                                             const PointReaderOptions& options);

}  // namespace spillway::detail
