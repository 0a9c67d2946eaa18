#pragma once
// The later stages of the 3D kernel's predicates, for what its cached spheres leave open: a tighter
// filter, wide integers, big integers, and the tie rule. Bounds are derived in
// docs/algorithm-kernel-3d.md.

#include <array>
#include <optional>

#include "src/delaunay/kernel_3d/working_points.h"

namespace spillway::delaunay::kernel_3d {

/// Finite vertices: those of a cell, and the query.
struct Five {
  std::array<VertexRef, 4> cell;
  VertexRef query;
};

/// In-sphere determinant in doubles: its sign, or nothing if it does not exceed a bound that is
/// tighter than that of the cached spheres for flat cells. Never 0.
std::optional<int> in_sphere_filtered(const WorkingPoints& points, const Five& five);

/// The same, corrected by a sphere that all five are near to, for instance the cached one: centre
/// and squared radius. Its bound is tighter the nearer they are; what the sphere is, does not
/// matter otherwise.
std::optional<int> in_sphere_corrected(const WorkingPoints& points, const Five& five,
                                       const double* sphere);

/// The determinant of p1-p0, p2-p0, p3-p0.
std::optional<int> orientation_filtered(const WorkingPoints& points,
                                        const std::array<VertexRef, 4>& p);

/// In-sphere determinant in integers: its sign, or nothing if the coordinates are not multiples of
/// a power of two that is small enough. kLimbs = 1: their largest magnitude over 2^60; 2: over
/// 2^124. IntegerLattice points always are.
template <int kLimbs>
std::optional<int> in_sphere_integer(const WorkingPoints& points, const Five& five);

/// The same for the orientation.
template <int kLimbs>
std::optional<int> orientation_integer(const WorkingPoints& points,
                                       const std::array<VertexRef, 4>& p);

/// The sign of the in-sphere determinant by all these and, last, by big integers: +1 if the query
/// is inside.
int side_of_sphere(const WorkingPoints& points, const Five& five, const double* sphere);

/// The sign of the determinant of p1-p0, p2-p0, p3-p0, exactly.
int orientation(const WorkingPoints& points, const std::array<VertexRef, 4>& p);

/// Whether the query, on the sphere of a positively oriented cell, is in conflict with it: the tie
/// rule of in_sphere().
bool tie_conflicts(const WorkingPoints& points, const Five& five);

}  // namespace spillway::delaunay::kernel_3d
