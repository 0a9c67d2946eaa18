#pragma once

#include <array>
#include <cstddef>

#include "src/rooms.h"

namespace spillway::geometry {

/// Whether two corners of a simplex are further apart than `length`, in their first D coordinates:
/// D = 2 measures the triangles of a terrain in the plane. Squares are compared, as doubles; what
/// leaves out long simplices all asks here, so that all leave out the same ones.
template <int D, std::size_t E, std::size_t N>
[[nodiscard]] bool has_longer_edge(const std::array<std::array<double, E>, N>& corners,
                                   double length) {
  static_assert(D <= E);
  const double most = length * length;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double squared = 0;
      for (std::size_t k = 0; k < D; ++k) {
        const double side = corners[i][k] - corners[j][k];
        squared += side * side;
      }
      if (squared > most) return true;
    }
  }
  return false;
}

}  // namespace spillway::geometry
