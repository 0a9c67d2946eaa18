#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Positions of the points in the order in which a Hilbert curve over `box`, which holds them all,
/// visits them. A cell of it with many points has a curve of its own; the few of one cell keep
/// their order, and so do points within 1e-300 of each other. Neighbours on the curve are
/// neighbours in space.
template <int D>
std::vector<VertexId> hilbert_order(std::span<const Point<D>> points, const Box<D>& box);

}  // namespace spillway::delaunay
