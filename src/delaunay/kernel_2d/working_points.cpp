#include "src/delaunay/kernel_2d/working_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/delaunay/kernel_common/coordinate_scaling.h"

namespace spillway::detail::kernel_2d {

WorkingPoints make_working_points(std::span<const Point<2>> points, Slab& memory,
                                  const std::optional<Box<2>>& clear_box) {
  auto* const scaled =
      static_cast<Point<2>*>(memory.reserve((points.size() + kFirstPoint) * sizeof(Point<2>)));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  scaled[kInfinite] = {kNan, kNan};
  const CoordinateScaling<2> scaling(points);
  WorkingPoints result{
      .scaled = scaled, .originals = points.data(), .lattice = scaling.lattice(), .largest = 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<2> p = scaling(points[i]);
    scaled[i + kFirstPoint] = p;
    result.largest = std::max({result.largest, std::abs(p[0]), std::abs(p[1])});
  }
  if (clear_box) result.clear_box = scaling.inner_box(*clear_box);
  return result;
}

}  // namespace spillway::detail::kernel_2d
