#pragma once

#include <optional>

#include "src/geometry/box.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::terrain {

/// How the pixels of a raster are to lie.
struct GridRequest {
  double resolution = 1;
  std::optional<Box<2>> bounds{};    ///< to be covered; nothing: the extent of the points
  bool align = false;                ///< edges of pixels are multiples of the resolution
  std::optional<PixelGrid> given{};  ///< another raster's, which overrules all of the above
};

/// The smallest grid that covers the box asked for; its upper left corner is that of the box unless
/// aligned. `extent` is that of the points, in output coordinates. Throws InvalidArgument, naming
/// the raster's size, if there would be more rows or columns than GeoTIFF can count.
PixelGrid choose_grid(const GridRequest& request, const Box<2>& extent);

}  // namespace spillway::terrain
