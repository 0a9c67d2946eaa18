#include "stream/library/points/clip_polygons.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::stream {

void check_clip(const Clip& clip) {
  if (clip.polygons.empty() && (clip.buffer != 0 || clip.outside)) {
    throw InvalidArgument("a buffer, or the outside, of no polygons: name their file");
  }
  if (!std::isfinite(clip.buffer)) {
    throw InvalidArgument(fmt::format("a buffer of {} is no distance", clip.buffer));
  }
}

PolygonLayer read_clip(const Clip& clip) {
  check_clip(clip);
  return clip.buffer == 0 ? gdal().read_polygons(clip.polygons)
                          : gdal().read_buffers(clip.polygons, clip.buffer);
}

ClipArea clip_area(const PolygonLayer& layer, bool outside) {
  std::vector<PolygonEdges> polygons;
  for (const PolygonFeature& polygon : layer.polygons) polygons.emplace_back(polygon.rings);
  return {std::move(polygons), outside};
}

std::shared_ptr<const PolygonPixels> clipped_pixels(const PolygonLayer& layer, bool outside,
                                                    const PixelGrid& raster) {
  std::vector<PolygonPixels> polygons;
  for (const PolygonFeature& polygon : layer.polygons) {
    polygons.emplace_back(polygon.rings, raster);
  }
  return std::make_shared<PolygonPixels>(polygons, outside, raster);
}

}  // namespace spillway::stream
