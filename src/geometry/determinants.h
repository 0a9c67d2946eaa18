#pragma once
// The polynomials behind the predicates and the certified balls, written once for every number
// type: double (rounded), 128-bit integers and big integers (exact).

#include <array>
#include <bit>
#include <cstddef>
#include <utility>

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

/// The columns of a set, a bit each, the last one first.
template <unsigned kSet>
inline constexpr auto kColumnsFromLast = [] {
  std::array<std::size_t, std::popcount(kSet)> columns{};
  std::size_t place = 0;
  for (std::size_t c = 32; c-- > 0;) {
    if ((kSet >> c & 1U) != 0) columns[place++] = c;
  }
  return columns;
}();

/// Expands the minor of one set along its last row, from the smaller minors.
template <unsigned kSet, bool kSigned, typename T, std::size_t Columns, std::size_t Rows>
[[gnu::always_inline]] inline void expand_minor(
    const std::array<std::array<T, Columns>, Rows>& rows,
    std::array<T, std::size_t{1} << Columns>& minors) {
  constexpr auto& kColumns = kColumnsFromLast<kSet>;
  if constexpr (kColumns.size() >= 2 && kColumns.size() <= Rows) {
    // The last column comes first: its sign is that of the diagonal.
    T sum = rows[kColumns.size() - 1][kColumns[0]] * minors[kSet ^ 1U << kColumns[0]];
    const auto add = [&](std::size_t place) __attribute__((always_inline)) {
      const std::size_t c = kColumns[place];
      const T term = rows[kColumns.size() - 1][c] * minors[kSet ^ 1U << c];
      if (kSigned && place % 2 != 0) {
        sum -= term;
      } else {
        sum += term;
      }
    };
    [&]<std::size_t... kPlace>(std::index_sequence<kPlace...>) __attribute__((always_inline)) {
      (add(kPlace + 1), ...);
    }
    (std::make_index_sequence<kColumns.size() - 1>{});
    minors[kSet] = sum;
  }
}

/// For each set of columns, a bit each: the determinant of these columns of as many first rows, or,
/// if not `kSigned`, the sum of the absolute values of its monomials, of numbers that are none
/// below 0. Sets of more columns than there are rows have none. Laplace's expansion along the last
/// row, in which no minor is computed twice.
template <bool kSigned = true, typename T, std::size_t Columns, std::size_t Rows>
[[gnu::always_inline]] inline std::array<T, std::size_t{1} << Columns> minors(
    const std::array<std::array<T, Columns>, Rows>& rows) {
  std::array<T, std::size_t{1} << Columns> minors;
  for (std::size_t c = 0; c < Columns; ++c) minors[std::size_t{1} << c] = rows[0][c];
  [&]<unsigned... kSet>(std::integer_sequence<unsigned, kSet...>) __attribute__((always_inline)) {
    (expand_minor<kSet, kSigned>(rows, minors), ...);
  }
  (std::make_integer_sequence<unsigned, (1U << Columns)>{});
  return minors;
}

/// det[v0, ..., v(D-1)]: positive if the simplex of the origin and v0, v1, ... is positively
/// oriented. D! monomials.
template <int D, typename T>
T orientation_determinant(const Vectors<D, D, T>& v) {
  if constexpr (D == 2) {
    return minor_xy(v[0], v[1]);
  } else if constexpr (D > 3) {
    return minors(v).back();
  } else {
    return v[0][2] * minor_xy(v[1], v[2]) - v[1][2] * minor_xy(v[0], v[2]) +
           v[2][2] * minor_xy(v[0], v[1]);
  }
}

/// The squared length of v.
template <typename T, std::size_t D>
T squared_length(const std::array<T, D>& v) {
  T sum = v[0] * v[0] + v[1] * v[1];
  for (std::size_t k = 2; k < D; ++k) sum += v[k] * v[k];
  return sum;
}

/// The in-circle (in-sphere) determinant of a simplex whose vertices are given relative to the
/// query: the sum over i of |v_i|^2 times the orientation of the simplex with v_i replaced by the
/// origin. D (D+1)! monomials.
template <int D, typename T>
T in_sphere_determinant(const Vectors<D, D + 1, T>& v) {
  if constexpr (D == 2) {
    return squared_length(v[0]) * minor_xy(v[1], v[2]) -
           squared_length(v[1]) * minor_xy(v[0], v[2]) +
           squared_length(v[2]) * minor_xy(v[0], v[1]);
  } else if constexpr (D > 3) {
    Vectors<D + 1, D, T> by_axis;
    for (int k = 0; k < D; ++k) {
      for (int i = 0; i <= D; ++i) by_axis[k][i] = v[i][k];
    }
    const auto without = minors(by_axis);
    constexpr unsigned kAll = (1U << (D + 1)) - 1;
    T sum = squared_length(v[0]) * without[kAll ^ 1U];
    for (int i = 1; i <= D; ++i) {
      const T term = squared_length(v[i]) * without[kAll ^ 1U << i];
      if (i % 2 == 0) {
        sum += term;
      } else {
        sum -= term;
      }
    }
    return sum;
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
