#pragma once
// Named tables of colours for values from low to high.

#include <span>
#include <string_view>

#include "src/picture/colour.h"

namespace spillway::picture {

struct Ramp {
  std::string_view name;
  std::span<const Colour> colours;  ///< evenly spaced, from low to high
};

/// The first one is that of a relief's heights.
std::span<const Ramp> all_ramps();

/// Null if there is none of that name.
const Ramp* find_ramp(std::string_view name);

}  // namespace spillway::picture
