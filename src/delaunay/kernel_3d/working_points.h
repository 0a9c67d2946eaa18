#pragma once
// The points as the 3D kernel computes with them.

#include <array>
#include <optional>
#include <span>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/delaunay/kernel_common/scaled_points.h"
#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_3d {

using kernel::kFirstPoint;

/// One base case's points, by the kernel's vertex numbers.
struct WorkingPoints : kernel::ScaledPoints<3> {
  /// What there is for each vertex.
  using Row = std::array<double, 4>;

  /// Four numbers for each vertex: the coordinates that CoordinateScaling makes, and an order key.
  /// NaN for the infinite vertex, so that every comparison with it decides nothing.
  const double* coordinates = nullptr;
  /// Whether the order keys are in lexicographic order. They are integers below 2^53, on a lattice
  /// whose box has fewer places, and sides up to 2^40; else they are all 0.
  bool has_order_keys = false;
  /// Whether it is a lattice whose box has sides below 10^5: then a determinant of three
  /// differences has no intermediate result above 6 * 10^15 < 2^53, and doubles compute it exactly.
  bool tiny = false;
  /// A power of two, at least the distance between any two of the scaled points.
  double extent = 0;
  std::size_t count = 0;  ///< of vertices, the infinite one included

  [[nodiscard]] const double* at(VertexRef v) const { return coordinates + v; }
  [[nodiscard]] const Point<3>& original(VertexRef v) const {
    return originals[v / 4 - kFirstPoint];
  }
};

inline constexpr VertexRef ref(VertexId number) { return 4 * number; }

/// Scales points that are not all coplanar, and BaseCaseInput::safe_box with them.
WorkingPoints make_working_points(std::span<const Point<3>> points, Slab& memory,
                                  const std::optional<Box<3>>& safe_box = std::nullopt);

}  // namespace spillway::delaunay::kernel_3d
