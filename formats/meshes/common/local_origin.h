#pragma once
// Formats of float32 keep large coordinates exact enough by an origin close to the mesh.

#include <optional>

#include "src/geometry/point.h"

namespace spillway::detail {

/// An origin for a mesh with this vertex: its coordinates rounded to whole numbers, and to nine
/// digits, so that it can be said in few characters.
Point<3> local_origin(const Point<3>& vertex);

/// `vertex` as seen from `origin`, rounded to float; nothing if that is beyond float's range.
std::optional<std::array<float, 3>> to_local(const Point<3>& vertex, const Point<3>& origin);

}  // namespace spillway::detail
