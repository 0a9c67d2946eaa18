#pragma once

#include <cstdint>

#include "src/rooms.h"

namespace spillway::geometry {

/// Square pixels, north up: column 0 is the westernmost, row 0 the northernmost.
struct PixelGrid {
  double west = 0;        ///< x of the left edge of column 0
  double north = 0;       ///< y of the upper edge of row 0
  double resolution = 1;  ///< side of a pixel
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;

  bool operator==(const PixelGrid&) const = default;

  /// The centre of a pixel, evaluated in double in exactly this way. Columns and rows are whole
  /// numbers, and may lie beyond the grid.
  [[nodiscard]] double centre_x(double column) const { return west + (column + 0.5) * resolution; }
  [[nodiscard]] double centre_y(double row) const { return north - (row + 0.5) * resolution; }
};

}  // namespace spillway::geometry
