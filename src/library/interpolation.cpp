#include "src/library/interpolation.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "src/geometry/constructions/barycentric.h"
#include "src/geometry/dimensions.h"

namespace spillway::library {

template <int D, class Index>
double interpolated_value(const MeshView<D, Index>& mesh, std::span<const double> values,
                          Index cell, const Point<D>& place) {
  const auto coordinates = barycentric_coordinates<D>(mesh.corners(cell), place);
  double value = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (int i = 0; i <= D; ++i) {
    // They are at most 1, so no product overflows.
    if (!(coordinates[i] > 0)) continue;
    const double corner = values[mesh.vertex(cell, i)];
    value += coordinates[i] * corner;
    least = std::min(least, corner);
    most = std::max(most, corner);
  }
  // Coordinates are rounded, so their sum may be some more than 1. What is not a number stays so.
  return value < least ? least : value > most ? most : value;
}

#define SPILLWAY_INSTANTIATE(D)                                                                    \
  template double interpolated_value<D>(const MeshView<D, std::int32_t>&, std::span<const double>, \
                                        std::int32_t, const Point<D>&);                            \
  template double interpolated_value<D>(const MeshView<D, std::int64_t>&, std::span<const double>, \
                                        std::int64_t, const Point<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library
