#include "formats/points/copc/writing/octree_cube.h"

#include <algorithm>
#include <cmath>

namespace spillway::formats {
namespace {

/// Places have 32 bits.
constexpr int kDeepest = 32 - static_cast<int>(OctreeCube::kFinestBits) - 1;
/// The deepest nodes have about so many steps along each axis: the cube is as close around the
/// points as a multiple of that allows.
constexpr double kStepsOfDeepest = 16;

}  // namespace

OctreeCube::OctreeCube(const IntegerLattice& lattice, const Box<3>& integers) {
  if (integers.empty()) return;
  const double step = *std::ranges::min_element(lattice.scale);
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    lowest_[axis] = integers.lo[axis];
    steps_[axis] = lattice.scale[axis] / step;
    extent = std::max(extent, integers.extent(axis) * steps_[axis] + 1);
  }
  const double levels = std::floor(std::log2(extent / kStepsOfDeepest));
  depth_ = static_cast<int>(std::clamp<double>(levels, 0, kDeepest));
  const double deepest = std::ceil(std::ldexp(extent, -depth_));  // steps of the deepest nodes
  cells_per_step_ = std::ldexp(1.0, kFinestBits) / deepest;
  halfsize_ = std::ldexp(deepest, depth_ - 1) * step;
  for (int axis = 0; axis < 3; ++axis) {
    centre_[axis] = lattice.to_world(axis, lowest_[axis]) - step / 2 + halfsize_;
  }
}

}  // namespace spillway::formats
