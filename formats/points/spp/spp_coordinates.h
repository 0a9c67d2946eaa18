#pragma once

#include <cstddef>
#include <span>

#include "src/rooms.h"

namespace spillway::formats {

/// The first of `values` that is no coordinate (not finite or, if they are to be on a lattice, no
/// integer from -2^53 to 2^53); their number if all are.
std::size_t first_invalid_coordinate(std::span<const double> values, bool on_lattice);

}  // namespace spillway::formats
