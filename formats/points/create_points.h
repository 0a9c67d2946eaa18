#pragma once

#include <memory>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/point_formats.h"

namespace spillway::formats {

/// Opens `path` ("-": standard output). Throws InvalidArgument for what cannot be asked for.
std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options,
                                               PointFormats formats = point_formats());

/// The format that open_point_writer() chooses, which is one that is written. Throws
/// InvalidArgument as it does.
const PointFormat& point_format_to_write(const std::string& path, const std::string& format_name,
                                         PointFormats formats = point_formats());

}  // namespace spillway::formats
