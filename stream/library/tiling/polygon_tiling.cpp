#include "stream/library/tiling/polygon_tiling.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <utility>

#include "src/error.h"

namespace spillway::stream {

std::vector<RasterTile> PolygonTiling::tiles(const PixelGrid& raster) const {
  std::vector<RasterTile> tiles;
  for (std::size_t p = 0; p < polygons_.rings.size(); ++p) {
    auto outline = std::make_shared<PolygonPixels>(polygons_.rings[p], raster);
    if (outline->window().empty()) continue;
    const PixelWindow window = outline->window();
    tiles.push_back({window, polygons_.paths[p], std::move(outline)});
  }
  if (tiles.empty()) {
    throw InvalidArgument(fmt::format(
        "none of the polygons has a pixel of the raster, which reaches from {:.15g}, {:.15g} to "
        "{:.15g}, {:.15g}",
        raster.west, raster.north - raster.rows * raster.resolution,
        raster.west + raster.columns * raster.resolution, raster.north));
  }
  return tiles;
}

}  // namespace spillway::stream
