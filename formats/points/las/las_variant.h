#pragma once
// LAS, LAZ and COPC begin alike: their headers tell which of them a file is.

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

/// One of the formats that begin as LAS.
struct LasVariant {
  /// Whether a file with this header is one of these.
  bool (*is_told)(const LasHeader& las);
  /// `source` has been read up to the points.
  std::unique_ptr<PointReader> (*open)(std::unique_ptr<InputBytes> source, const LasHeader& las,
                                       const std::string& path, const PointReaderOptions& options);
};

}  // namespace spillway::formats
