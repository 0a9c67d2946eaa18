#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "src/geometry/box.h"
#include "src/geometry/determinants.h"
#include "src/geometry/point.h"

namespace spillway::test {

using Rational = boost::multiprecision::cpp_rational;

// The circumsphere in exact rational arithmetic.
template <int D>
struct ExactSphere {
  std::array<Rational, D> centre;
  Rational squared_radius = 0;

  // By Cramer's rule on 2 (p_i - p_0) . c = |p_i - p_0|^2.
  explicit ExactSphere(const std::array<Point<D>, D + 1>& simplex) {
    Vectors<D, D, Rational> rows;
    for (int i = 0; i < D; ++i) {
      for (int k = 0; k < D; ++k)
        rows[i][k] = Rational(simplex[i + 1][k]) - Rational(simplex[0][k]);
    }
    const Rational determinant = orientation_determinant<D>(rows);
    for (int k = 0; k < D; ++k) {
      Vectors<D, D, Rational> replaced = rows;
      for (int i = 0; i < D; ++i) replaced[i][k] = squared_length(rows[i]) / 2;
      const Rational relative = orientation_determinant<D>(replaced) / determinant;
      squared_radius += relative * relative;
      centre[k] = relative + Rational(simplex[0][k]);
    }
  }

  [[nodiscard]] bool meets(const Box<D>& box) const {
    Rational squared_distance = 0;
    for (int k = 0; k < D; ++k) {
      Rational gap = 0;
      if (centre[k] < Rational(box.lo[k])) gap = Rational(box.lo[k]) - centre[k];
      if (centre[k] > Rational(box.hi[k])) gap = centre[k] - Rational(box.hi[k]);
      squared_distance += gap * gap;
    }
    return squared_distance <= squared_radius;
  }

  // Whether it lies in the box and touches none of its sides, which may be infinite.
  [[nodiscard]] bool inside(const Box<D>& box) const {
    for (int k = 0; k < D; ++k) {
      for (const double side : {box.lo[k], box.hi[k]}) {
        if (std::isinf(side)) continue;
        const Rational gap =
            side == box.lo[k] ? centre[k] - Rational(side) : Rational(side) - centre[k];
        if (gap <= 0 || gap * gap <= squared_radius) return false;
      }
    }
    return true;
  }
};

}  // namespace spillway::test
