#pragma once

#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats {

/// Which points a node of a written octree keeps, of those in its cube that no node above has: all,
/// if these are few or it is one of the deepest; else a sample, which is the first point of each of
/// its sample cells, but not more than a node has. The others go to its children.
struct OctreeRules {
  std::uint64_t most_points = 100'000;  ///< of a node that is none of the deepest
  unsigned sample_bits = 7;             ///< a node has 2^sample_bits sample cells along each axis
};

}  // namespace spillway::formats
