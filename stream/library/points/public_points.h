#pragma once
// Points of the engine from and to those of a program, which are plain numbers in output
// coordinates.

#include <optional>
#include <span>
#include <vector>

#include "src/geometry/lattice.h"

namespace spillway::detail {

/// Points of a source or stream that has this lattice, or none, in output coordinates.
std::vector<Point<3>> public_points(const std::optional<Lattice>& lattice,
                                    std::span<const LatticePoint> points);

/// A program's points as those of a source or stream without a lattice.
std::vector<LatticePoint> points_without_lattice(std::span<const Point<3>> points);

}  // namespace spillway::detail
