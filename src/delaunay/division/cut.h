#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "src/geometry/box.h"

namespace spillway::delaunay {

/// A cut in two: below `value` on `axis`, and not below.
struct Cut {
  int axis = 0;
  double value = 0;
};

/// How much is to lie below a cut: so many parts of so many.
struct CutShare {
  std::size_t below = 1;
  std::size_t all = 2;

  [[nodiscard]] std::size_t of(std::size_t count) const { return count * below / all; }
};

/// The share of the points of `box` that lies below a cut, if they lie evenly. It may be 1 where a
/// few lie on the cut or above.
template <int D>
double share_below(const Box<D>& box, const Cut& cut) {
  const double lo = box.lo[cut.axis];
  const double hi = box.hi[cut.axis];
  if (cut.value <= lo) return 0;
  return cut.value > hi ? 1 : (cut.value - lo) / (hi - lo);
}

/// The part of a box on one side of a cut, 0 for below; empty if it lies on the other.
template <int D>
Box<D> part_of(const Box<D>& box, const Cut& cut, int side) {
  Box<D> part = box;
  if (side == 0) {
    const double below = std::nextafter(cut.value, -std::numeric_limits<double>::infinity());
    part.hi[cut.axis] = std::min(part.hi[cut.axis], below);
  } else {
    part.lo[cut.axis] = std::max(part.lo[cut.axis], cut.value);
  }
  return part.lo[cut.axis] <= part.hi[cut.axis] ? part : Box<D>{};
}

/// On which side of a cut all points of `box` lie: 0 is below. Nothing if that may be both; the box
/// is tight.
template <int D>
std::optional<int> side_of(const Box<D>& box, const Cut& cut) {
  if (box.hi[cut.axis] < cut.value) return 0;
  if (box.lo[cut.axis] >= cut.value) return 1;
  return std::nullopt;
}

}  // namespace spillway::delaunay
