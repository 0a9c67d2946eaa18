#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Opens an npy array: n x 2 or n x 3 integers, float32 or float64 of either byte order, further
/// columns being attributes; or n structures with fields x, y and maybe z, other fields being
/// attributes. In Fortran order it must be a file, not a pipe. `path` is the source's name as the
/// user gave it; `skip_invalid` as PointReaderOptions has it.
std::unique_ptr<PointReader> open_npy_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid = false);

}  // namespace spillway::formats
