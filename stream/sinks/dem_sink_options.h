#pragma once
// What a raster of a terrain is to be like.

#include <spillway/dem.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "src/terrain/grid_choice.h"
#include "src/terrain/ground_scale.h"
#include "src/terrain/pixel_values.h"
#include "src/terrain/polygon_pixels.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::stream {

/// A sheet of a raster.
struct SheetPlace {
  PixelWindow window;
  std::shared_ptr<const PolygonPixels> outline{};  ///< pixels beside it have no data; null: none
};

struct DemSinkOptions {
  std::vector<DemProduct> products{DemProduct::kHeight};  ///< the bands
  GridRequest grid{};
  Light light{};
  GroundScale ground{};  ///< of products that compare heights with distances
  GradientMethod gradient = GradientMethod::kHorn;
  bool compute_edges = false;         ///< also where neighbours of a pixel have no data
  std::vector<double> percentiles{};  ///< of kPercentile, each time that it is a product
  bool fill_voids = false;            ///< of products of points, by heights of triangles
  std::optional<double> max_edge{};   ///< leave out triangles with a longer edge, in output units
  float nodata = -9999;
  std::uint64_t memory = 0;           ///< for pixels; above it they go to the disk
  std::uint64_t memory_of_files = 0;  ///< of it, what files take that are written early
  unsigned threads = 1;               ///< of which each may have a hand on the pixels
  /// A tile of pixels is closed as soon as each has been painted by the triangle that owns it. For
  /// triangles that do not overlap, all of which are painted here.
  bool closes_tiles = false;
  /// Where the sheets lie that the raster is cut into, once its grid is known. Nothing: one sheet.
  std::function<std::vector<SheetPlace>(const PixelGrid& raster)> sheets{};
  /// Told of a sheet of which no pixel changes any more, to be written while others are painted.
  /// One at a time, by a thread that paints.
  std::function<void(std::size_t sheet)> sheet_is_final{};
  /// Told of every triangle that may be seen, once, corners in output coordinates and in canonical
  /// order; by many threads. Those in whose box no pixel has its centre are passed over.
  std::function<void(const Triangle&)> outline{};
};

}  // namespace spillway::stream
