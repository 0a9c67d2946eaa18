#include "stream/source/common_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "formats/points/point_formats.h"

namespace spillway::stream {
namespace {

/// The largest integers of a LAS file and of any source, and the largest that a lattice may make of
/// either.
constexpr double kLargest32Bit = 0x1p31;
constexpr double kLargest = 0x1p52;
/// The smallest scale is divided by this number, at most.
constexpr std::int64_t kLargestDivisor = 1000;
constexpr double kScaleTolerance = 0x1p-51;
/// How far an error of the scale may carry the largest integer, in steps of that scale.
constexpr double kLargestError = kLargest32Bit * kScaleTolerance;
constexpr double kStepTolerance = 1e-6;
constexpr double kMostStepTolerance = 1e-3;

/// The least number by which `unit` is to be divided for `scale` to be a multiple of it; 0 if too
/// large.
std::int64_t divisor_of(double unit, double scale) {
  for (std::int64_t divisor = 1; divisor <= kLargestDivisor; ++divisor) {
    const double multiple = scale / unit * static_cast<double>(divisor);
    if (std::abs(multiple - std::round(multiple)) <= 4 * kScaleTolerance * multiple) return divisor;
  }
  return 0;
}

/// The largest number of which all scales are multiples.
std::optional<double> common_step(const std::set<double>& scales) {
  const double unit = *scales.begin();
  std::int64_t divisor = 1;
  for (const double scale : scales) {
    const std::int64_t these = divisor_of(unit, scale);
    if (these == 0) return std::nullopt;
    divisor = std::lcm(divisor, these);
    if (divisor > kLargestDivisor) return std::nullopt;
  }
  return unit / static_cast<double>(divisor);
}

/// Brings some axes of all lattices to one scale; false if that cannot be.
bool join_axes(std::span<const IntegerLattice> lattices, std::span<const double> largest,
               std::span<const int> axes, CommonLattice& common) {
  std::set<double> scales;
  for (const IntegerLattice& lattice : lattices) {
    for (const int k : axes) scales.insert(std::abs(lattice.scale[k]));
  }
  const std::optional<double> step = common_step(scales);
  if (!step) return false;
  for (const int k : axes) {
    double base = lattices.front().offset[k];
    for (const IntegerLattice& lattice : lattices) base = std::min(base, lattice.offset[k]);
    common.lattice.scale[k] = *step;
    common.lattice.offset[k] = base;
    for (std::size_t i = 0; i < lattices.size(); ++i) {
      const double scale = lattices[i].scale[k];
      const double offset = lattices[i].offset[k];
      const double factor = std::round(scale / *step);
      const double steps = (offset - base) / *step;
      const double shift = std::round(steps);
      const double last_place = std::numeric_limits<double>::epsilon() *
                                std::max(std::abs(offset), std::abs(base)) / *step;
      const double tolerance = std::max(kStepTolerance, std::min(last_place, kMostStepTolerance));
      const double integer = largest.empty() ? kLargest32Bit : largest[i];
      const double scale_tolerance =
          std::min(kScaleTolerance, kLargestError / integer) * std::abs(scale);
      const bool whole = std::abs(std::fma(factor, *step, -scale)) <= scale_tolerance &&
                         std::abs(steps - shift) <= tolerance;
      const bool moves = factor != 1 || shift != 0;
      const bool fits = integer * std::abs(factor) + std::abs(shift) <= kLargest;
      if (!whole || (moves && !fits)) return false;
      common.maps[i].factor[k] = factor;
      common.maps[i].shift[k] = shift;
    }
  }
  return true;
}

}  // namespace

double largest_integer(const PointHeader& header) {
  const PointFormat* const format = find_point_format(header.format);
  const double most = format != nullptr ? format->largest_integer : kLargest32Bit;
  if (most <= kLargest32Bit || !header.lattice || !header.extent) return most;
  double largest = kLargest32Bit;
  for (int k = 0; k < 3; ++k) {
    for (const double end : {header.extent->lo[k], header.extent->hi[k]}) {
      const double steps = (end - header.lattice->offset[k]) / header.lattice->scale[k];
      largest = std::max(largest, std::ceil(std::abs(steps)) + 1);
    }
  }
  return std::min(largest, most);
}

std::optional<CommonLattice> find_common_lattice(std::span<const IntegerLattice> lattices,
                                                 int dimension, std::span<const double> largest) {
  constexpr std::array kAxes = {0, 1, 2};
  const std::span<const int> axes(kAxes);
  CommonLattice common;
  common.maps.resize(lattices.size());
  if (dimension == 0) {
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      if (!join_axes(lattices, largest, axes.subspan(axis, 1), common)) return std::nullopt;
    }
    return common;
  }
  if (!join_axes(lattices, largest, axes.first(dimension), common)) return std::nullopt;
  if (dimension == 2 && !join_axes(lattices, largest, axes.last(1), common)) {
    common.heights = false;
    common.lattice.scale[2] = 1;
    common.lattice.offset[2] = 0;
    for (LatticeMap& map : common.maps) {
      map.factor[2] = 1;
      map.shift[2] = 0;
    }
  }
  return common;
}

}  // namespace spillway::stream
