#pragma once
// Small point sets that are hard for a triangulator, and the comparison of the own kernels with
// CGAL on them: for the tests and for the driver that goes on as long as asked.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/delaunay/kernel_common/lane_width.h"
#include "src/geometry/point.h"

namespace spillway::test {

/// Limits the lanes of the kernels for the length of its life.
class LaneLimit {
 public:
  explicit LaneLimit(int doubles) { limit_lanes(doubles); }
  ~LaneLimit() { limit_lanes(8); }
  LaneLimit(const LaneLimit&) = delete;
  LaneLimit& operator=(const LaneLimit&) = delete;
};

/// The set that belongs to a seed: a few points to some tens, on lattices, lines, planes, circles
/// and spheres, repeated, nearly cocircular or cospherical, at huge offsets or of extreme size.
template <int D>
std::vector<Point<D>> hard_set(std::uint64_t seed);

/// What is wrong with the kernel's triangulation of the points, given in an order and with input
/// indices that depend on the seed; empty if it equals CGAL's and its neighbours are right.
template <int D>
std::string compare_kernel_with_cgal(std::span<const Point<D>> points, std::uint64_t seed);

}  // namespace spillway::test
