#pragma once
// Small point sets in the plane that are hard for a triangulator, and the comparison of the 2D
// kernel with CGAL on them: for the tests and for the driver that goes on as long as asked.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/geometry/point.h"

namespace spillway {

/// The set that belongs to a seed: a few points to some tens, on lattices, lines and circles,
/// repeated, nearly cocircular, at huge offsets or of extreme size.
std::vector<Point<2>> hard_set(std::uint64_t seed);

/// What is wrong with the kernel's triangulation of the points, given in an order and with input
/// indices that depend on the seed; empty if it equals CGAL's and its neighbours are right.
std::string compare_kernel_with_cgal(std::span<const Point<2>> points, std::uint64_t seed);

}  // namespace spillway
