#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/geometry/box.h"

namespace spillway::stream {

/// A part of the points to come, all of which lie in a box. Regions of one unit come one after the
/// other: those of an input that can only be read from front to back.
struct InputRegion {
  std::size_t unit = 0;
  Box<3> box;  ///< in the coordinates in which points are dealt
  std::uint64_t count = 0;
};

/// In which order to read them.
struct RegionOrder {
  std::vector<std::size_t> units{};    ///< in the order in which to read them
  std::vector<std::size_t> regions{};  ///< in the order in which they come then
};

}  // namespace spillway::stream
