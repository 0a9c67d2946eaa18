#include "src/delaunay/division/filled_share.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "src/delaunay/common/tuning.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {

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

template <int D>
std::vector<Point<D>> judged_sample(std::span<const Point<D>> points) {
  std::vector<Point<D>> sample(std::min(Tuning<D>::kJudgedSample, points.size()));
  for (std::size_t s = 0; s < sample.size(); ++s) {
    sample[s] = points[s * points.size() / sample.size()];
  }
  return sample;
}

template <int D>
bool is_hollow(std::span<const Point<D>> points, const Box<D>& box) {
  constexpr double kFilled = 0.6;
  return filled_share<D>(judged_sample<D>(points), box) < kFilled;
}

#define SPILLWAY_INSTANTIATE(D)                                               \
  template std::vector<Point<D>> judged_sample<D>(std::span<const Point<D>>); \
  template bool is_hollow<D>(std::span<const Point<D>>, const Box<D>&);       \
  template double filled_share<D>(std::span<const Point<D>>, const Box<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
