#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway {

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
  Lattice lattice;
  bool heights = true;           ///< in the plane, false: z stays out, and has the identity map
  std::vector<LatticeMap> maps;  ///< one for each of the others, in their order
};

/// The coarsest lattice that has all points of `lattices` (32-bit integers), with one scale for the
/// axes that are triangulated: all of their scales are whole multiples of its scale, and all
/// offsets differ by whole steps. Nothing if there is none with integers below 2^52.
///
/// Scales and offsets are decimal numbers, rounded to doubles. So a multiple may be off by 2^-51 of
/// itself, which no 32-bit integer carries further than 1e-6 of a step; an offset by 1e-6 of a
/// step, or by one unit in its last place, if that is below 1e-3 of a step. The result does not
/// depend on the order of `lattices`: the scale is theirs where all agree, and the offset is the
/// least one.
std::optional<CommonLattice> find_common_lattice(std::span<const Lattice> lattices, int dimension);

}  // namespace spillway
