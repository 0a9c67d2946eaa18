#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::stream {

/// How the integers of one lattice become those of a finer one: integer * factor + shift.
struct LatticeMap {
  std::array<double, 3> factor{1, 1, 1};
  std::array<double, 3> shift{};

  bool operator==(const LatticeMap&) const = default;

  [[nodiscard]] double map(int axis, double integer) const {
    return integer * factor[axis] + shift[axis];
  }
  [[nodiscard]] bool is_identity() const { return *this == LatticeMap{}; }
};

/// A lattice on which the points of several others lie.
struct CommonLattice {
  IntegerLattice lattice;
  bool heights = true;           ///< in the plane, false: z stays out, and has the identity map
  std::vector<LatticeMap> maps;  ///< one for each of the others, in their order
};

/// The largest integer of any coordinate that a source may give, its sign aside: 2^31 for LAS; for
/// spp up to 2^53, unless its extent says less.
double largest_integer(const PointHeader& header);

/// The coarsest lattice that has all points of `lattices`, with one positive scale for the axes
/// that are triangulated: all of their scales, which may be negative, are whole multiples of its
/// scale, and all offsets differ by whole steps. `largest` has the largest integer of each, or is
/// empty: 2^31 for all. Nothing if there is none with integers below 2^52; those that stay as they
/// are may have any size.
///
/// Scales and offsets are decimal numbers, rounded to doubles. So a multiple may be off by 2^-51 of
/// itself, if the largest integer carries that no further than 1e-6 of a step; an offset by 1e-6 of
/// a step, or by one unit in its last place, if that is below 1e-3 of a step. The result does not
/// depend on the order of `lattices`: the scale is theirs where all agree, and the offset is the
/// least one. With a `dimension` of 0 each axis may have a scale of its own.
std::optional<CommonLattice> find_common_lattice(std::span<const IntegerLattice> lattices,
                                                 int dimension,
                                                 std::span<const double> largest = {});

}  // namespace spillway::stream
