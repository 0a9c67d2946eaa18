#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/kernel_common/coordinate_scaling.h"
#include "src/delaunay/kernel_common/insertion_rounds.h"
#include "src/geometry/box.h"
#include "src/geometry/determinants.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_nd {

/// The points of a base case as the kernel computes with them: scaled, and counted from the corner
/// of their box, exactly on a lattice and else rounded once.
template <int D>
struct WorkingPoints {
  using Row = std::array<double, D + 1>;  ///< coordinates, and the sum of their squares

  std::size_t count = 0;      ///< of vertices, the infinite one among them
  const Row* rows = nullptr;  ///< by vertex; that of the infinite vertex is not a number
  const Point<D>* originals = nullptr;
  Point<D> extents{};                ///< by axis: no coordinate is larger
  Point<D> inverse_extents{};        ///< 1 / extents, rounded
  std::optional<Box<D>> safe_box{};  ///< BaseCaseInput::safe_box, likewise

  [[nodiscard]] const double* row(VertexId v) const { return rows[v].data(); }
  /// The point that the caller gave.
  [[nodiscard]] const Point<D>& original(VertexId v) const {
    return originals[v - kernel::kFirstPoint];
  }
};

template <int D>
WorkingPoints<D> make_working_points(std::span<const Point<D>> points, Slab& memory,
                                     const std::optional<Box<D>>& safe_box) {
  using Row = typename WorkingPoints<D>::Row;
  const CoordinateScaling<D> scaling(points);
  Point<D> corner{};
  if (!scaling.lattice()) {
    Box<D> box;
    for (const Point<D>& p : points) box.expand(p);
    corner = scaling(box.lo);
  }
  const auto from_corner = [&corner](Point<D> p) {
    for (int k = 0; k < D; ++k) p[k] -= corner[k];
    return p;
  };
  auto* const rows =
      static_cast<Row*>(memory.reserve((points.size() + kernel::kFirstPoint) * sizeof(Row)));
  rows[kernel::kInfinite].fill(std::numeric_limits<double>::quiet_NaN());
  WorkingPoints<D> working{
      .count = points.size() + kernel::kFirstPoint, .rows = rows, .originals = points.data()};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<D> p = from_corner(scaling(points[i]));
    Row& row = rows[i + kernel::kFirstPoint];
    std::copy(p.begin(), p.end(), row.begin());
    row[D] = squared_length(p);
    for (int k = 0; k < D; ++k) working.extents[k] = std::max(working.extents[k], p[k]);
  }
  for (int k = 0; k < D; ++k) working.inverse_extents[k] = 1 / working.extents[k];
  if (safe_box) {
    const Box<D> box = scaling.inner_box(*safe_box);
    working.safe_box = Box<D>{from_corner(box.lo), from_corner(box.hi)};
  }
  return working;
}

}  // namespace spillway::delaunay::kernel_nd
