#pragma once

#include <spillway/clip.h>

#include <memory>

#include "formats/gdal/polygon_layer.h"
#include "src/geometry/pixel_grid.h"
#include "src/terrain/polygon_pixels.h"
#include "stream/source/clip_area.h"

namespace spillway::stream {

/// Throws InvalidArgument for a clip that is none: a buffer, or the outside, of nothing.
void check_clip(const Clip& clip);

/// The polygons of a clip that has some, with its buffer, and their coordinate system. Throws
/// Failure if they cannot be read.
PolygonLayer read_clip(const Clip& clip);

/// The area that it keeps.
ClipArea clip_area(const PolygonLayer& layer, bool outside);

/// The pixels of a raster that it keeps, by their centres.
std::shared_ptr<const PolygonPixels> clipped_pixels(const PolygonLayer& layer, bool outside,
                                                    const PixelGrid& raster);

}  // namespace spillway::stream
