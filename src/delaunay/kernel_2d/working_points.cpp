#include "src/delaunay/kernel_2d/working_points.h"

#include "src/delaunay/kernel_common/coordinate_scaling.h"

namespace spillway::delaunay::kernel_2d {

WorkingPoints make_working_points(std::span<const Point<2>> points, Slab& memory,
                                  const std::optional<Box<2>>& safe_box) {
  WorkingPoints result;
  result.scaled =
      kernel::scale_points<Point<2>, 2>(CoordinateScaling<2>(points), points, safe_box, memory,
                                        result, [](const Point<2>& p) { return p; });
  return result;
}

}  // namespace spillway::delaunay::kernel_2d
