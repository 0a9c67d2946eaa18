#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway {

/// Places of the points in the order in which a Hilbert curve over `box`, which holds them all,
/// visits them; those in one of its 2^30 or more cells in their own order. Neighbours on the curve
/// are neighbours in space (J. Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707,
/// 2004).
template <int D>
std::vector<VertexId> hilbert_order(std::span<const Point<D>> points, const Box<D>& box);

}  // namespace spillway
