#include "src/delaunay/division/filled_share.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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
  std::vector<Point<D>> sample(std::min(kJudgedSample<D>, points.size()));
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

template std::vector<Point<2>> judged_sample<2>(std::span<const Point<2>>);
template std::vector<Point<3>> judged_sample<3>(std::span<const Point<3>>);
template bool is_hollow<2>(std::span<const Point<2>>, const Box<2>&);
template bool is_hollow<3>(std::span<const Point<3>>, const Box<3>&);
template double filled_share<2>(std::span<const Point<2>>, const Box<2>&);
template double filled_share<3>(std::span<const Point<3>>, const Box<3>&);

}  // namespace spillway::delaunay
