#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/geometry/lattice.h"
#include "src/geometry/pixel_grid.h"

namespace spillway::terrain {

/// The centres of a raster's pixels in the coordinates of the triangles. Where these are integers
/// of a lattice, the centres are mapped there and not the triangles to the world: a triangulation
/// whose vertices are rounded may have triangles that overlap by a rounding error. A centre that is
/// an integer but for rounding becomes that integer.
class PixelCentres {
 public:
  /// Throws InvalidArgument if the resolution is too fine for doubles to tell neighbours apart. The
  /// lattice's scales must be positive. With a margin so many rows and columns beyond each edge of
  /// the grid count as well, so that its own begin with that number.
  PixelCentres(const PixelGrid& grid, const std::optional<IntegerLattice>& lattice,
               std::uint32_t margin = 0);

  [[nodiscard]] std::span<const double> x() const { return x_; }  ///< by column, ascending
  [[nodiscard]] std::span<const double> y() const { return y_; }  ///< by row, descending

  /// The first column whose centre is not west of `x`; the number of columns if there is none.
  [[nodiscard]] std::uint32_t first_column(double x) const {
    std::uint32_t c = estimate((x - x_[0]) * per_x_, x_.size());
    while (c > 0 && x_[c - 1] >= x) --c;
    while (c < x_.size() && x_[c] < x) ++c;
    return c;
  }

  /// The first row whose centre is not north of `y`; the number of rows if there is none.
  [[nodiscard]] std::uint32_t first_row(double y) const {
    std::uint32_t r = estimate((y_[0] - y) * per_y_, y_.size());
    while (r > 0 && y_[r - 1] <= y) --r;
    while (r < y_.size() && y_[r] > y) ++r;
    return r;
  }

  /// Bytes that the centres of such a grid take.
  static std::uint64_t bytes(const PixelGrid& grid) {
    return (std::uint64_t{grid.columns} + grid.rows) * sizeof(double);
  }

 private:
  static std::uint32_t estimate(double position, std::size_t count) {
    if (!(position > 0)) return 0;
    return position < static_cast<double>(count) ? static_cast<std::uint32_t>(position)
                                                 : static_cast<std::uint32_t>(count);
  }

  std::vector<double> x_;
  std::vector<double> y_;
  double per_x_;  ///< columns in a unit of x
  double per_y_;
};

}  // namespace spillway::terrain
