#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/points/point_formats.h"

namespace spillway::formats {

/// Whether a file that begins with these bytes holds points, or something compressed, which only
/// points may be; false where the first bytes do not tell, as those of text.
bool begins_as_points(std::span<const std::byte> first_bytes,
                      PointFormats formats = point_formats());

/// Opens a source ("-": standard input) and checks its header. The format is that of the options,
/// else what the first bytes say, else that of the extension, with .gz, .bz2, .zst or .lz4 text,
/// else text if it looks like text.
std::unique_ptr<PointReader> open_point_reader(FileSystem& files, const std::string& path,
                                               const PointReaderOptions& options,
                                               PointFormats formats = point_formats());

}  // namespace spillway::formats
