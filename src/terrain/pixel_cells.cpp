#include "src/terrain/pixel_cells.h"

#include <algorithm>

#include "src/terrain/lattice_steps.h"

namespace spillway::terrain {

PixelCells::PixelCells(const PixelGrid& grid, const std::optional<IntegerLattice>& lattice)
    : grid_(grid), lattice_(lattice) {
  columns_ = {.first = west_of(0),
              .last = west_of(grid.columns),
              .per_unit = (lattice ? lattice->scale[0] : 1) / grid.resolution,
              .count = grid.columns};
  rows_ = {.first = north_of(0),
           .last = north_of(grid.rows),
           .per_unit = (lattice ? lattice->scale[1] : 1) / grid.resolution,
           .count = grid.rows};
}

double PixelCells::west_of(std::uint32_t column) const {
  const double x = grid_.west + column * grid_.resolution;
  return lattice_ ? lattice_steps(*lattice_, 0, x) : x;
}

double PixelCells::north_of(std::uint32_t row) const {
  const double y = grid_.north - row * grid_.resolution;
  return lattice_ ? lattice_steps(*lattice_, 1, y) : y;
}

std::uint32_t PixelCells::estimate(const Axis& axis, double distance) {
  const double pixels = distance * axis.per_unit;
  return pixels < axis.count ? static_cast<std::uint32_t>(pixels) : axis.count - 1;
}

std::optional<std::uint32_t> PixelCells::column(double x) const {
  if (!(x >= columns_.first && x <= columns_.last)) return std::nullopt;
  std::uint32_t c = estimate(columns_, x - columns_.first);
  while (c > 0 && x < west_of(c)) --c;
  while (c + 1 < columns_.count && x >= west_of(c + 1)) ++c;
  return c;
}

std::optional<std::uint32_t> PixelCells::row(double y) const {
  if (!(y <= rows_.first && y >= rows_.last)) return std::nullopt;
  std::uint32_t r = estimate(rows_, rows_.first - y);
  while (r > 0 && y > north_of(r)) --r;
  while (r + 1 < rows_.count && y <= north_of(r + 1)) ++r;
  return r;
}

}  // namespace spillway::terrain
