#include "src/geometry/lattice_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spillway::geometry {
namespace {

bool is_exact_on(int axis, const IntegerLattice& lattice, const Box<3>& integers, int dimension) {
  const double lo = integers.lo[axis];
  const double hi = integers.hi[axis];
  return axis < dimension ? lattice.keeps_apart(axis, lo, hi) : lattice.is_finite(axis, lo, hi);
}

/// What is wrong with the lattice, or "" if it is_exact().
std::string fault_of(const IntegerLattice& lattice, const Box<3>& integers, int dimension) {
  if (integers.empty()) return "";
  int axis = 0;
  while (axis < 3 && is_exact_on(axis, lattice, integers, dimension)) ++axis;
  if (axis == 3) return "";
  const std::string map = fmt::format("{} is an integer times {} plus {}", "xyz"[axis],
                                      lattice.scale[axis], lattice.offset[axis]);
  const double at_lo = lattice.to_world(axis, integers.lo[axis]);
  const double at_hi = lattice.to_world(axis, integers.hi[axis]);
  if (!std::isfinite(at_hi - at_lo)) {
    return fmt::format("{}, which is more than a number holds", map);
  }
  const double far = std::max(std::abs(at_lo), std::abs(at_hi));
  return fmt::format(
      "{}, but numbers as large as {:.6g} are {:.3g} apart, so that neighbours would become one "
      "point",
      map, far, std::nextafter(far, std::numeric_limits<double>::infinity()) - far);
}

}  // namespace

bool is_exact(const IntegerLattice& lattice, const Box<3>& integers, int dimension) {
  if (integers.empty()) return true;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_exact_on(axis, lattice, integers, dimension)) return false;
  }
  return true;
}

void check_lattice(const FileSpot& where, const IntegerLattice& lattice, const Box<3>& integers,
                   int dimension) {
  const std::string fault = fault_of(lattice, integers, dimension);
  if (fault.empty()) return;
  throw BadInput(where, fault +
                            "; the header is corrupt, or the points need a larger scale or a "
                            "smaller offset");
}

void check_lattice_to_write(const std::string& file, const IntegerLattice& lattice,
                            const Box<3>& integers, int dimension, Remedy remedy) {
  const std::string fault = fault_of(lattice, integers, dimension);
  if (!fault.empty()) throw CannotWrite(file, fault, ErrorCode::kInvalidArgument, {}, remedy);
}

double exact_up_to(const IntegerLattice& lattice, int dimension) {
  for (double most = 0x1p53; most >= 1; most /= 2) {
    if (is_exact(lattice, {{-most, -most, -most}, {most, most, most}}, dimension)) return most;
  }
  return 0;
}

/// Without a comparison, so that several are looked at in one step: the bits of numbers are in the
/// order of their sizes, and the sum reaches the highest bit if one is larger.
bool any_beyond(std::span<const LatticePoint> points, double most) {
  constexpr std::uint64_t kLargestBits = std::numeric_limits<std::int64_t>::max();
  const std::uint64_t up_to_highest = kLargestBits - std::bit_cast<std::uint64_t>(most);
  std::uint64_t sums = 0;
  for (const LatticePoint& point : points) {
    for (const double coordinate : point) {
      sums |= std::bit_cast<std::uint64_t>(std::abs(coordinate)) + up_to_highest;
    }
  }
  return sums > kLargestBits;
}

Box<3> nearest_integers(const IntegerLattice& lattice, const Box<3>& world) {
  Box<3> box;
  for (const Point<3>& corner : {world.lo, world.hi}) {
    Point<3> integers;
    for (int axis = 0; axis < 3; ++axis) {
      integers[axis] = std::round((corner[axis] - lattice.offset[axis]) / lattice.scale[axis]);
    }
    box.expand(integers);
  }
  return box;
}

Box<3> integers_of(const IntegerLattice& lattice, const Box<3>& world) {
  Box<3> integers;
  if (world.empty()) return integers;
  for (int axis = 0; axis < 3; ++axis) {
    const double at_lo = (world.lo[axis] - lattice.offset[axis]) / lattice.scale[axis];
    const double at_hi = (world.hi[axis] - lattice.offset[axis]) / lattice.scale[axis];
    integers.lo[axis] = std::floor(std::min(at_lo, at_hi)) - 1;  // a scale may be negative
    integers.hi[axis] = std::ceil(std::max(at_lo, at_hi)) + 1;
  }
  return integers;
}

}  // namespace spillway::geometry
