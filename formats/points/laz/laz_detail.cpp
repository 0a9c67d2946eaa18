#include "formats/points/laz/laz_detail.h"

#include "formats/points/laz/coding/point14_layers.h"

namespace spillway::formats {

std::size_t laz_wanted_layers(const LazChunkFormat& format, LazDetail detail) {
  if (!format.layered) return 0;
  switch (detail) {
    case LazDetail::kCoordinates:
      return laz::Point14Layers::kCoordinateLayers;
    case LazDetail::kFlags:
      return laz::Point14Layers::kLayers;
    case LazDetail::kRecords:
      break;
  }
  return laz_layers(format);
}

}  // namespace spillway::formats
