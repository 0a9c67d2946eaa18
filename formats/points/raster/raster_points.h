#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Opens a raster by GDAL: the centre of each pixel is a point whose z is the first band, and whose
/// attributes are the other ones. Pixels without data are counted as invalid. `path` is the source's
/// name as the user gave it. Throws Failure for what is no raster of heights, and for a pipe.
std::unique_ptr<PointReader> open_raster_points(std::unique_ptr<InputBytes> source,
                                                const std::string& path);

}  // namespace spillway::formats
