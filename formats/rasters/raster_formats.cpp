#include "formats/rasters/raster_formats.h"

#include <algorithm>

#include "formats/disk/extension.h"

namespace spillway::detail {

bool RasterFormat::is_named(std::string_view path) const {
  return std::ranges::find(extensions, extension_of(path)) != extensions.end();
}

}  // namespace spillway::detail
