#pragma once
// Simplices of a periodic triangulation: which of all copies of one stands for it.

#include <algorithm>
#include <array>

#include "src/geometry/point.h"
#include "src/geometry/torus.h"

namespace spillway::geometry {

/// The corners of a simplex in the order of their coordinates (x, then y, then z), which is the same
/// for all copies of it.
template <int D>
struct SortedCorners {
  std::array<int, D + 1> order;  ///< places of the corners, sorted

  explicit SortedCorners(const std::array<Point<D>, D + 1>& corners) {
    for (int i = 0; i <= D; ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](int a, int b) { return corners[a] < corners[b]; });
  }
};

/// Where a copy of a simplex lies. Of all copies of one, exactly one has its centre in the box.
template <int D>
struct SimplexPlace {
  Periods<D> periods;  ///< in which copy of the box its centre lies
  Point<D> centre;     ///< of its circumsphere, within 2^-30 of a period along periodic axes
  double radius;       ///< not below the true one

  [[nodiscard]] bool stands_for_all() const { return periods == Periods<D>{}; }
};

/// All copies agree on the periods between them, however their corners are listed.
template <int D>
SimplexPlace<D> place_simplex(const Torus& torus, const std::array<Point<D>, D + 1>& corners);

/// Whether the line or plane of a facet is along all periodic axes: of the hull of some copies, only
/// such facets are those of the hull of all copies.
template <int D>
bool is_along_periods(const Torus& torus, const std::array<Point<D>, D>& facet);

/// Whether a facet of the hull of some copies is one of the hull of all copies (is_along_periods) and
/// stands for all copies of it: the centre of the smallest sphere through its corners lies in the
/// torus' box.
template <int D>
bool is_chosen_hull_facet(const Torus& torus, const std::array<Point<D>, D>& facet);

/// Throws Failure(kDegenerateInput) if the simplices of a closed torus, which are up to so long along
/// each axis, may be half a period long: those of a triangulation are told apart by their vertices
/// if none is (M. Caroli, M. Teillaud, "Computing 3D Periodic Triangulations", ESA 2009).
void refuse_long_simplices(const Torus& torus, const std::array<double, 3>& reach);

/// How long the box around the corners is along an axis.
template <int D>
double reach(const std::array<Point<D>, D + 1>& corners, int axis) {
  double low = corners[0][axis];
  double high = low;
  for (int i = 1; i <= D; ++i) {
    low = corners[i][axis] < low ? corners[i][axis] : low;
    high = corners[i][axis] > high ? corners[i][axis] : high;
  }
  return high - low;
}

}  // namespace spillway::geometry
