#include "stream/library/points/lattice_rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/error.h"
#include "src/geometry/lattice_check.h"

namespace spillway::stream {
namespace {

constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
constexpr double kMost = std::numeric_limits<std::int32_t>::max();

bool may_be_degrees(const Box<3>& extent) {
  return extent.lo[0] >= -180 && extent.hi[0] <= 180 && extent.lo[1] >= -90 && extent.hi[1] <= 90;
}

/// 0, or a multiple of a million steps, and of 1, in the middle of the interval.
double round_offset(double lo, double hi, double scale) {
  // Half of the range is left for points beyond the interval: it may be that of a first block.
  if (std::max(std::abs(lo), std::abs(hi)) / scale < kMost / 2) return 0;
  const double multiple = std::max(1.0, 1e6 * scale);
  return std::round((lo + (hi - lo) / 2) / multiple) * multiple;
}

}  // namespace

IntegerLattice chosen_lattice(const LatticeChoice& choice,
                              const std::optional<IntegerLattice>& source, const Box<3>& extent) {
  IntegerLattice lattice;
  const bool degrees = may_be_degrees(extent);
  for (int axis = 0; axis < 3; ++axis) {
    const auto of_axis = [&](const std::vector<double>& values) {
      return values[values.size() == 1 ? 0 : axis];
    };
    double& scale = lattice.scale[axis];
    if (!choice.scale.empty()) {
      scale = of_axis(choice.scale);
    } else {
      scale = source ? source->scale[axis] : degrees && axis < 2 ? 1e-7 : 0.001;
    }
    double& offset = lattice.offset[axis];
    if (!choice.offset.empty()) {
      offset = of_axis(choice.offset);
    } else if (source) {
      offset = source->offset[axis];
    } else if (!extent.empty()) {
      offset = round_offset(extent.lo[axis], extent.hi[axis], scale);
    }
  }
  return lattice;
}

LatticeRounding::LatticeRounding(std::string output, const IntegerLattice& target,
                                 const std::optional<IntegerLattice>& source, const Box<3>& extent)
    : output_(std::move(output)), target_(target), source_(source) {
  // What 32 bits do not reach is told by its point.
  Box<3> integers = integers_of(target, extent);
  for (int axis = 0; axis < 3 && !extent.empty(); ++axis) {
    integers.lo[axis] = std::clamp(integers.lo[axis], kLeast, kMost);
    integers.hi[axis] = std::clamp(integers.hi[axis], kLeast, kMost);
  }
  check_target(integers);
}

void LatticeRounding::check_target(const Box<3>& integers) const {
  check_lattice_to_write(output_, target_, integers, 3, Remedy::kPointLattice);
}

void LatticeRounding::round(std::span<LatticePoint> points, std::span<const std::uint64_t> index) {
  Box<3> integers;
  double farthest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    LatticePoint& p = points[i];
    const WorldPoint world = in_world(source_, p);
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = std::round((world[axis] - target_.offset[axis]) / target_.scale[axis]);
      if (!(p[axis] >= kLeast && p[axis] <= kMost)) {
        throw CannotWrite(
            output_,
            fmt::format("point {} is at ({}, {}, {}), but with scale {} and offset {} the 32-bit "
                        "integers of {} reach from {} to {} only",
                        index[i], world[0], world[1], world[2], target_.scale[axis],
                        target_.offset[axis], "xyz"[axis], target_.to_world(axis, kLeast),
                        target_.to_world(axis, kMost)),
            ErrorCode::kInvalidArgument, at_record(index[i]), Remedy::kPointLattice);
      }
      farthest = std::max(farthest, std::abs(target_.to_world(axis, p[axis]) - world[axis]));
    }
    integers.expand(p);
  }
  double before = farthest_;
  while (before < farthest && !farthest_.compare_exchange_weak(before, farthest)) {
  }
  check_target(integers);
}

}  // namespace spillway::stream
