#pragma once

#include <string>

#include "formats/disk/file_system.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::formats {

/// The name of a picture's world file: that of the picture with the first and the last letter of
/// its extension and a w: view.png has view.pgw.
std::string world_file_path(const std::string& picture);

/// Writes a world file, as ESRI defines it: six lines with the width of a pixel, two rotations,
/// minus its height, and x and y of the centre of the upper left pixel. Throws Failure if it cannot
/// be written.
void write_world_file(FileSystem& files, const std::string& path, const PixelGrid& grid);

}  // namespace spillway::formats
