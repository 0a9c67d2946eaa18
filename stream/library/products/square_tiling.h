#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "stream/library/products/raster_tiling.h"

namespace spillway::stream {

/// One file for each square of a side, whose edges lie on multiples of the side. Those at the
/// raster's edges have what it has of their squares.
class SquareTiling final : public RasterTiling {
 public:
  /// The name of the file `pattern` holds "{x}" and "{y}", which become the south-western corner of a
  /// square. Throws InvalidArgument if it does not.
  SquareTiling(std::string pattern, double side);

  /// Row by row from the north-west. Throws InvalidArgument unless edges of pixels are multiples of
  /// their side, and that of the squares is one of it.
  [[nodiscard]] std::vector<RasterTile> tiles(const PixelGrid& raster) const override;
  [[nodiscard]] std::vector<std::string> others_than(std::vector<std::string> paths) const override;

 private:
  struct Steps;
  [[nodiscard]] Steps steps_of(const PixelGrid& raster) const;
  [[nodiscard]] std::string path_of(std::int64_t column, std::int64_t row) const;

  std::string pattern_;
  double side_;
};

}  // namespace spillway::stream
