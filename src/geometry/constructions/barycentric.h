#pragma once

#include <array>

#include "src/geometry/determinants.h"
#include "src/geometry/point.h"

namespace spillway::geometry {

/// The barycentric coordinates of a place in a positively oriented simplex, or on its boundary:
/// from 0 to 1 each, their sum 1 but for rounding. Each is within 2^-36 of the true one, and
/// exactly 0 where that is. Exact integers are used where the simplex is too flat for doubles.
template <int D>
std::array<double, D + 1> barycentric_coordinates(const std::array<Point<D>, D + 1>& simplex,
                                                  const Point<D>& place);

/// The same from exact integers, rounded to the nearest double.
template <int D>
std::array<double, D + 1> exact_barycentric_coordinates(const std::array<Point<D>, D + 1>& simplex,
                                                        const Point<D>& place);

/// The determinants whose shares of their sum the coordinates are, from the vertices relative to
/// the place: (-1)^i times the orientation without vertex i.
template <int D, typename T>
std::array<T, D + 1> barycentric_determinants(const Vectors<D, D + 1, T>& v) {
  std::array<T, D + 1> weights;
  for (int i = 0; i <= D; ++i) {
    Vectors<D, D, T> others;
    for (int j = 0, n = 0; j <= D; ++j) {
      if (j != i) others[n++] = v[j];
    }
    const T d = orientation_determinant<D>(others);
    weights[i] = i % 2 == 0 ? d : T(-d);
  }
  return weights;
}

}  // namespace spillway::geometry
