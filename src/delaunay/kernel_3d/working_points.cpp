#include "src/delaunay/kernel_3d/working_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/delaunay/kernel_common/coordinate_scaling.h"

namespace spillway::detail::kernel_3d {

WorkingPoints make_working_points(std::span<const Point<3>> points, Slab& memory,
                                  const std::optional<Box<3>>& clear_box) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kMostOrderKeys = 0x1p53;
  constexpr double kLongestWithOrderKeys = 0x1p40;
  constexpr double kTiny = 100'000;
  auto* const records =
      static_cast<double*>(memory.reserve((points.size() + kFirstPoint) * 4 * sizeof(double)));
  for (int k = 0; k < 4; ++k) records[kInfinite + k] = kNan;
  const CoordinateScaling<3> scaling(points);
  const Point<3>& extent = scaling.extent();
  const double longest = std::max({extent[0], extent[1], extent[2]});
  const double rows = extent[1] + 1;
  const double columns = extent[2] + 1;
  WorkingPoints result;
  result.coordinates = records;
  result.originals = points.data();
  result.lattice = scaling.lattice();
  result.has_order_keys = result.lattice && longest <= kLongestWithOrderKeys &&
                          (extent[0] + 1) * rows * columns <= kMostOrderKeys;
  result.tiny = result.lattice && longest <= kTiny;
  result.extent = std::exp2(std::ilogb(extent[0] + extent[1] + extent[2]) + 1);
  result.count = points.size() + kFirstPoint;
  if (clear_box) result.clear_box = scaling.inner_box(*clear_box);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<3> p = scaling(points[i]);
    double* const record = records + 4 * (i + kFirstPoint);
    for (int k = 0; k < 3; ++k) {
      record[k] = p[k];
      result.largest = std::max(result.largest, std::abs(p[k]));
    }
    record[3] = result.has_order_keys ? (p[0] * rows + p[1]) * columns + p[2] : 0;
  }
  return result;
}

}  // namespace spillway::detail::kernel_3d
