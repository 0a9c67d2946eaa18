#pragma once
// What the own kernels know of a base case's points, and how they make it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/coordinate_scaling.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel {

/// What is known of points whose coordinates a CoordinateScaling has made.
template <int D>
struct ScaledPoints {
  const Point<D>* originals = nullptr;  ///< those the caller gave, from kFirstPoint on
  bool lattice = false;
  double largest = 0;                ///< magnitude of a scaled coordinate
  std::optional<Box<D>> safe_box{};  ///< BaseCaseInput::safe_box, scaled
};

/// Fills the memory with a row of numbers for each vertex: make_row(p) of a scaled point, and NaN
/// for the infinite vertex, so that every comparison with it decides nothing.
template <typename Row, int D, typename MakeRow>
const Row* scale_points(const CoordinateScaling<D>& scaling, std::span<const Point<D>> points,
                        const std::optional<Box<D>>& safe_box, Slab& memory, ScaledPoints<D>& known,
                        const MakeRow& make_row) {
  auto* const rows = static_cast<Row*>(memory.reserve((points.size() + kFirstPoint) * sizeof(Row)));
  rows[kInfinite].fill(std::numeric_limits<double>::quiet_NaN());
  known.originals = points.data();
  known.lattice = scaling.lattice();
  if (safe_box) known.safe_box = scaling.inner_box(*safe_box);
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<D> p = scaling(points[i]);
    rows[i + kFirstPoint] = make_row(p);
    for (const double c : p) largest = std::max(largest, std::abs(c));
  }
  known.largest = largest;
  return rows;
}

}  // namespace spillway::delaunay::kernel
