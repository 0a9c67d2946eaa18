#include "src/geometry/torus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/error.h"

namespace spillway::geometry {
namespace {

constexpr std::array<char, 3> kNames{'x', 'y', 'z'};

/// Sides this close to an integer of the lattice, in steps, are meant to be it: decimals such as
/// 0.1 are no doubles.
constexpr double kSameStep = 1e-6;

/// Volumes and squares of periods are far from the ends of doubles.
constexpr double kShortest = 1e-90;
constexpr double kLongest = 1e90;

/// The largest integer up to which all are doubles.
constexpr double kExact = 9007199254740992.0;

double integer_of(const IntegerLattice& lattice, int axis, double side) {
  const double steps = (side - lattice.offset[axis]) / lattice.scale[axis];
  const double integer = std::nearbyint(steps);
  if (!(std::abs(steps - integer) <= kSameStep) || !(std::abs(integer) < kExact / 4)) {
    throw InvalidArgument(
        fmt::format("the side {0} = {1} of the periodic box lies between the steps of the points' "
                    "lattice (multiples of {2} from {3}): copies of points would not lie on it. "
                    "Choose a side on a step",
                    kNames[axis], side, lattice.scale[axis], lattice.offset[axis]));
  }
  return integer;
}

}  // namespace

Torus::Torus(const PeriodicBox& box, int dimension) : Torus(dimension) {
  check(box);
  for (int k = 0; k < dimension; ++k) {
    if (!box.periodic[k]) continue;
    const double low = box.box.low[k];
    const double high = box.box.high[k];
    const double farthest = std::max(std::abs(low - (high - low)), std::abs(high + (high - low)));
    const double step = std::ldexp(1.0, std::ilogb(farthest) - 52);
    Axis& axis = axes_[k];
    axis = {true, std::nearbyint(low / step) * step, 0, step};
    axis.period = std::nearbyint(high / step) * step - axis.low;
    if (!(axis.period >= 1024 * step)) {
      throw InvalidArgument(fmt::format(
          "the periodic box is {} long along {}, too short for doubles so far from 0: move it "
          "and the points towards 0",
          high - low, kNames[k]));
    }
  }
}

Torus::Torus(const PeriodicBox& box, int dimension, const IntegerLattice& lattice)
    : Torus(dimension) {
  check(box);
  for (int k = 0; k < dimension; ++k) {
    if (!box.periodic[k]) continue;
    double low = integer_of(lattice, k, box.box.low[k]);
    double high = integer_of(lattice, k, box.box.high[k]);
    if (lattice.scale[k] < 0) std::swap(low, high);
    axes_[k] = {true, low, high - low, 1};
  }
}

void Torus::check(const PeriodicBox& box) const {
  bool any = false;
  for (int k = 0; k < dimension_; ++k) {
    if (!box.periodic[k]) continue;
    any = true;
    const double low = box.box.low[k];
    const double high = box.box.high[k];
    if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
      throw InvalidArgument(fmt::format(
          "the periodic box has no length along {}: it goes from {} to {}", kNames[k], low, high));
    }
    if (!(high - low >= kShortest && high - low <= kLongest)) {
      throw InvalidArgument(
          fmt::format("the periodic box is {} long along {}: periods lie between {} and {}",
                      high - low, kNames[k], kShortest, kLongest));
    }
  }
  if (!any) throw InvalidArgument("the periodic box has no periodic axis");
}

bool Torus::closed() const {
  return std::all_of(axes_.begin(), axes_.begin() + dimension_,
                     [](const Axis& axis) { return axis.periodic; });
}

double Torus::shortest_period() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Axis& axis : axes_) {
    if (axis.periodic) shortest = std::min(shortest, axis.period);
  }
  return shortest;
}

PeriodicBox Torus::box() const {
  PeriodicBox box;
  for (int k = 0; k < 3; ++k) {
    box.periodic[k] = axes_[k].periodic;
    box.box.low[k] = axes_[k].low;
    box.box.high[k] = axes_[k].low + axes_[k].period;
  }
  return box;
}

void Torus::wrap(const Axis& axis, double& coordinate, Wrapping& result) {
  const double high = axis.low + axis.period;
  // Sums of such a number with others up to it are rounded to the step; numbers beyond it are
  // multiples of the step.
  const double rounder = std::copysign(kExact / 2 * axis.step, coordinate);
  const double on_step =
      std::abs(coordinate) < std::abs(rounder) ? (coordinate + rounder) - rounder : coordinate;
  if (on_step != coordinate) result.rounded = true;
  if (on_step >= axis.low && on_step < high) {
    if (!(coordinate >= axis.low)) result.moved = true;
    coordinate = on_step;
    return;
  }
  result.moved = true;
  // Remainders of division are exact, and so are sums of less than three periods.
  double rest = std::fmod(on_step, axis.period) - std::fmod(axis.low, axis.period);
  if (rest < 0) rest += axis.period;
  if (rest < 0) rest += axis.period;
  if (rest >= axis.period) rest -= axis.period;
  coordinate = axis.low + rest;
}

}  // namespace spillway::geometry
