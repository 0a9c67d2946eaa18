#pragma once
// Formats of float32 keep large coordinates exact enough by an origin close to the mesh.

#include <optional>

#include "src/geometry/framed_point.h"

namespace spillway::formats {

/// An origin for a mesh with this vertex: its coordinates rounded to whole numbers, and to nine
/// digits, so that it can be said in few characters.
WorldPoint local_origin(const WorldPoint& vertex);

/// `vertex` as seen from `origin`, rounded to float; nothing if that is beyond float's range.
std::optional<std::array<float, 3>> to_local(const WorldPoint& vertex, const WorldPoint& origin);

}  // namespace spillway::formats
