#pragma once

#include <spillway/point_view.h>
#include <cstdint>
#include <limits>

#include "src/rooms.h"

namespace spillway::geometry {

/// Number of a vertex within one in-memory triangulation.
using VertexId = std::uint32_t;

/// The vertex at infinity: the apex of every infinite simplex. It is an id, never a far-away point.
inline constexpr VertexId kInfiniteVertex = std::numeric_limits<VertexId>::max();

/// No vertex at all: marks the slot of a simplex that was removed.
inline constexpr VertexId kNoVertex = kInfiniteVertex - 1;

/// The largest number of points that one in-memory triangulation holds.
inline constexpr std::size_t kMaxVertices = kNoVertex;

}  // namespace spillway::geometry
