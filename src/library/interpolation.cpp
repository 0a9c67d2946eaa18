#include "src/library/interpolation.h"

#include <cstdint>

#include "src/geometry/constructions/barycentric.h"

namespace spillway::detail {

template <int D, class Index>
double interpolated_value(const MeshView<D, Index>& mesh, std::span<const double> values,
                          Index cell, const Point<D>& place) {
  const auto coordinates = barycentric_coordinates<D>(mesh.corners(cell), place);
  double value = 0;
  for (int i = 0; i <= D; ++i) {
    // They are at most 1, so no product overflows.
    if (coordinates[i] > 0) value += coordinates[i] * values[mesh.vertex(cell, i)];
  }
  return value;
}

template double interpolated_value<2>(const MeshView<2, std::int32_t>&, std::span<const double>,
                                      std::int32_t, const Point<2>&);
template double interpolated_value<3>(const MeshView<3, std::int32_t>&, std::span<const double>,
                                      std::int32_t, const Point<3>&);
template double interpolated_value<2>(const MeshView<2, std::int64_t>&, std::span<const double>,
                                      std::int64_t, const Point<2>&);
template double interpolated_value<3>(const MeshView<3, std::int64_t>&, std::span<const double>,
                                      std::int64_t, const Point<3>&);

}  // namespace spillway::detail
