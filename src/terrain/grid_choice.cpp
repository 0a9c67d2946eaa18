#include "src/terrain/grid_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "src/error.h"

namespace spillway::terrain {
namespace {

/// GDAL counts rows and columns in int.
constexpr double kMostPixels = std::numeric_limits<std::int32_t>::max();

/// A box that is a whole number of pixels but for rounding gets just that number.
constexpr double kRoundingShare = 1e-9;

/// Pixels of side `resolution` that cover a length.
double pixels_for(double length, double resolution) {
  const double pixels = length / resolution;
  const double whole = std::round(pixels);
  const bool is_whole = std::abs(pixels - whole) <= kRoundingShare * std::max(1.0, whole);
  return std::max(1.0, is_whole ? whole : std::ceil(pixels));
}

}  // namespace

PixelGrid choose_grid(const GridRequest& request, const Box<2>& extent) {
  if (request.given) return *request.given;
  const double resolution = request.resolution;
  Box<2> box = request.bounds.value_or(extent);
  if (request.align) {
    for (int k = 0; k < 2; ++k) {
      box.lo[k] = std::floor(box.lo[k] / resolution) * resolution;
      box.hi[k] = std::ceil(box.hi[k] / resolution) * resolution;
    }
  }
  const double columns = pixels_for(box.hi[0] - box.lo[0], resolution);
  const double rows = pixels_for(box.hi[1] - box.lo[1], resolution);
  if (!(columns <= kMostPixels && rows <= kMostPixels)) {
    const auto count = [](double pixels) {
      return pixels < 1e15 ? fmt::format("{:.0f}", pixels) : fmt::format("{:.3g}", pixels);
    };
    throw InvalidArgument("a raster of " + count(columns) + " x " + count(rows) +
                              " pixels is more than GeoTIFF can hold (2147483647 each way)",
                          {.remedy = Remedy::kRasterSize});
  }
  return {box.lo[0], box.hi[1], resolution, static_cast<std::uint32_t>(columns),
          static_cast<std::uint32_t>(rows)};
}

}  // namespace spillway::terrain
