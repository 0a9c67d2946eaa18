#pragma once

#include <array>
#include <limits>
#include <vector>

#include "src/delaunay/division/cut.h"
#include "stream/tiles/storage/tile.h"

namespace spillway::stream {

/// A cut that all points lie below.
constexpr Cut kNoCut{.axis = 0, .value = std::numeric_limits<double>::infinity()};

/// The points of a buffer on both sides of a cut, or of a second one on each side of the first:
/// four parts, empty ones among them, those below first. Each has the arrival and the run of the
/// buffer.
std::vector<HeldPoints> part_points(HeldPoints held, const Cut& first,
                                    const std::array<Cut, 2>& second);

}  // namespace spillway::stream
