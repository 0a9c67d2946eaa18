#include "src/terrain/pixel_centres.h"

#include <cmath>

#include "src/error.h"

namespace spillway::terrain {
namespace {

/// How far, in steps of the lattice, rounding takes a coordinate of some millions of steps.
constexpr double kRoundingSteps = 1e-6;

double on_lattice(const IntegerLattice& lattice, int axis, double world) {
  const double steps = (world - lattice.offset[axis]) / lattice.scale[axis];
  const double whole = std::nearbyint(steps);
  return std::abs(steps - whole) <= kRoundingSteps ? whole : steps;
}

}  // namespace

PixelCentres::PixelCentres(const PixelGrid& grid, const std::optional<IntegerLattice>& lattice,
                           std::uint32_t margin)
    : x_(std::size_t{grid.columns} + 2 * margin),
      y_(std::size_t{grid.rows} + 2 * margin),
      per_x_((lattice ? lattice->scale[0] : 1) / grid.resolution),
      per_y_((lattice ? lattice->scale[1] : 1) / grid.resolution) {
  for (std::size_t c = 0; c < x_.size(); ++c) {
    const double x = grid.centre_x(static_cast<double>(c) - margin);
    x_[c] = lattice ? on_lattice(*lattice, 0, x) : x;
    if (c > 0 && !(x_[c] > x_[c - 1])) {
      throw InvalidArgument(
          "the resolution is too fine for coordinates so large; give a coarser one");
    }
  }
  for (std::size_t r = 0; r < y_.size(); ++r) {
    const double y = grid.centre_y(static_cast<double>(r) - margin);
    y_[r] = lattice ? on_lattice(*lattice, 1, y) : y;
    if (r > 0 && !(y_[r] < y_[r - 1])) {
      throw InvalidArgument(
          "the resolution is too fine for coordinates so large; give a coarser one");
    }
  }
}

}  // namespace spillway::terrain
