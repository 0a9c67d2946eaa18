#include "formats/rasters/raster_formats.h"

#include <algorithm>

#include "formats/disk/extension.h"

namespace spillway::formats {

bool RasterFormat::is_named(std::string_view path) const {
  return std::ranges::find(extensions, extension_of(path)) != extensions.end();
}

}  // namespace spillway::formats
