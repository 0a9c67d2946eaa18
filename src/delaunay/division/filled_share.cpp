#include "src/delaunay/division/filled_share.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace spillway::detail {

template <int D>
double filled_share(std::span<const Point<D>> points, const Box<D>& box) {
  if (points.empty()) return 0;
  const auto side = static_cast<std::size_t>(
      std::max(1.0, std::floor(std::pow(static_cast<double>(points.size()) / 2, 1.0 / D) + 1e-6)));
  std::size_t cells = 1;
  for (int k = 0; k < D; ++k) cells *= side;
  std::vector<bool> filled(cells);
  for (const Point<D>& p : points) {
    std::size_t cell = 0;
    for (int k = 0; k < D; ++k) {
      const double place = (p[k] - box.lo[k]) / (box.hi[k] - box.lo[k]);
      // Without an extent, or where it overflows, all points are in the first cell.
      const double number = place > 0 ? place * static_cast<double>(side) : 0;
      cell = cell * side + std::min(side - 1, static_cast<std::size_t>(std::min(number, 0x1p32)));
    }
    filled[cell] = true;
  }
  return static_cast<double>(std::count(filled.begin(), filled.end(), true)) /
         static_cast<double>(cells);
}

template double filled_share<2>(std::span<const Point<2>>, const Box<2>&);
template double filled_share<3>(std::span<const Point<3>>, const Box<3>&);

}  // namespace spillway::detail
