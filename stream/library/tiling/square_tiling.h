#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "stream/library/tiling/raster_tiling.h"
#include "stream/library/tiling/square_names.h"

namespace spillway::stream {

/// One file for each square of a side, whose edges lie on multiples of the side. Those at the
/// raster's edges have what it has of their squares.
class SquareTiling final : public RasterTiling {
 public:
  /// As SquareNames.
  SquareTiling(std::string pattern, double side) : names_(std::move(pattern), side) {}

  /// Row by row from the north-west. Throws InvalidArgument unless edges of pixels are multiples of
  /// their side, and that of the squares is one of it.
  [[nodiscard]] std::vector<RasterTile> tiles(const PixelGrid& raster) const override;
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> paths) const override {
    return names_.others_than(std::move(paths));
  }

 private:
  struct Steps;
  [[nodiscard]] Steps steps_of(const PixelGrid& raster) const;

  SquareNames names_;
};

}  // namespace spillway::stream
