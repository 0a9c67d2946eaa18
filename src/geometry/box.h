#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "src/geometry/point.h"

namespace spillway::geometry {

/// A closed axis-parallel box. Default-constructed it is empty (lo > hi on every axis).
template <int D>
requires Dimension<D>
struct Box {
  Point<D> lo = filled(std::numeric_limits<double>::infinity());
  Point<D> hi = filled(-std::numeric_limits<double>::infinity());

  bool operator==(const Box&) const = default;

  [[nodiscard]] bool empty() const { return lo[0] > hi[0]; }

  void expand(const Point<D>& p) {
    for (int k = 0; k < D; ++k) {
      lo[k] = std::min(lo[k], p[k]);
      hi[k] = std::max(hi[k], p[k]);
    }
  }

  void expand(const Box& other) {
    for (int k = 0; k < D; ++k) {
      lo[k] = std::min(lo[k], other.lo[k]);
      hi[k] = std::max(hi[k], other.hi[k]);
    }
  }

  [[nodiscard]] bool contains(const Point<D>& p) const {
    for (int k = 0; k < D; ++k) {
      if (p[k] < lo[k] || p[k] > hi[k]) return false;
    }
    return true;
  }

  /// Length along one axis, rounded to the nearest double; 0 for an empty box.
  [[nodiscard]] double extent(int axis) const { return empty() ? 0.0 : hi[axis] - lo[axis]; }

  /// The axis of the largest extent, the lowest one among equals.
  [[nodiscard]] int longest_axis() const {
    int axis = 0;
    for (int k = 1; k < D; ++k) {
      if (extent(k) > extent(axis)) axis = k;
    }
    return axis;
  }

 private:
  static constexpr Point<D> filled(double value) {
    Point<D> p{};
    p.fill(value);
    return p;
  }
};

template <int D>
Box<D> whole_space() {
  Box<D> box;
  std::swap(box.lo, box.hi);
  return box;
}

/// What two boxes have in common; the empty box if that is nothing.
template <int D>
Box<D> common_part(const Box<D>& a, const Box<D>& b) {
  Box<D> part;
  for (int k = 0; k < D; ++k) {
    part.lo[k] = std::max(a.lo[k], b.lo[k]);
    part.hi[k] = std::min(a.hi[k], b.hi[k]);
    if (part.lo[k] > part.hi[k]) return {};
  }
  return part;
}

/// Cuts `cell` back so that it has nothing in common with `other`, which lies apart from `box` on
/// some axis, as the boxes of a division do.
template <int D>
void cut_back(Box<D>& cell, const Box<D>& box, const Box<D>& other) {
  for (int k = 0; k < D; ++k) {
    if (other.lo[k] > box.hi[k]) {
      cell.hi[k] = std::min(cell.hi[k], other.lo[k]);
      return;
    }
    if (other.hi[k] < box.lo[k]) {
      cell.lo[k] = std::max(cell.lo[k], other.hi[k]);
      return;
    }
  }
}

/// The x and y of a box.
template <int D>
Box<2> plane_of(const Box<D>& box) {
  return {{box.lo[0], box.lo[1]}, {box.hi[0], box.hi[1]}};
}

}  // namespace spillway::geometry
