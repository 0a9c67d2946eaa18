#pragma once

#include <array>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::test {

/// The finite simplices of CGAL's Delaunay triangulation of all points, each as sorted input
/// indices (of equal points the lowest), the whole list sorted. Empty if the points span fewer
/// dimensions.
/// For D > 3 CGAL does not perturb: it has this set only where no D + 2 points are cospherical.
template <int D>
std::vector<std::array<VertexId, D + 1>> cgal_simplices(std::span<const Point<D>> points);

/// Number of CGAL's infinite simplices: the facets of the hull.
template <int D>
std::size_t cgal_hull_facets(std::span<const Point<D>> points);

}  // namespace spillway::test
