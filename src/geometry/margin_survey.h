#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/torus.h"

namespace spillway::geometry {

/// The margin for points of a closed torus that lie evenly, or infinite for too few.
double margin_of_even_points(const Torus& torus, std::uint64_t points);

/// What comes after a margin that was too narrow: a wider one, and from half of the shortest period
/// on the widest there is.
double wider_margin(double margin, const Torus& torus);

/// Counts points by the cells of a grid over a closed torus, to guess how wide a margin of copies
/// the circumspheres near its sides need. Another guess costs time, never the result.
class MarginSurvey {
 public:
  explicit MarginSurvey(const Torus& torus);

  /// Points of the box; coordinates beyond its dimensions are not looked at.
  template <typename AnyPoint>
  void add(std::span<const AnyPoint> points) {
    for (const AnyPoint& point : points) ++counts_[cell_of(point)];
    points_ += points.size();
  }

  /// In the coordinates of points; infinite if there are too few to tell.
  [[nodiscard]] double margin() const;

 private:
  template <typename AnyPoint>
  [[nodiscard]] std::size_t cell_of(const AnyPoint& point) const {
    std::size_t cell = 0;
    for (int k = dimension_ - 1; k >= 0; --k) {
      const double along = (point[k] - torus_.low(k)) * cells_per_unit_[k];
      cell = cell * cells_ + std::min(static_cast<std::size_t>(along), std::size_t(cells_ - 1));
    }
    return cell;
  }
  [[nodiscard]] double spacing_at_sides() const;

  const Torus& torus_;
  int dimension_;
  int cells_;  ///< along each axis, a power of 2
  std::array<double, 3> cells_per_unit_{};
  std::vector<std::uint32_t> counts_;
  std::uint64_t points_ = 0;
};

}  // namespace spillway::geometry
