#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// The sides of a box beyond which other boxes lie.
template <int D>
class FacingSides {
 public:
  explicit FacingSides(const Box<D>& box) : box_(box) {}

  /// Adds the side that another box lies beyond. False if it lies beyond none: they overlap.
  [[nodiscard]] bool add(const Box<D>& other) {
    for (int k = 0; k < D; ++k) {
      if (other.lo[k] > box_.hi[k]) return above_[k] = true;
      if (other.hi[k] < box_.lo[k]) return below_[k] = true;
    }
    return false;
  }

  /// Whether a corner of a simplex lies on one of them. Corners are numbers of `points`, or
  /// kInfiniteVertex.
  [[nodiscard]] bool have_corner(const std::array<VertexId, D + 1>& corners,
                                 std::span<const Point<D>> points) const {
    return std::ranges::any_of(corners,
                               [&](VertexId v) { return v != kInfiniteVertex && have(points[v]); });
  }

 private:
  [[nodiscard]] bool have(const Point<D>& point) const {
    bool on = false;
    for (int k = 0; k < D; ++k) {
      on |= (below_[k] && point[k] == box_.lo[k]) || (above_[k] && point[k] == box_.hi[k]);
    }
    return on;
  }

  Box<D> box_;
  std::array<bool, D> below_{};
  std::array<bool, D> above_{};
};

}  // namespace spillway::delaunay
