#pragma once
// A terrain as it is seen aslant, from afar: by parallel rays.

#include <cstdint>

#include "src/picture/height_field.h"
#include "src/picture/picture.h"

namespace spillway::picture {

struct TiltedView {
  double azimuth = 0;        ///< clockwise from north, in degrees, of where one looks from
  double elevation = 0;      ///< likewise above the horizon; above 0, and 90 at most
  std::uint32_t size = 0;    ///< pixels of the longer side
  std::uint32_t margin = 0;  ///< around what is seen
};

/// Draws a map, which lies on the surface of a terrain, as it is seen aslant. Where the terrain
/// ends it is cut down to the height of its lowest place. What is not hit is transparent; a pixel
/// is the mean of nine samples. Throws Failure (kDegenerateInput) if the terrain has but one pixel.
Picture draw_tilted(const Picture& map, const HeightField& field, const TiltedView& view);

}  // namespace spillway::picture
