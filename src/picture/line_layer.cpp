#include "src/picture/line_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spillway::picture {
namespace {

/// Half of a line's width, and how far from its middle it is still seen.
constexpr double kHalfWidth = 0.45;
constexpr double kReach = kHalfWidth + 0.5;

/// Shortens the range of shares of the way from `from` on in which the way lies in [lo, hi].
void clip(double from, double way, double lo, double hi, double& begin, double& end) {
  if (way == 0) {
    if (from < lo || from > hi) end = -1;
    return;
  }
  const auto [enters, leaves] = std::minmax({(lo - from) / way, (hi - from) / way});
  begin = std::max(begin, enters);
  end = std::min(end, leaves);
}

}  // namespace

void LineLayer::draw(Point<2> a, Point<2> b, float strength) {
  if (strength <= 0) return;
  if (b < a) std::swap(a, b);
  const Point<2> way = {b[0] - a[0], b[1] - a[1]};
  const std::array<double, 2> size = {static_cast<double>(columns_), static_cast<double>(rows_)};
  double begin = 0;
  double end = 1;
  for (int k = 0; k < 2; ++k) clip(a[k], way[k], -1, size[k] + 1, begin, end);
  const double length2 = way[0] * way[0] + way[1] * way[1];
  if (begin > end || !(length2 > 0)) return;
  // Along the axis on which the line is longer, each step has a few pixels on the other axis.
  const int along = std::abs(way[0]) >= std::abs(way[1]) ? 0 : 1;
  const int across = 1 - along;
  const double reach = kReach * std::sqrt(length2) / std::abs(way[along]);
  const auto [first, last] =
      std::minmax({a[along] + begin * way[along], a[along] + end * way[along]});
  const double step_end = std::min(std::floor(last + kReach), size[along] - 1);
  for (double step = std::max(0.0, std::floor(first - kReach)); step <= step_end; ++step) {
    const double share = std::clamp((step + 0.5 - a[along]) / way[along], 0.0, 1.0);
    const double middle = a[across] + share * way[across];
    const double side_end = std::min(std::floor(middle + reach), size[across] - 1);
    for (double side = std::max(0.0, std::floor(middle - reach)); side <= side_end; ++side) {
      Point<2> to{};
      to[along] = step + 0.5 - a[along];
      to[across] = side + 0.5 - a[across];
      const double nearest = std::clamp((to[0] * way[0] + to[1] * way[1]) / length2, 0.0, 1.0);
      const double distance = std::hypot(to[0] - nearest * way[0], to[1] - nearest * way[1]);
      const double share_covered = std::clamp(kReach - distance, 0.0, 1.0);
      const auto column = static_cast<std::uint32_t>(along == 0 ? step : side);
      const auto row = static_cast<std::uint32_t>(along == 0 ? side : step);
      if (share_covered > 0) draw_pixel(column, row, share_covered * strength);
    }
  }
}

void LineLayer::draw_pixel(std::uint32_t column, std::uint32_t row, double strength) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): no strength is negative.
  const auto value = static_cast<std::uint8_t>(std::min(strength, 1.0) * 255 + 0.5);
  std::atomic<std::uint8_t>& pixel = strength_[std::size_t{row} * columns_ + column];
  std::uint8_t before = pixel;
  while (before < value && !pixel.compare_exchange_weak(before, value)) {
  }
}

void LineLayer::cover(Picture& picture, const Colour& colour, float opacity) const {
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const std::uint8_t line = strength(column, row);
      if (line == 0 || picture.opacity(column, row) == 0) continue;
      picture.set(
          column, row,
          mix(picture.colour(column, row), colour, opacity * static_cast<float>(line) / 255),
          static_cast<float>(picture.opacity(column, row)) / 255);
    }
  }
}

}  // namespace spillway::picture
