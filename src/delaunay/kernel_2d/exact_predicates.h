#pragma once
// The later stages of the 2D kernel's predicates, for what its filters leave open: double-double
// arithmetic or 128-bit integers, big integers, and the tie rule. Bounds are derived in
// docs/algorithm-kernel-2d.md.

#include <optional>

#include "src/delaunay/kernel_2d/working_points.h"

namespace spillway::delaunay::kernel_2d {

/// Four vertices, all finite.
struct Quad {
  VertexId a, b, c, query;
};

/// In-circle determinant of a, b, c and the query in doubles: its sign, or nothing if it does not
/// exceed a bound that is tighter than that of the inner loop's filter for long triangles. Never 0.
std::optional<int> in_circle_filtered(const WorkingPoints& points, const Quad& quad);

/// In-circle determinant of a, b, c and the query in double-double arithmetic: its sign, or nothing
/// if that is not certain. Never 0.
std::optional<int> in_circle_double_double(const WorkingPoints& points, const Quad& quad);

/// The same in 64- and 128-bit integers, for lattice points: its sign, or nothing if they are
/// farther apart than 2^30.5.
std::optional<int> in_circle_integer(const WorkingPoints& points, const Quad& quad);

/// Whether the four are the corners of a rectangle along the axes, a, c opposite each other and b
/// opposite the query: then they lie on a circle. Grids of decimal numbers are full of these.
bool is_rectangle(const WorkingPoints& points, const Quad& quad);

/// The sign of the in-circle determinant by all these and, last, by big integers.
int side_of_circle(const WorkingPoints& points, const Quad& quad);

/// +1 if the query lies to the left of a -> b, -1 if to the right, 0 if on the line. Exact.
int side_of_line(const WorkingPoints& points, VertexId a, VertexId b, VertexId query);

/// Whether the query is in conflict with the triangle a, b, c, which is counter-clockwise, or
/// infinite with one vertex kInfinite. Where all four lie on a circle, a and c are to be opposite
/// each other on it.
bool conflicts(const WorkingPoints& points, const Quad& quad);

}  // namespace spillway::delaunay::kernel_2d
