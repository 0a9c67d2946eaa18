#pragma once
// Points of the engine from and to those of a program, which are plain numbers in output
// coordinates.

#include <spillway/points.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::stream {

/// Points of a source or stream that has this lattice, or none, in output coordinates.
std::vector<Point<3>> public_points(const std::optional<IntegerLattice>& lattice,
                                    std::span<const LatticePoint> points);

/// A program's points as those of a source or stream without a lattice.
std::vector<LatticePoint> points_without_lattice(std::span<const Point<3>> points);

/// A lattice as programs see it, and theirs. Throws Failure(kInvalidArgument) for scales and offsets
/// that cannot be.
std::optional<Lattice> public_lattice(const std::optional<IntegerLattice>& lattice,
                                      bool has_z = true);
std::optional<IntegerLattice> checked_lattice(const std::optional<Lattice>& lattice);

/// A program's point of that number. Throws Failure(kInvalidArgument) unless its coordinates are
/// finite.
template <int D>
const Point<D>& finite_point(const Point<D>& point, std::uint64_t number);

/// The integer of a coordinate on an axis of a lattice. Throws Failure(kInvalidArgument) if there is
/// none, where `what` of that number ("point" 7) has the coordinate.
double integer_on(const IntegerLattice& lattice, int axis, double coordinate, const char* what,
                  std::uint64_t number);

/// The box that a program tells of `what` ("points", "a mesh"), if it does. Throws
/// Failure(kInvalidArgument) unless all numbers are finite and low is nowhere above high.
std::optional<Box<3>> told_box(const std::optional<Extent>& extent, const char* what);

/// The same of points. Throws likewise for a header of other than 2 or 3 coordinates.
std::optional<Box<3>> checked_box(const PointsHeader& header);

}  // namespace spillway::stream
