#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::detail {

/// Opens an npy array of n x 2 or n x 3 elements of float64, float32, int32 or int64,
/// little-endian, rows one after another. `path` is the source's name as the user gave it;
/// `skip_invalid` as PointReaderOptions has it.
std::unique_ptr<PointReader> open_npy_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid = false);

}  // namespace spillway::detail
