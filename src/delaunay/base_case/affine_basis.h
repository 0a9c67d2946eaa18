#pragma once

#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Places of affinely independent points, as many as there are (at most D+1): one less than their
/// number is the dimension of all points' affine hull. Exact. Reads no further than it must.
template <int D>
std::vector<VertexId> affine_basis(std::span<const Point<D>> points);

/// Whether a point lies outside of the affine hull of at most D affinely independent points. Exact.
template <int D>
bool is_independent(std::span<const Point<D>> basis, const Point<D>& p);

}  // namespace spillway::delaunay
