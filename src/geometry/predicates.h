#pragma once
// Exact predicates on points with double coordinates.
//
// Laws (for all finite doubles, subnormals and the largest values included):
//   1. `orientation` is the sign of a real determinant, never of a rounded one. Swapping two
//      arguments negates it. Translating all points by a vector that loses no bits keeps it.
//   2. `side_of_sphere` is the sign of the in-circle (in-sphere) determinant, and so is `in_sphere`
//      where that is not zero.
//   3. Where it is zero (cocircular, cospherical points) `in_sphere` answers as if each point's
//      lifted coordinate x^2 + y^2 (+ z^2) had been raised by eps^k, the lexicographically largest
//      point by the most (Devillers, Teillaud, "Perturbations for Delaunay and weighted Delaunay
//      3D triangulations", Comput. Geom. 44 (2011)). So it is never 0 on distinct points of a
//      positively oriented simplex, depends on nothing but coordinates, and picks exactly one
//      triangulation of every point set: the one that CGAL's Delaunay triangulations compute.
//   4. `in_sphere` is invariant under even permutations of the simplex.
// A coordinate that is infinite or not a number breaks the contract: Error may be thrown.
// Compiled with -ffp-contract=off, which the laws depend on.

#include <array>

#include "src/geometry/point.h"
#include "src/geometry/strict_arithmetic.h"

namespace spillway::geometry {

/// The sign of det[p1-p0, ..., pD-p0]: +1 if the D+1 points are positively oriented (2D:
/// counter-clockwise; 3D: seen from the last, the first three run counter-clockwise), -1 if
/// negatively, 0 if they lie in a common hyperplane.
template <int D>
int orientation(const std::array<Point<D>, D + 1>& simplex);

/// The sign of the in-circle (in-sphere) determinant, without perturbation: +1 if `p` lies inside
/// the circumsphere of `simplex`, which must be positively oriented, 0 if on it, -1 if outside.
template <int D>
int side_of_sphere(const std::array<Point<D>, D + 1>& simplex, const Point<D>& p);

/// +1 if `p` lies inside the circumsphere of `simplex`, which must be positively oriented, -1 if
/// outside; ties broken as law 3 says. 0 if and only if `p` equals one of the vertices.
template <int D>
int in_sphere(const std::array<Point<D>, D + 1>& simplex, const Point<D>& p);

}  // namespace spillway::geometry
