#include "formats/points/open_las.h"

#include <fmt/format.h>

#include <utility>

#include "formats/points/las/las_variant.h"
#include "src/error.h"

namespace spillway::formats {

std::unique_ptr<PointReader> open_las(PointInput input, const PointReaderOptions& options,
                                      PointFormats formats) {
  const LasHeader las =
      read_las_header(*input.source, {.salvage = options.salvage, .metadata = options.metadata});
  for (const PointFormat* const format : formats) {
    const LasVariant* const variant = format->las_variant;
    if (variant == nullptr || !variant->is_told(las)) continue;
    return variant->open(std::move(input.source), las, input.path, options);
  }
  throw BadInput(input.path, "no format is known that has such a header", at_byte(0));
}

}  // namespace spillway::formats
