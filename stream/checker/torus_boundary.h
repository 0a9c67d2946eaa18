#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "src/geometry/point.h"
#include "src/geometry/torus.h"

namespace spillway::checker {

/// What the boundary of a periodic mesh is like.
struct TorusBoundary {
  std::string fault;  ///< empty: all of it lies on the hull of all copies
  double volume = 0;  ///< of that hull within the box, rounded
};

/// `facets`: those of one simplex only, none of a closed torus. Along axes that are open the points
/// lie between `low` and `high`.
template <int D>
TorusBoundary torus_boundary(const Torus& torus, const Point<D>& low, const Point<D>& high,
                             const std::vector<std::array<Point<D>, D>>& facets);

}  // namespace spillway::checker
