#pragma once

#include <cmath>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::generators {

/// The smallest side with side^dimension >= count, at least 1.
inline std::uint64_t grid_side(std::uint64_t count, int dimension) {
  const auto n = static_cast<double>(count);
  auto side = static_cast<std::uint64_t>(std::pow(n, 1.0 / dimension));
  side = side > 2 ? side - 2 : 1;  // the rounded root may be too large by one
  const auto holds_all = [&](std::uint64_t s) {
    unsigned __int128 all = 1;
    for (int k = 0; k < dimension && all < count; ++k) all *= s;
    return all >= count;
  };
  while (!holds_all(side)) ++side;
  return side;
}

}  // namespace spillway::generators
