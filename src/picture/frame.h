#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/geometry/box.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::picture {

/// The pixels of a picture that shows a box, `longest_side` of them on its longer side and a margin
/// around it included. The box must have an extent.
inline PixelGrid frame_around(const Box<2>& box, std::uint32_t longest_side, std::uint32_t margin) {
  PixelGrid frame;
  frame.resolution = std::max(box.extent(0), box.extent(1)) / (longest_side - 2 * margin);
  const auto pixels = [&](double length) {
    // What is a whole number but for rounding gets no pixel more.
    return std::max(1U, static_cast<std::uint32_t>(std::ceil(length / frame.resolution - 1e-6))) +
           2 * margin;
  };
  frame.columns = pixels(box.extent(0));
  frame.rows = pixels(box.extent(1));
  frame.west = box.lo[0] - margin * frame.resolution;
  frame.north = box.hi[1] + margin * frame.resolution;
  return frame;
}

}  // namespace spillway::picture
