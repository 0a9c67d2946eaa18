#pragma once
// The polynomials behind the predicates and the certified balls, written once for every number
// type: double (rounded), 128-bit integers and big integers (exact).

#include <array>

#include "src/geometry/point.h"
#include "src/geometry/strict_arithmetic.h"

namespace spillway::geometry {

/// N vectors of D components each.
template <int D, int N, typename T>
using Vectors = std::array<std::array<T, D>, N>;

/// The 2x2 determinant of the first two components of a and b.
template <typename T, std::size_t D>
T minor_xy(const std::array<T, D>& a, const std::array<T, D>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// det[v0, ..., v(D-1)]: positive if the simplex of the origin and v0, v1, ... is positively
/// oriented. 2 monomials for D = 2, 6 for D = 3.
template <int D, typename T>
T orientation_determinant(const Vectors<D, D, T>& v) {
  if constexpr (D == 2) {
    return minor_xy(v[0], v[1]);
  } else {
    return v[0][2] * minor_xy(v[1], v[2]) - v[1][2] * minor_xy(v[0], v[2]) +
           v[2][2] * minor_xy(v[0], v[1]);
  }
}

/// The squared length of v.
template <typename T, std::size_t D>
T squared_length(const std::array<T, D>& v) {
  T sum = v[0] * v[0] + v[1] * v[1];
  if constexpr (D == 3) sum += v[2] * v[2];
  return sum;
}

/// The in-circle (in-sphere) determinant of a simplex whose vertices are given relative to the
/// query: the sum over i of |v_i|^2 times the orientation of the simplex with v_i replaced by the
/// origin. 12 monomials for D = 2, 72 for D = 3.
template <int D, typename T>
T in_sphere_determinant(const Vectors<D, D + 1, T>& v) {
  if constexpr (D == 2) {
    return squared_length(v[0]) * minor_xy(v[1], v[2]) -
           squared_length(v[1]) * minor_xy(v[0], v[2]) +
           squared_length(v[2]) * minor_xy(v[0], v[1]);
  } else {
    const T m01 = minor_xy(v[0], v[1]);
    const T m02 = minor_xy(v[0], v[2]);
    const T m03 = minor_xy(v[0], v[3]);
    const T m12 = minor_xy(v[1], v[2]);
    const T m13 = minor_xy(v[1], v[3]);
    const T m23 = minor_xy(v[2], v[3]);
    const T without0 = v[1][2] * m23 - v[2][2] * m13 + v[3][2] * m12;
    const T without1 = v[0][2] * m23 - v[2][2] * m03 + v[3][2] * m02;
    const T without2 = v[0][2] * m13 - v[1][2] * m03 + v[3][2] * m01;
    const T without3 = v[0][2] * m12 - v[1][2] * m02 + v[2][2] * m01;
    return squared_length(v[0]) * without0 - squared_length(v[1]) * without1 +
           squared_length(v[2]) * without2 - squared_length(v[3]) * without3;
  }
}

}  // namespace spillway::geometry
