#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_source.h"
#include "formats/points/common/point_reader.h"

namespace spillway::detail {

/// Opens LAS 1.0 to 1.5, point formats 0 to 10, compressed (LAZ, COPC) or not, as the header says.
/// `path` is the source's name as the user gave it.
std::unique_ptr<PointReader> open_las(std::unique_ptr<InputSource> source, const std::string& path,
                                      const PointReaderOptions& options);

}  // namespace spillway::detail
