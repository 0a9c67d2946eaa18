#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/framed_point.h"
#include "src/geometry/torus.h"

namespace spillway::stream {

/// Counts points by the cells of a grid over a closed torus, to guess how wide a margin of copies
/// the circumspheres near its sides need. Another guess costs time, never the result.
class MarginSurvey {
 public:
  explicit MarginSurvey(const Torus& torus);

  void add(std::span<const LatticePoint> points);

  /// In the coordinates of points; infinite if there are too few to tell.
  [[nodiscard]] double margin() const;

 private:
  [[nodiscard]] double spacing_at_sides() const;

  const Torus& torus_;
  int dimension_;
  int cells_;  ///< along each axis, a power of 2
  std::vector<std::uint32_t> counts_;
  std::uint64_t points_ = 0;
};

}  // namespace spillway::stream
