#include "stream/density/density_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "stream/density/placed_simplices.h"

namespace spillway::stream {
namespace {

/// What a place in a cell that rounding puts outside may lack, of 1.
constexpr double kRounding = 1e-9;

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

DensityGrid::DensityGrid(const MeshStreamHeader& header, const GridShape& shape)
    : header_(header),
      shape_(shape),
      values_(shape.count(), std::numeric_limits<double>::quiet_NaN()) {}

void DensityGrid::write(MeshStreamBlock&& block) {
  const std::size_t own = block.vertices.size();
  std::vector<Corner> vertices(own);
  for (std::size_t v = 0; v < own; ++v) {
    vertices[v].place = in_world(header_.lattice, block.vertices[v]);
    std::memcpy(&vertices[v].density, &block.attributes[v * sizeof(double)], sizeof(double));
  }
  live_.append_imported(block, vertices);
  for_each_simplex(block, header_.dimension, [&](const auto& numbers, const auto& offsets) {
    std::array<Corner, 4> corners;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(header_.dimension); ++i) {
      corners[i] = vertices[numbers[i]];
      corners[i].place = place_of_copy(header_, corners[i].place, offsets[i]);
    }
    paint_copies(corners);
  });
  live_.settle(block, vertices);
}

/// Those that meet the grid.
void DensityGrid::paint_copies(const std::array<Corner, 4>& corners) {
  const std::size_t size = static_cast<std::size_t>(header_.dimension) + 1;
  std::array<double, 3> first{};  // periods
  std::array<double, 3> last{};
  for (int k = 0; k < header_.dimension; ++k) {
    if (!header_.periodic || !header_.periodic->periodic[k]) continue;
    const double period = header_.periodic->period(k);
    const auto along = [k](const Corner& a, const Corner& b) { return a.place[k] < b.place[k]; };
    const auto [low, high] = std::minmax_element(corners.begin(), corners.begin() + size, along);
    first[k] = std::ceil((shape_.box.lo[k] - high->place[k]) / period);
    last[k] = std::floor((shape_.box.hi[k] - low->place[k]) / period);
  }
  std::array<double, 3> periods{};
  for (periods[0] = first[0]; periods[0] <= last[0]; ++periods[0]) {
    for (periods[1] = first[1]; periods[1] <= last[1]; ++periods[1]) {
      for (periods[2] = first[2]; periods[2] <= last[2]; ++periods[2]) {
        std::array<Corner, 4> copy = corners;
        for (std::size_t i = 0; i < size; ++i) {
          for (int k = 0; k < header_.dimension; ++k) {
            if (periods[k] != 0) copy[i].place[k] += periods[k] * header_.periodic->period(k);
          }
        }
        paint(copy);
      }
    }
  }
}

/// The value is that of the first corner and the shares of the edges to the others.
void DensityGrid::paint(const std::array<Corner, 4>& corners) {
  const int dimension = header_.dimension;
  std::array<Vector, 3> edges{};
  Vector low = corners[0].place.numbers();
  Vector high = low;
  for (int i = 1; i <= dimension; ++i) {
    for (int k = 0; k < dimension; ++k) {
      const double x = corners[static_cast<std::size_t>(i)].place[k];
      edges[static_cast<std::size_t>(i) - 1][k] = x - corners[0].place[k];
      low[k] = std::min(low[k], x);
      high[k] = std::max(high[k], x);
    }
  }
  if (dimension == 2) edges[2] = {0, 0, 1};
  // Rows of the inverse of the edges.
  std::array<Vector, 3> inverse = {cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                                   cross(edges[0], edges[1])};
  const double determinant = dot(edges[0], inverse[0]);
  if (determinant == 0) return;
  for (Vector& row : inverse) {
    for (double& x : row) x /= determinant;
  }
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> last{};
  for (int k = 0; k < dimension; ++k) {
    const double step = shape_.step(k);
    const double cells = shape_.cells[static_cast<std::size_t>(k)];
    const double from = std::ceil((low[k] - shape_.box.lo[k]) / step - 0.5);
    const double to = std::floor((high[k] - shape_.box.lo[k]) / step - 0.5);
    if (!(from < cells && to >= 0)) return;
    first[k] = static_cast<std::int64_t>(std::max(from, 0.0));
    last[k] = static_cast<std::int64_t>(std::min(to, cells - 1));
  }
  std::array<std::int64_t, 3> cell{};
  for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
    for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
      for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
        Vector from_first{};
        for (int k = 0; k < dimension; ++k) {
          from_first[k] = shape_.centre(k, cell[k]) - corners[0].place[k];
        }
        double value = corners[0].density;
        double rest = 1;
        bool inside = true;
        for (int i = 0; i < dimension; ++i) {
          const auto n = static_cast<std::size_t>(i);
          const double share = dot(inverse[n], from_first);
          inside &= share >= -kRounding;
          rest -= share;
          value += share * (corners[n + 1].density - corners[0].density);
        }
        if (!inside || rest < -kRounding) continue;
        values_[(static_cast<std::size_t>(cell[0]) * shape_.cells[1] +
                 static_cast<std::size_t>(cell[1])) *
                    shape_.cells[2] +
                static_cast<std::size_t>(cell[2])] = value;
      }
    }
  }
}

}  // namespace spillway::stream
