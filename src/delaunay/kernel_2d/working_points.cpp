#include "src/delaunay/kernel_2d/working_points.h"

#include <limits>

#include "src/delaunay/coordinate_scaling.h"
#include "src/delaunay/kernel_2d/filters.h"

namespace spillway::kernel_2d {

WorkingPoints make_working_points(std::span<const Point<2>> points, Block& memory) {
  auto* const scaled =
      static_cast<Point<2>*>(memory.reserve((points.size() + kFirstPoint) * sizeof(Point<2>)));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  scaled[kInfinite] = {kNan, kNan};
  const CoordinateScaling<2> scaling(points);
  for (std::size_t i = 0; i < points.size(); ++i) scaled[i + kFirstPoint] = scaling(points[i]);
  const Point<2>& extent = scaling.extent();
  return {.scaled = scaled,
          .originals = points.data(),
          .lattice = scaling.lattice(),
          .certain_determinant = in_circle_bound(extent[0] * extent[0] + extent[1] * extent[1])};
}

}  // namespace spillway::kernel_2d
