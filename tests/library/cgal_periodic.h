#pragma once

#include <spillway/periodic.h>

#include <array>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::test {

/// The cells of CGAL's periodic Delaunay triangulation of distinct points in the box, which must be
/// a square or a cube, each as sorted numbers of points, the whole list sorted. Throws
/// std::runtime_error if the points are too few for a triangulation of one copy of the box.
template <int D>
std::vector<std::array<VertexId, D + 1>> cgal_periodic_simplices(std::span<const Point<D>> points,
                                                                 const PeriodicBox& box);

}  // namespace spillway::test
