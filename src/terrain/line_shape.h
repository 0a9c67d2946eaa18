#pragma once
// Lines that are smoother, or have fewer points, than where a level crosses the edges of a
// triangulation, and never meet those of other levels: docs/contour.md.

#include <compare>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::terrain {

/// How far a line may be from where it is exactly, in units of x and y; 0: not at all.
struct LineTolerance {
  double smooth = 0;    ///< to bend less
  double simplify = 0;  ///< from the smooth line, to have fewer points
  [[nodiscard]] double sum() const { return smooth + simplify; }
};

/// The part of an edge over which a line may pass it, and where it passes it exactly. Parts of
/// different levels have no point in common and are in the order of the levels on every edge, so
/// lines that pass each edge within its part do not meet. In front of who goes along the line, one
/// end is to the left, the other one to the right.
struct Portal {
  Point<2> at{};
  Point<2> left{};
  Point<2> right{};
  auto operator<=>(const Portal&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// A line through portals, within its tolerance of where they are passed exactly: each pair of
/// neighbours bounds a piece of it, no point of which is farther from that of the exact piece in
/// the same proportion. The first and the last portal are passed exactly, unless they are equal:
/// then the line is closed, and its beginning may move to be smooth. Neighbours may be equal.
///
/// Smoothing moves each point by a half towards the straight line between its neighbours, along its
/// edge, a fixed number of times. The line of fewest bends is the shortest one, by the funnel of
/// D. T. Lee and F. P. Preparata, "Euclidean shortest paths in the presence of rectilinear
/// barriers", Networks 14 (1984), with exact predicates and in linear time.
std::vector<Point<2>> shaped_line(std::span<const Portal> portals, const LineTolerance& tolerance);

}  // namespace spillway::terrain
