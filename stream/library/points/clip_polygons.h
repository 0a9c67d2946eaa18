#pragma once

#include <spillway/clip.h>

#include <string>
#include <vector>

#include "formats/gdal/polygon_layer.h"
#include "stream/source/clip_area.h"

namespace spillway::stream {

/// Throws InvalidArgument for a clip that is none: a buffer, or the outside, of nothing.
void check_clip(const Clip& clip);

/// The polygons of a clip that has some, with its buffer, and their coordinate system. Throws
/// Failure if they cannot be read.
PolygonLayer read_clip(const Clip& clip);

/// The area that it keeps.
ClipArea clip_area(const PolygonLayer& layer, bool outside);

}  // namespace spillway::stream
