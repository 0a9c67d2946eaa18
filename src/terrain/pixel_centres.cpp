#include "src/terrain/pixel_centres.h"

#include "src/error.h"
#include "src/terrain/lattice_steps.h"

namespace spillway::terrain {
PixelCentres::PixelCentres(const PixelGrid& grid, const std::optional<IntegerLattice>& lattice,
                           std::uint32_t margin)
    : x_(std::size_t{grid.columns} + 2 * margin),
      y_(std::size_t{grid.rows} + 2 * margin),
      per_x_((lattice ? lattice->scale[0] : 1) / grid.resolution),
      per_y_((lattice ? lattice->scale[1] : 1) / grid.resolution) {
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double x = grid.centre_x(static_cast<double>(c) - margin);
    x_[c] = lattice ? lattice_steps(*lattice, 0, x) : x;
    if (c > 0 && !(x_[c] > x_[c - 1])) {
      throw InvalidArgument(
          "the resolution is too fine for coordinates so large; give a coarser one");
    }
  }
  for (std::size_t r = 0; r < y_.size(); ++r) {
    const double y = grid.centre_y(static_cast<double>(r) - margin);
    y_[r] = lattice ? lattice_steps(*lattice, 1, y) : y;
    if (r > 0 && !(y_[r] < y_[r - 1])) {
      throw InvalidArgument(
          "the resolution is too fine for coordinates so large; give a coarser one");
    }
  }
}

}  // namespace spillway::terrain
