#pragma once

#include <cstdint>
#include <optional>

#include "src/geometry/lattice.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::terrain {

/// Which pixel's square a point lies in. A square holds its western and northern edges; the
/// raster's eastern and southern edges belong to its last column and row. Points are compared with
/// edges as they are computed, so that no rounding of a quotient moves a point: column c reaches
/// from west + c * resolution to west + (c + 1) * resolution. On a lattice edges are mapped onto
/// it, and an edge that is an integer but for rounding becomes that integer.
class PixelCells {
 public:
  /// The lattice's scales must be positive.
  PixelCells(const PixelGrid& grid, const std::optional<IntegerLattice>& lattice);

  /// Of coordinates on the lattice, if there is one; nothing outside of the raster.
  [[nodiscard]] std::optional<std::uint32_t> column(double x) const;
  [[nodiscard]] std::optional<std::uint32_t> row(double y) const;

 private:
  /// The columns from the west, or the rows from the north.
  struct Axis {
    double first = 0;  ///< edge
    double last = 0;   ///< edge
    double per_unit = 1;
    std::uint32_t count = 0;
  };
  [[nodiscard]] double west_of(std::uint32_t column) const;
  [[nodiscard]] double north_of(std::uint32_t row) const;
  /// A guess, off by a few at most.
  static std::uint32_t estimate(const Axis& axis, double distance);

  PixelGrid grid_;
  std::optional<IntegerLattice> lattice_;
  Axis columns_;
  Axis rows_;
};

}  // namespace spillway::terrain
