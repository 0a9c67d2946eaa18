#pragma once
// Polygons with holes, of the edges that bound them.

#include <compare>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::terrain {

/// A piece of a boundary; what it bounds lies to its left.
struct BoundaryEdge {
  Point<2> from{};
  Point<2> to{};
  auto operator<=>(const BoundaryEdge&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Distinct points; the last one is joined to the first one, which is the least in lexicographic
/// order.
using Ring = std::vector<Point<2>>;

struct PolygonWithHoles {
  Ring outer;               ///< counter-clockwise
  std::vector<Ring> holes;  ///< clockwise
};

/// The polygons that some edges bound: as many edges end at each point as begin there, and no two
/// cross. Edges that run to and fro cancel. Where rings meet at a point, each polygon is what hangs
/// together without going through points, and no ring comes to a point twice, as the standards of
/// simple features ask (OGC 06-103r4, 6.1.11). Rings that are flat are left out. Polygons and holes
/// come in lexicographic order, so they are a function of the set of edges. Takes some 200 bytes
/// an edge. Throws Failure if edges do not close.
std::vector<PolygonWithHoles> polygons_of_edges(std::vector<BoundaryEdge> edges);

}  // namespace spillway::terrain
