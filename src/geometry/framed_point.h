#pragma once
// Points that have left their source's coordinates, told apart by their types: one is not taken for
// the other, and both can be read as what they are, three numbers.

#include <optional>

#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway::detail {

/// A point in output coordinates.
struct WorldPoint : Point<3> {};

/// A point of a terrain as rasters are painted: x and y on the lattice, if there is one, z in
/// output units.
struct PlacedPoint : Point<3> {};

/// A point of a source, which is on `lattice` if that has one, in output coordinates.
inline WorldPoint in_world(const std::optional<Lattice>& lattice, const Point<3>& point) {
  return {lattice ? lattice->to_world(point) : point};
}

}  // namespace spillway::detail
