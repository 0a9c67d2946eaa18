#pragma once

#include <cstddef>
#include <span>

#include "src/geometry/point.h"

namespace spillway {

struct Timing {
  double seconds;
  std::size_t simplices;  ///< finite ones
};

/// CGAL's own Delaunay triangulation of the points (range constructor, spatial sorting included),
/// one thread.
template <int D>
Timing time_cgal_sequential(std::span<const Point<D>> points);

/// CGAL's parallel 3D Delaunay triangulation on so many threads, its lock grid fitted to the
/// points.
Timing time_cgal_parallel(std::span<const Point<3>> points, unsigned threads);

}  // namespace spillway
