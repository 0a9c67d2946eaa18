#pragma once
// The coordinates the 2D kernel computes with. A power of two scales them, so that nothing
// overflows; points of a lattice become integers counted from the corner of their box.

#include <optional>
#include <span>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/scaled_points.h"
#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_2d {

using kernel::kFirstPoint;
using kernel::kInfinite;

/// One base case's points, by the kernel's vertex numbers.
struct WorkingPoints : kernel::ScaledPoints<2> {
  /// What there is for each vertex.
  using Row = Point<2>;

  /// NaN for the infinite vertex, so that every comparison with it decides nothing. If `lattice`,
  /// integers of less than 2^53: the points minus a lattice point, over the lattice's unit. If not,
  /// the points times a power of two that brings the longer side of their box into [1, 2), each
  /// rounded by at most 2^-1075.
  const Point<2>* scaled = nullptr;

  [[nodiscard]] const Point<2>& original(VertexId v) const { return originals[v - kFirstPoint]; }
};

/// Scales points that are not all collinear. A lattice is any set of points that all are integers
/// below 2^53 times one power of two: LiDAR's integers as well as quarters of a metre. Scales
/// BaseCaseInput::safe_box with them.
WorkingPoints make_working_points(std::span<const Point<2>> points, Slab& memory,
                                  const std::optional<Box<2>>& safe_box = std::nullopt);

}  // namespace spillway::delaunay::kernel_2d
