#pragma once
// Where a point lies in a triangle: decided by signs of exact determinants, so that triangles which
// share an edge neither leave a point out nor disagree about it.

#include <array>
#include <cstdint>
#include <optional>

#include "src/geometry/point.h"

namespace spillway::terrain {

/// A triangle with heights; x and y in the coordinates of what is looked for in it.
using Triangle = std::array<Point<3>, 3>;

/// The corners in lexicographic order: what is computed from them depends on nothing else.
Triangle in_canonical_order(const Triangle& triangle);

/// Where in a triangle a point lies, its corners being in canonical order.
enum class TriangleRelation : std::uint8_t {
  kInside,
  kEdge01,
  kEdge02,
  kEdge12,
  kCorner0,
  kCorner1,
  kCorner2,
};

struct TriangleLocation {
  TriangleRelation relation = TriangleRelation::kInside;
  /// Whether the triangle owns the point. One inside a triangulation, on a common edge or vertex
  /// too, has exactly one owner: the triangle that it lies in when moved east by nearly nothing,
  /// and north by nearly nothing of that. One on the hull may have none.
  bool owned = true;
};

/// How a triangle turns from its first canonical corner to its last: 1 counter-clockwise, -1
/// clockwise, 0 if it has no area.
int turn_of(const Triangle& canonical);

/// Where a point lies in the closed triangle, whose turn is not 0; nothing if it lies outside.
std::optional<TriangleLocation> locate(const Triangle& canonical, int turn, double x, double y);

}  // namespace spillway::terrain
