#include "src/delaunay/kernel_3d/working_points.h"

#include <algorithm>
#include <cmath>

#include "src/delaunay/kernel_common/coordinate_scaling.h"

namespace spillway::delaunay::kernel_3d {

WorkingPoints make_working_points(std::span<const Point<3>> points, Slab& memory,
                                  const std::optional<Box<3>>& safe_box) {
  constexpr double kMostOrderKeys = 0x1p53;
  constexpr double kLongestWithOrderKeys = 0x1p40;
  constexpr double kTiny = 100'000;
  using Row = WorkingPoints::Row;
  const CoordinateScaling<3> scaling(points);
  const Point<3>& extent = scaling.extent();
  const double longest = std::max({extent[0], extent[1], extent[2]});
  const double rows = extent[1] + 1;
  const double columns = extent[2] + 1;
  const bool has_order_keys = scaling.lattice() && longest <= kLongestWithOrderKeys &&
                              (extent[0] + 1) * rows * columns <= kMostOrderKeys;
  WorkingPoints result;
  result.coordinates =
      kernel::scale_points<Row, 3>(scaling, points, safe_box, memory, result,
                                   [=](const Point<3>& p) {
                                     const double key = (p[0] * rows + p[1]) * columns + p[2];
                                     return Row{p[0], p[1], p[2], has_order_keys ? key : 0};
                                   })
          ->data();
  result.has_order_keys = has_order_keys;
  result.tiny = result.lattice && longest <= kTiny;
  result.extent = std::exp2(std::ilogb(extent[0] + extent[1] + extent[2]) + 1);
  result.count = points.size() + kFirstPoint;
  return result;
}

}  // namespace spillway::delaunay::kernel_3d
