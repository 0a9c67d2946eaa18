#include "formats/rasters/world_file.h"

#include <fmt/format.h>

#include "formats/bytes/bytes.h"
#include "formats/disk/extension.h"

namespace spillway::formats {

std::string world_file_path(const std::string& picture) {
  const std::string extension = extension_of(picture);
  const std::string stem = picture.substr(0, picture.size() - extension.size());
  return fmt::format("{}{}{}w", stem, extension.front(), extension.back());
}

void write_world_file(FileSystem& files, const std::string& path, const PixelGrid& grid) {
  const auto file = files.create(path);
  file->write(as_bytes_of(fmt::format("{}\n0\n0\n{}\n{}\n{}\n", grid.resolution, -grid.resolution,
                                      grid.centre_x(0), grid.centre_y(0))));
  file->commit();
}

}  // namespace spillway::formats
