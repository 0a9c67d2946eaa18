#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// Writes a picture as PNG, "-" to standard output, and returns the file's bytes. `pixels` are red,
/// green, blue and opacity, a byte each, in rows from the top; without `with_opacity` the last one
/// is not written. Throws Failure if the picture is too large for PNG or the file cannot be written.
std::uint64_t write_png(FileSystem& files, const std::string& path, std::uint32_t columns,
                        std::uint32_t rows, std::span<const std::uint8_t> pixels,
                        bool with_opacity);

}  // namespace spillway::formats
