#pragma once

#include <span>

#include "src/library/mesh_view.h"

namespace spillway::library {

/// The value at a place of the function that is linear on the cell, which has the place inside or
/// on its boundary, and has values[v] at vertex v. Values of vertices whose barycentric coordinate
/// is 0 are not looked at.
template <int D, class Index>
double interpolated_value(const MeshView<D, Index>& mesh, std::span<const double> values,
                          Index cell, const Point<D>& place);

}  // namespace spillway::library
