#pragma once

#include <memory>

#include "formats/points/point_formats.h"

namespace spillway::formats {

/// Opens what begins as LAS: LAS 1.0 to 1.5, point formats 0 to 10, compressed (LAZ, COPC) or not,
/// as the header says. Throws Failure if none of `formats` reads a file with such a header.
std::unique_ptr<PointReader> open_las(PointInput input, const PointReaderOptions& options,
                                      PointFormats formats = point_formats());

}  // namespace spillway::formats
