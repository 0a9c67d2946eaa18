#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Reads Spillway's own point stream from `source`; `path` is its name as the user gave it. Points
/// are numbered as they come.
std::unique_ptr<PointReader> open_spp_reader(std::unique_ptr<InputBytes> source,
                                             const std::string& path);

}  // namespace spillway::formats
