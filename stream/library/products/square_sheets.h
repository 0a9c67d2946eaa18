#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::stream {

/// A raster's files, one for each square of a side, whose edges lie on multiples of the side. Those
/// at the raster's edges have what it has of their squares.
class SquareSheets {
 public:
  /// The name of the file `pattern` holds "{x}" and "{y}". Throws InvalidArgument if it does not.
  SquareSheets(std::string pattern, double side);

  /// Where they lie, row by row from the north-west. Throws InvalidArgument unless edges of pixels
  /// are multiples of their side, and that of the squares is one of it.
  [[nodiscard]] std::vector<PixelWindow> windows(const PixelGrid& raster) const;

  /// The path of the file of a window: "{x}" and "{y}" become the south-western corner of its square.
  [[nodiscard]] std::string path(const PixelGrid& raster, const PixelWindow& window) const;

  /// The path of the VRT that puts them together: that of the pattern, without x and y.
  [[nodiscard]] std::string vrt_path() const;

  /// The files in the folder whose names could be those of other squares, sorted.
  [[nodiscard]] std::vector<std::string> others_than(std::vector<std::string> paths) const;

 private:
  struct Steps;
  [[nodiscard]] Steps steps_of(const PixelGrid& raster) const;

  std::string pattern_;
  double side_;
};

}  // namespace spillway::stream
